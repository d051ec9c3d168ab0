"""Run a suite of regression tests: judge its cases one after the other.

Results are cached, so that a stopped run can continue.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.game.level import Level
from tltl_runtime.game.recording_path import SUFFIX
from tltl_runtime.regression.report.case_report import CaseReport, report_on, report_on_broken, report_on_edited
from tltl_runtime.regression.report.film_cache import INDEX
from tltl_runtime.regression.report.trace_report import report_on_broken_traces, report_on_traces
from tltl_runtime.regression.suite.result_cache import cache_text, inputs_hash, read_cache
from tltl_runtime.regression.suite.slugs import slugs
from tltl_runtime.regression.suite.suite import Case, Suite, SuiteCase
from tltl_runtime.regression.suite.trace_case import TraceCase
from tltl_runtime.regression.verdict.baseline import Reference, baseline_command, check_states, reference_of
from tltl_runtime.regression.verdict.judged_traces import JudgedTraces, OnTrace, judge_traces
from tltl_runtime.regression.verdict.play import (
    JudgedCase,
    OnEpisode,
    PreparedCase,
    judge_case,
    prepare_case,
    telling_episodes,
)
from tltl_runtime.support.folder_lock import lock_folder
from tltl_runtime.support.record_json import to_json
from tltlc.api import Diagnostic, TltlError, fileio, label_text, record, replace

CASES: Final = "cases"
"""The name of the folder, in the folder of a run, that has a folder for each case."""

_REPORT: Final = "case.json"
_VERSION: Final = 7
_RECORDINGS: Final = 3
"""At most this many episodes of each finding are stored as recordings."""

_EDITED: Final = "TLT0905"
_WORKER_ERRORS: Final = frozenset({"TLT0850", "TLT0852"})
_NOT_INSTALLED: Final = "TLT0730"

_LOST_PROCESS: Final = "TLT0007"
"""The code of the error of a process that judges traces and ends too early; it is no fault of the case."""

WRITABLE: Final = "make sure that there is room and that you may write there, or name another folder with --out"
"""The help if a file cannot be written to the folder of a run."""


@record
class FinishedCase:
    """A case of a suite with its finished report.

    ``is_cached`` says that the report is from an earlier run, and that nothing has changed since.
    ``prepared`` is the case as it was played, and ``reference`` has the episodes of the baseline
    with which it was compared. Both are None if no policy played the case, for example because its
    level does not load. ``traces`` has the judged traces of a case of recorded traces; it is None
    for other cases.
    """

    report: CaseReport
    is_cached: bool
    prepared: PreparedCase | None = None
    reference: Reference | None = None
    traces: JudgedTraces | None = None

    @property
    def case_to_train(self) -> PreparedCase | None:
        """The case as it was played, if its policy should be retrained; else None.

        The policy should be retrained if the case was played and did not pass, if there was no
        retraining yet, and if there is no ``training_obstacle``.
        """
        return None if self.report.retrained or self.training_obstacle else self._unpassed_case

    @property
    def training_obstacle(self) -> str | None:
        """A clause that says why retraining the policy cannot help; None if it can help.

        It is also None if the case passed, or was not played.
        """
        prepared = self._unpassed_case
        if prepared is None:
            return None
        if prepared.outdated:
            return "it was trained for another spec"
        if prepared.level.game.is_infeasible(prepared.level, prepared.setup.fspa):
            return f"nobody can do what `{prepared.setup.fspa.name}` asks, as reported above"
        return None

    @property
    def _unpassed_case(self) -> PreparedCase | None:
        return None if self.report.verdict == "pass" else self.prepared


def is_error_of_workers(error: TltlError) -> bool:
    """Whether an error is one of worker processes. It stops the run, because the case is not at fault.

    A package that is not installed counts, too, unless the message points to the game file that needs
    it: other games may not need it.
    """
    return any(
        diagnostic.code in _WORKER_ERRORS or (diagnostic.code == _NOT_INSTALLED and not diagnostic.labels)
        for diagnostic in error.diagnostics
    )


def check_references(suite: Suite, cases: Sequence[SuiteCase], references: tuple[Reference, ...]) -> None:
    """Check that ``references``, the baseline, has episodes for each case that can be played.

    Raises:
        TltlError: TLT0903, the baseline has no episodes, or too few, for a case; TLT0902, its
            episodes were in states that the spec does not have.
    """
    for case in cases:
        if isinstance(case, Case):
            _prepare(suite, case, references)


def lock_run(folder: Path) -> AbstractContextManager[None]:
    """Return a context that locks the folder of a run. The folder is created if it is missing.

    Raises:
        TltlError: TLT0904, another run uses the folder; TLT0005, it cannot be written.
    """
    title = f"another run of `tltlc regress` is using `{folder}`"
    busy = Diagnostic("TLT0904", title, help="wait until it ends, or name another folder with --out")
    return lock_folder(folder, busy, WRITABLE)


def regress(
    suite: Suite,
    cases: Sequence[SuiteCase],
    references: tuple[Reference, ...],
    folder: Path,
    pool: Pool,
    on_episode: OnEpisode,
    on_trace: OnTrace = lambda *_: None,
    *,
    fresh: bool = False,
) -> Generator[FinishedCase]:
    """Judge some cases of a suite in order, and yield each as soon as it is finished.

    ``references`` is the baseline: the recorded episodes that the cases are compared with. ``pool``
    says which processes play. ``on_episode`` is called after each episode, and ``on_trace`` after
    each recorded trace. Results are cached below ``folder``, the folder of the run; lock it with
    :func:`lock_run` during this call. A played case with a cached result is not played again if
    nothing that it depends on has changed, unless ``fresh``.

    A case that cannot be played gets the verdict ``fail``. A case whose level is edited while it is
    played gets ``review``. The run then goes on with the next case.

    Raises:
        TltlError: TLT0903, the baseline lacks a case, or a policy or its spec was replaced
            meanwhile; TLT0902, the episodes of the baseline were in states that the spec does not
            have; TLT0007, a process that judges traces ended; TLT0730, TLT0850 and TLT0852, errors
            of the workers that play; TLT0005, the folder cannot be written.
    """
    if fresh:
        _remove_cached(suite, cases, folder)
    for case in cases:
        if isinstance(case, TraceCase):
            yield _judge_traces(suite, case, pool, on_trace)
            continue
        # Set the case up again: its files may have changed while other cases were played.
        prepared = _prepare(suite, case, references)
        if isinstance(prepared, TltlError):
            yield FinishedCase(report_on_broken(case, prepared), is_cached=False)
        else:
            yield _judge(suite, *prepared, folder, pool, on_episode)


def _judge_traces(suite: Suite, case: TraceCase, pool: Pool, on_trace: OnTrace) -> FinishedCase:
    """Judge the recorded traces of a case; if they cannot be judged, report that as a failure.

    Nothing is cached, because this takes little time.

    Raises:
        TltlError: TLT0007, a worker process ended.
    """
    # Ray, and 0 for all cores, are kinds of pools for episodes.
    workers = pool if isinstance(pool, int) and pool > 0 else None
    try:
        judged = judge_traces(case, suite.error / len(suite.cases), workers, on_trace)
    except TltlError as fault:
        if any(diagnostic.code == _LOST_PROCESS for diagnostic in fault.diagnostics):
            raise
        return FinishedCase(report_on_broken_traces(case, fault), is_cached=False)
    return FinishedCase(report_on_traces(judged), is_cached=False, traces=judged)


def _remove_cached(suite: Suite, cases: Sequence[SuiteCase], folder: Path) -> None:
    """Remove the cached results of the cases from ``folder``, the folder of a run that starts afresh.

    If the run is stopped and continued, it then finds only its own results there.
    """
    for case in cases:
        for name in (_REPORT, INDEX):
            fileio.remove_file(case_folder(suite, case.name, folder / CASES) / name, WRITABLE)


def case_folder(suite: Suite, name: str, folder: Path) -> Path:
    """Return the folder of the case called ``name``, such as ``folder/navigation-v1`` for ``navigation:v1``."""
    names = [case.name for case in suite.cases]
    return folder / slugs(names)[names.index(name)]


def _prepare(suite: Suite, case: Case, references: tuple[Reference, ...]) -> tuple[PreparedCase, Reference] | TltlError:
    """Set up a case, and return it with the episodes of the baseline to compare it with.

    If the case cannot be played, return the error instead.

    Raises:
        TltlError: TLT0903, the baseline has no episodes, or too few, for the case; TLT0902, its
            episodes were in states that the spec does not have.
    """
    try:
        prepared = prepare_case(case, suite.seed)
    except TltlError as error:
        return error
    identity = replace(prepared.played, variant=case.reference)
    reference = reference_of(references, identity, suite)
    check_states(reference, prepared.setup.fspa, suite)
    if len(reference.episodes) < case.episodes:
        title = (
            f"the baseline of `{case.name}` has {len(reference.episodes)} episodes, but {case.episodes} are required"
        )
        raise TltlError([Diagnostic("TLT0903", title, help=f"record it: {baseline_command(suite)}")])
    return prepared, reference


def _judge(
    suite: Suite, prepared: PreparedCase, reference: Reference, folder: Path, pool: Pool, on_episode: OnEpisode
) -> FinishedCase:
    """Return the result of a case: the cached result if it is up to date; otherwise, play the case.

    An error in the files of the case becomes the verdict ``fail``, and an edit of its level during
    play becomes ``review``.

    Raises:
        TltlError: an error of the workers, or TLT0005, the result cannot be written.
    """
    case, error = prepared.case, suite.error / len(suite.cases)
    own_folder, inputs = case_folder(suite, case.name, folder / CASES), _inputs(prepared, reference, error)
    cached = _cached_report(own_folder, inputs)
    if cached:
        return FinishedCase(cached, is_cached=True, prepared=prepared, reference=reference)
    try:
        result = judge_case(prepared, reference, error, pool, lambda count, last: on_episode(case, count, last))
    except TltlError as fault:
        if is_error_of_workers(fault):
            raise
        is_edited = any(diagnostic.code == _EDITED for diagnostic in fault.diagnostics)
        report = report_on_edited if is_edited else report_on_broken
        return FinishedCase(report(case, fault), is_cached=False)
    except RuntimeError as problem:
        level_fault = prepared.level.game.level_fault(problem)
        if level_fault is None:
            raise
        return FinishedCase(report_on_broken(case, level_fault), is_cached=False)
    written = _write(own_folder, inputs, prepared.level, result)
    return FinishedCase(written, is_cached=False, prepared=prepared, reference=reference)


def _inputs(prepared: PreparedCase, reference: Reference, error: float) -> str:
    """Return the hash of everything that the report on a case depends on, for the cache."""
    case, fspa = prepared.case, prepared.setup.fspa
    parts = [
        _VERSION,
        case.name,
        case.episodes,
        to_json(case.thresholds),
        error,
        to_json(prepared.played),
        to_json(reference),
        # Sentences of the report contain these names.
        [signal.name for signal in fspa.signals],
        [atom.name for atom in fspa.atoms],
        [label_text(fspa, state.id) for state in fspa.states],
        prepared.outdated,
        prepared.level.game.installed_code(prepared.level),
    ]
    return inputs_hash(parts)


def _cached_report(folder: Path, inputs: str) -> CaseReport | None:
    """Return the report that is cached in the folder of a case; None if it is missing or out of date.

    It is out of date if the hash of what it was made from is not ``inputs``, or if one of its
    recordings is missing.
    """
    report = read_cache(CaseReport, folder / _REPORT, inputs)
    return report if report and all((folder / name).is_file() for _, name in report.recordings) else None


def _write(folder: Path, inputs: str, level: Level, result: JudgedCase) -> CaseReport:
    """Write the report on a case and recordings of example episodes to ``folder``; return the report.

    The examples are the first ``_RECORDINGS`` episodes of each finding (a sentence about what the
    policy does differently), the first success, and those that show more of the ``level``.
    """
    report = report_on(result)
    by_index = {episode.explained.summary.index: episode.recording for episode in result.episodes}
    successes = [episode.summary.index for episode in report.episodes if episode.summary.success]
    findings = (*report.explanation, *report.new_failures)
    mentioned = [index for finding in findings for index in finding.episodes[:_RECORDINGS]]
    chosen = sorted({*mentioned, *successes[:1]})
    chosen += telling_episodes(level, result.episodes, chosen)
    file_names = {index: f"{index}{SUFFIX}" for index in sorted(chosen)}
    report = replace(report, recordings=tuple(file_names.items()))
    recordings = {name: by_index[index] for index, name in file_names.items()}
    fileio.write_files(folder, {**recordings, _REPORT: cache_text(inputs, report)}, WRITABLE, over_inputs=True)
    for path in folder.glob(f"*{SUFFIX}"):
        # Remove recordings of earlier runs, which may be of another level.
        if path.name not in recordings:
            path.unlink(missing_ok=True)
    return report
