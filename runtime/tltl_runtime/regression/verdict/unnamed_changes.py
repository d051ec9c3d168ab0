"""Find files that have changed since the baseline, though the user did not name them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from tltl_runtime.game.level_name import variant_text
from tltl_runtime.game.registry import registered_game
from tltl_runtime.regression.suite.dependencies import dependencies
from tltl_runtime.regression.suite.suite import Case, Suite
from tltl_runtime.regression.verdict.baseline import Reference, text_sha256
from tltl_runtime.regression.verdict.level_texts import current_text


def unnamed_changes(
    suite: Suite, left_out: Sequence[Case], references: Sequence[Reference]
) -> dict[str, tuple[str, ...]]:
    """Return the files of ``left_out`` cases that differ from the baseline, each with its cases.

    The keys are the names of the files in the baseline. The values are the names of the cases that
    use the file. Only the files of levels are compared.
    """
    cases_of: dict[str, tuple[str, ...]] = {}
    for case in left_out:
        for name in _changed_files(suite, case, references):
            cases_of[name] = (*cases_of.get(name, ()), case.name)
    return cases_of


def _changed_files(suite: Suite, case: Case, references: Sequence[Reference]) -> Iterator[str]:
    """Yield the names of the files of a case whose SHA-256 differs from the baseline."""
    identity = (registered_game().level_files.path(case.level).stem, variant_text(case.reference), case.place)
    files = next((reference.played.files for reference in references if _identity(reference) == identity), ())
    # Files that only the reference variant uses are no dependencies of the case.
    paths = dependencies(suite, case)
    for name, sha256 in files:
        parts = Path(name).parts
        if any(path.parts[-len(parts) :] == parts for path in paths):
            text = current_text(case.level, case.variant, name)
            if text is None or text_sha256(text) != sha256:
                yield name


def _identity(reference: Reference) -> tuple[str, str, str]:
    """Return the level, variant and place of a reference."""
    return reference.played.level, reference.played.variant, reference.played.place
