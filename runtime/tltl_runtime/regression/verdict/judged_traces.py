"""Judge the recorded traces of a case, and those of its baseline."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Final

from tltl_runtime.game.episode import EndKind
from tltl_runtime.regression.explain.explained_episode import Arrival, ExplainedEpisode, NearestMiss, summaries_of
from tltl_runtime.regression.suite.suite import LEAST_EPISODES
from tltl_runtime.regression.suite.thresholds import Thresholds
from tltl_runtime.regression.suite.trace_case import TraceCase
from tltl_runtime.regression.verdict.confidence import rate_interval
from tltl_runtime.regression.verdict.verdict import Judgement, judge
from tltl_runtime.spec.episode_summary import EpisodeSummary, progress_return, settled_end
from tltl_runtime.spec.task import read_spec
from tltlc.api import Diagnostic, Fspa, TltlError, record, replace, traces

OnTrace = Callable[[TraceCase, int, int], None]
"""A callback after each trace. It gets the case, the number of traces judged so far, and the total number."""

_KINDS: Final[dict[traces.Kind, EndKind]] = {
    "broken": "violated",
    "blocked": "blocked",
    "late": "limit",
    "unfinished": "stopped",
}


_NEVER: Final = 3.0
"""A threshold that no change of the reward, which is in [-1, 1], can reach."""


@record
class TraceSet:
    """Judged traces: their ``names``, an episode that describes each, and their ``verdicts``, in the same order.

    ``unread`` has the traces that cannot be judged: pairs of a name and the first error. They are not in
    ``names``. ``warnings`` has pairs of the name of a judged trace and its first warning. ``others`` are
    the names of files in the folders that are not traces.
    """

    names: tuple[str, ...]
    episodes: tuple[ExplainedEpisode, ...]
    unread: tuple[tuple[str, Diagnostic], ...]
    warnings: tuple[tuple[str, Diagnostic], ...] = ()
    others: tuple[str, ...] = ()
    verdicts: tuple[traces.TraceVerdict, ...] = ()


NO_TRACES: Final = TraceSet((), (), ())


@record
class JudgedTraces:
    """A case of recorded traces with its verdict.

    ``now`` are the traces of the case, and ``before`` those of its baseline. ``judgement`` is None if
    none of the traces of one of these sets can be judged. ``thresholds`` are those of the case. But if
    the traces are not judged as episodes, or the spec has no limit, the reward equals the progress; the
    threshold of the reward is then so great that no change of the reward counts. ``clauses`` are the
    clauses of the spec.
    """

    case: TraceCase
    thresholds: Thresholds
    fspa: Fspa
    judgement: Judgement | None
    now: TraceSet
    before: TraceSet
    clauses: traces.Clauses


def judge_traces(case: TraceCase, error: float, workers: int | None, on_trace: OnTrace) -> JudgedTraces:
    """Judge the traces of a case and of its baseline, and return the verdict.

    ``error`` is the allowed probability of a wrong verdict on this case. ``workers`` is the number of
    processes, or None for the default of :func:`tltlc.api.traces.judge_files`. If fewer than 25 traces
    of the case or of the baseline can be judged, the verdict is ``review``.

    Raises:
        TltlError: errors of the spec; TLT0001, a folder contains no trace or cannot be read; TLT0007, a
            worker process ended.
    """
    fspa, spec = read_spec(case.spec)
    clauses = traces.clauses_of(fspa, spec)
    files_now, files_before = (_files(paths) for paths in (case.traces, case.baseline))
    count_now = len(files_now.traces)
    names = (*files_now.traces, *files_before.traces)
    # The same process or pool judges both, because the start of a pool takes longer than many traces.
    judged = traces.judge_files(fspa, clauses, names, workers, episodes=case.as_episodes, details=True)
    results = []
    for count, result in enumerate(judged, start=1):
        results.append(result)
        on_trace(case, count, len(names))
    now, before = (
        _trace_set(fspa, part, files.others, as_episodes=case.as_episodes)
        for part, files in ((results[:count_now], files_now), (results[count_now:], files_before))
    )
    has_limit = case.as_episodes and fspa.limit_steps is not None
    thresholds = case.thresholds if has_limit else replace(case.thresholds, reward=_NEVER)
    return JudgedTraces(case, thresholds, fspa, _judgement(thresholds, error, now, before), now, before, clauses)


def _files(paths: Sequence[str]) -> traces.TraceFiles:
    files = traces.find_traces(paths)
    if files.errors:
        raise TltlError(files.errors)
    return files


def _judgement(thresholds: Thresholds, error: float, now: TraceSet, before: TraceSet) -> Judgement | None:
    """Return the verdict on the traces ``now``, compared with the traces ``before`` of the baseline.

    None if none of the traces of one of these sets can be judged.

    A trace that cannot be judged may or may not meet the spec. The confidence interval of the pass rate
    allows for both. If there are such traces in ``now``, the verdict is ``review``, unless the case fails
    even if all of them meet the spec.
    """
    if not now.episodes or not before.episodes:
        return None
    summaries, summaries_before = summaries_of(now.episodes), summaries_of(before.episodes)
    judgement = judge(summaries, summaries_before, len(summaries), thresholds, error, paired=False)
    passed, unread = sum(summary.success for summary in summaries), len(now.unread)
    failed = len(summaries) - passed
    interval = rate_interval(passed, failed + unread, error)[0], rate_interval(passed + unread, failed, error)[1]
    if judgement is None or len(summaries_before) < LEAST_EPISODES:
        return Judgement("review", False, interval, ())
    if unread and not (judgement.verdict == "fail" and interval[1] < thresholds.fail_rate):
        return replace(judgement, verdict="review", certain=False, rate_interval=interval)
    return replace(judgement, rate_interval=interval)


def _trace_set(
    fspa: Fspa, judged: Sequence[traces.JudgedTrace], others: tuple[str, ...], *, as_episodes: bool
) -> TraceSet:
    read = [trace for trace in judged if trace.verdict is not None]
    return TraceSet(
        tuple(trace.name for trace in read),
        tuple(_explained_traces(fspa, read, as_episodes=as_episodes)),
        tuple((trace.name, trace.diagnostics[0]) for trace in judged if trace.verdict is None),
        tuple((trace.name, trace.diagnostics[0]) for trace in read if trace.diagnostics),
        others,
        tuple(trace.verdict for trace in read if trace.verdict is not None),
    )


def _explained_traces(
    fspa: Fspa, judged: Sequence[traces.JudgedTrace], *, as_episodes: bool
) -> Iterator[ExplainedEpisode]:
    for index, trace in enumerate(judged):
        assert trace.verdict is not None
        yield _explained(fspa, index, trace.verdict, limit=fspa.limit_steps if as_episodes else None)


def _explained(fspa: Fspa, index: int, verdict: traces.TraceVerdict, limit: int | None) -> ExplainedEpisode:
    """Return the episode, numbered ``index``, that describes a trace with this verdict.

    ``limit`` is the spec's limit in steps if the trace was judged as an episode; otherwise None.
    """
    outcome, cause, details = verdict.outcome, verdict.cause, verdict.details
    assert details is not None
    end = settled_end(outcome.accepted, outcome.verdict)
    summary = EpisodeSummary(
        index=index,
        seed=None,
        success=outcome.accepted,
        end="stopped" if cause is not None and cause.kind == "unfinished" else end,
        progress=outcome.progress,
        reward=progress_return(outcome.accepted, outcome.progress, outcome.steps, limit),
        steps=outcome.steps,
        unmet=details.unmet,
    )
    nearest = details.nearest
    return ExplainedEpisode(
        summary=summary,
        cause="success" if cause is None else _KINDS[cause.kind],
        by=() if cause is None else cause.clauses,
        place=None,
        seen_by=(),
        arrivals=tuple(Arrival(state, step) for state, step in details.arrivals),
        nearest=None
        if nearest is None
        else NearestMiss(
            fspa.atoms[nearest.atom].name,
            round(nearest.robustness, 4),
            wanted=nearest.wanted,
            missed=details.missed,
            reached=nearest.reached,
        ),
        way=(),
        broke=() if cause is None else cause.atoms,
        measured=None if cause is None else cause.measure,
    )
