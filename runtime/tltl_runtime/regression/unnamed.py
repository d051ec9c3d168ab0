"""What has changed since a baseline without being named: files of cases that are left out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from tltl_runtime.regression.baseline import Reference, text_sha256
from tltl_runtime.regression.dependencies import dependencies
from tltl_runtime.regression.suite import Case, Suite
from tltl_runtime.stealth.levels.file import level_path
from tltl_runtime.stealth.levels.made_for import LEVELS
from tltl_runtime.stealth.levels.place import shown_variant
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.files import is_file, read_source


def unnamed(suite: Suite, left_out: Sequence[Case], references: Sequence[Reference]) -> dict[str, tuple[str, ...]]:
    """The files of cases that are ``left_out`` whose SHA-256 is not the baseline's, and the names of these cases.

    Files count of which the levels were made when the baseline was recorded, by their names there.
    """
    found: dict[str, tuple[str, ...]] = {}
    for case in left_out:
        for name in _changed(suite, case, references):
            found[name] = (*found.get(name, ()), case.name)
    return found


def _changed(suite: Suite, case: Case, references: Sequence[Reference]) -> Iterator[str]:
    place = (level_path(case.level).stem, shown_variant(case.reference), case.place)
    files = next((each.played.files for each in references if _place(each) == place), ())
    # What the variant that it is compared with has alone is nothing that the case depends on.
    paths = dependencies(suite, case)
    for name, sha256 in files:
        parts = Path(name).parts
        if any(path.parts[-len(parts) :] == parts for path in paths) and _sha256(case, name) != sha256:
            yield name


def _sha256(case: Case, name: str) -> str | None:
    """That of a file of the level as it is now, by its name there; None where it cannot be read."""
    level = level_path(case.level)
    places = [level] if name == level.name else [level.parent / name, LEVELS / name]
    with suppress(TltlError):
        text = read_source(next(filter(is_file, places), level)).text
        # As levels do, whatever line ends version control writes.
        return text_sha256(text.replace("\r\n", "\n"))
    return None


def _place(reference: Reference) -> tuple[str, str, str]:
    return reference.played.level, reference.played.variant, reference.played.place
