"""What has changed since a baseline without being named: files of cases that are left out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from tltl_runtime.regression.suite.dependencies import dependencies
from tltl_runtime.regression.suite.level_texts import text_now
from tltl_runtime.regression.suite.suite import Case, Suite
from tltl_runtime.regression.verdict.baseline import Reference, text_sha256
from tltl_runtime.stealth.levels.file import level_path
from tltl_runtime.stealth.levels.place import shown_variant


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
        if any(path.parts[-len(parts) :] == parts for path in paths):
            text = text_now(case.level, case.variant, name)
            if text is None or text_sha256(text) != sha256:
                yield name


def _place(reference: Reference) -> tuple[str, str, str]:
    return reference.played.level, reference.played.variant, reference.played.place
