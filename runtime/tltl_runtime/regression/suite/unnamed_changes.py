"""Find files that have changed since the baseline, although the user did not name them as changed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from tltl_runtime.game.level_name import shown_variant
from tltl_runtime.game.registry import registered_game
from tltl_runtime.regression.suite.dependencies import dependencies
from tltl_runtime.regression.suite.level_texts import text_now
from tltl_runtime.regression.suite.suite import Case, Suite
from tltl_runtime.regression.verdict.baseline import Reference, text_sha256


def unnamed(suite: Suite, left_out: Sequence[Case], references: Sequence[Reference]) -> dict[str, tuple[str, ...]]:
    """The files of ``left_out`` cases whose SHA-256 differs from the baseline, each with the cases' names.

    Only files of the levels that the baseline recorded count, by their names in the baseline.
    """
    cases_of: dict[str, tuple[str, ...]] = {}
    for case in left_out:
        for name in _changed(suite, case, references):
            cases_of[name] = (*cases_of.get(name, ()), case.name)
    return cases_of


def _changed(suite: Suite, case: Case, references: Sequence[Reference]) -> Iterator[str]:
    place = (registered_game().level_files.path(case.level).stem, shown_variant(case.reference), case.place)
    files = next((reference.played.files for reference in references if _place(reference) == place), ())
    # Files that only the reference variant uses are no dependencies of the case.
    paths = dependencies(suite, case)
    for name, sha256 in files:
        parts = Path(name).parts
        if any(path.parts[-len(parts) :] == parts for path in paths):
            text = text_now(case.level, case.variant, name)
            if text is None or text_sha256(text) != sha256:
                yield name


def _place(reference: Reference) -> tuple[str, str, str]:
    return reference.played.level, reference.played.variant, reference.played.place
