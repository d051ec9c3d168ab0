"""A suite is run: its cases one after the other, each kept in a folder, so that a run that was stopped goes on."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.regression.explain.reasons import is_infeasible
from tltl_runtime.regression.report.case_report import CaseReport, report_on, report_on_broken, report_on_edited
from tltl_runtime.regression.suite.result_cache import inputs_hash, kept_text, read_kept
from tltl_runtime.regression.suite.slugs import slugs
from tltl_runtime.regression.suite.suite import Case, Suite
from tltl_runtime.regression.verdict.baseline import Reference, baseline_command, check_states, reference_of
from tltl_runtime.regression.verdict.play import Ready, Result, Told, judged, ready
from tltl_runtime.stealth.recordings.file import SUFFIX
from tltl_runtime.stealth.world.faults import player_fault
from tltl_runtime.support.folder_lock import held
from tltl_runtime.support.record_json import to_json
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.writing import remove_file, write_files

CASES: Final = "cases"
"""In the folder of a run, with a folder for each case."""

_REPORT: Final = "case.json"
_VERSION: Final = 3
_RECORDINGS: Final = 3
"""Of how many episodes of each finding there are recordings."""

_EDITED: Final = "TLT0905"
NOT_THE_CASE: Final = frozenset({"TLT0730", "TLT0850", "TLT0852"})
"""Codes of what is wrong with the workers."""

WRITABLE: Final = "see that there is room, and that you may write there, or name another folder with --out"
"""What to do where the folder of a run refuses a file."""


@record
class Done:
    """A case that is over; ``kept``: it was played by an earlier run, of which nothing has changed.

    ``ready`` and ``reference`` are what was played and compared with, None for a case that could not be played.
    """

    report: CaseReport
    kept: bool
    ready: Ready | None = None
    reference: Reference | None = None

    @property
    def to_train(self) -> Ready | None:
        """What a training could tell more of: a case that was played and did not pass, unless one has done so, or
        nothing comes of it.
        """
        return None if self.report.retrained or self.useless_training else self._not_passed

    @property
    def useless_training(self) -> str | None:
        """Why nothing would come of a training for a case that was played and did not pass; None where it may help."""
        one = self._not_passed
        if one is None:
            return None
        if one.outdated:
            return "it was trained for another spec"
        if is_infeasible(one.level, one.setup.fspa):
            return f"nobody can do what `{one.setup.fspa.name}` asks, as was said above"
        return None

    @property
    def _not_passed(self) -> Ready | None:
        return None if self.report.verdict == "pass" else self.ready


def check(suite: Suite, cases: Sequence[Case], references: tuple[Reference, ...]) -> None:
    """Raise TltlError, TLT0903, where the baseline lacks a case that can be played, and TLT0902, where it is broken."""
    for case in cases:
        _prepared(suite, case, references)


def owned(folder: Path) -> AbstractContextManager[None]:
    """Within, no other run of a suite uses the folder, which is made where it is missing; raises TLT0904, TLT0005."""
    title = f"another run of `tltlc regress` plays in `{folder}`"
    busy = Diagnostic("TLT0904", title, help="wait for its end, or name another folder with --out")
    return held(folder, busy, WRITABLE)


def regress(
    suite: Suite,
    cases: Sequence[Case],
    references: tuple[Reference, ...],
    folder: Path,
    pool: Pool,
    told: Told,
    *,
    fresh: bool = False,
) -> Generator[Done]:
    """Judge some cases of a suite, in their order, each as soon as it is over.

    What was played is kept below ``folder``, which is to be :func:`owned`; a case of which nothing has changed since is
    not played again, unless ``fresh``.  A case that cannot be played fails, one whose level is edited while it is
    played is to be reviewed, and the others go on.

    Raises:
        TltlError: TLT0903 where the baseline lacks a case, or a policy or its spec has become another one meanwhile;
            TLT0902 where its episodes were in states that the spec does not have; TLT0730, TLT0850 and TLT0852 of the
            workers; TLT0005 for the folder.
    """
    if fresh:
        _forget(suite, cases, folder)
    for case in cases:
        # Its files may have changed while others were played.
        prepared = _prepared(suite, case, references)
        if isinstance(prepared, TltlError):
            yield Done(report_on_broken(case, prepared), kept=False)
        else:
            yield _done(suite, *prepared, folder, pool, told)


def _forget(suite: Suite, cases: Sequence[Case], folder: Path) -> None:
    """Remove at once what is kept of all of the cases, so that a run that is stopped goes on with fresh ones."""
    for case in cases:
        remove_file(case_folder(suite, case.name, folder / CASES) / _REPORT, WRITABLE)


def case_folder(suite: Suite, name: str, folder: Path) -> Path:
    """The folder of the case of that name, below the one that has a folder for each of them."""
    names = [case.name for case in suite.cases]
    return folder / slugs(names)[names.index(name)]


def _prepared(suite: Suite, case: Case, references: tuple[Reference, ...]) -> tuple[Ready, Reference] | TltlError:
    """A case that can be played and its reference, or why it cannot be played."""
    try:
        one = ready(case, suite.seed)
    except TltlError as error:
        return error
    wanted = replace(one.played, variant=case.reference)
    reference = reference_of(references, wanted, suite)
    check_states(reference, one.setup.fspa, suite)
    if len(reference.accounts) < case.episodes:
        title = (
            f"the baseline of `{case.name}` has {len(reference.accounts)} episodes, and {case.episodes} are asked for"
        )
        raise TltlError([Diagnostic("TLT0903", title, help=f"record it: {baseline_command(suite)}")])
    return one, reference


def _done(suite: Suite, one: Ready, reference: Reference, folder: Path, pool: Pool, told: Told) -> Done:
    """A case as an earlier run has left it, or played now.

    Raises TltlError for what is no fault of the case.
    """
    case, error = one.case, suite.error / len(suite.cases)
    place, inputs = case_folder(suite, case.name, folder / CASES), _inputs(one, reference, error)
    kept = _kept(place, inputs)
    if kept:
        return Done(kept, kept=True, ready=one, reference=reference)
    try:
        result = judged(one, reference, error, pool, lambda count, last: told(case, count, last))
    except TltlError as fault:
        codes = {each.code for each in fault.diagnostics}
        if codes & NOT_THE_CASE:
            raise
        report = report_on_edited if _EDITED in codes else report_on_broken
        return Done(report(case, fault), kept=False)
    except RuntimeError as problem:
        found = player_fault(problem)
        if found is None:
            raise
        return Done(report_on_broken(case, found), kept=False)
    return Done(_write(place, inputs, result), kept=False, ready=one, reference=reference)


def _inputs(one: Ready, reference: Reference, error: float) -> str:
    """The identity of all that the report on a case depends on."""
    case, fspa = one.case, one.setup.fspa
    parts = [
        _VERSION,
        case.name,
        case.episodes,
        to_json(case.thresholds),
        error,
        to_json(one.played),
        to_json(reference),
        # What reasons are worded with.
        [each.name for each in fspa.signals],
        [each.name for each in fspa.atoms],
        [each.label.english for each in fspa.states],
        one.outdated,
    ]
    return inputs_hash(parts)


def _kept(place: Path, inputs: str) -> CaseReport | None:
    """The report that an earlier run has left, if nothing has changed since, nor a recording been removed."""
    found = read_kept(CaseReport, place / _REPORT, inputs)
    return found if found and all((place / name).is_file() for _, name in found.recordings) else None


def _write(place: Path, inputs: str, result: Result) -> CaseReport:
    """Write the report on a case and the recordings of the episodes that it speaks of."""
    report = report_on(result)
    by_index = {each.account.index: each.recording for each in result.episodes}
    successes = [each.index for each in report.accounts if each.success]
    spoken_of = [index for finding in report.explanation for index in finding.episodes[:_RECORDINGS]]
    named = {index: f"{index}{SUFFIX}" for index in sorted({*spoken_of, *successes[:1]})}
    report = replace(report, recordings=tuple(named.items()))
    recordings = {name: by_index[index] for index, name in named.items()}
    write_files(place, {**recordings, _REPORT: kept_text(inputs, report)}, WRITABLE, over_inputs=True)
    for path in place.glob(f"*{SUFFIX}"):
        # Of an earlier run, on another level perhaps.
        if path.name not in recordings:
            path.unlink(missing_ok=True)
    return report
