"""Find changed level files of the cases that a regression run with ``--changed`` leaves out.

With ``--changed FILE``, a run plays only the cases that depend on FILE. If the user forgot to name
a changed file, the run leaves out cases that it should play.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from tltl_runtime.game.registry import game_of
from tltl_runtime.regression.suite.dependencies import dependencies
from tltl_runtime.regression.suite.suite import Case, Suite, SuiteCase
from tltl_runtime.regression.suite.trace_case import TraceCase
from tltl_runtime.regression.verdict.baseline import Reference
from tltl_runtime.regression.verdict.level_texts import is_unchanged
from tltlc.api import TltlError


def unnamed_changes(
    suite: Suite, left_out: Sequence[SuiteCase], references: Sequence[Reference]
) -> dict[str, tuple[str, ...]]:
    """Return the changed level files of the cases ``left_out``, each with the cases that use it.

    A file has changed if its SHA-256 differs from the one in ``references``, the baseline. The keys
    of the result are names of files, as in the baseline. The values are names of cases.
    """
    cases_of: dict[str, tuple[str, ...]] = {}
    for case in left_out:
        if isinstance(case, TraceCase):
            continue
        # A case whose level cannot be read fails when it is played.
        with suppress(TltlError):
            for name in _changed_files(suite, case, references):
                cases_of[name] = (*cases_of.get(name, ()), case.name)
    return cases_of


def _changed_files(suite: Suite, case: Case, references: Sequence[Reference]) -> Iterator[str]:
    """Yield the names of the level files of a case that have another SHA-256 than in the baseline."""
    identity = (game_of(case.level).level_files.level_name(case.level), case.reference, case.place)
    files = next((reference.played.files for reference in references if _identity(reference) == identity), ())
    # Files that only the reference variant uses are no dependencies of the case.
    paths = dependencies(suite, case)
    for name, sha256 in files:
        parts = Path(name).parts
        is_used = any(path.parts[-len(parts) :] == parts for path in paths)
        if is_used and not is_unchanged(case.level, case.variant, name, sha256):
            yield name


def _identity(reference: Reference) -> tuple[str, str, str]:
    """Return the name, the variant and the place of the level on which a reference was recorded.

    The place is the level's path relative to the suite, or empty for a level of the package.
    """
    return reference.played.level, reference.played.variant, reference.played.place
