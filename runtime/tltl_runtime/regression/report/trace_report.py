"""The report on a case of recorded traces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.explain.explain import Finding, findings, new_failures
from tltl_runtime.regression.explain.explained_episode import summaries_of
from tltl_runtime.regression.report.case_report import (
    CaseReport,
    CaseTraces,
    TraceNames,
    error_location,
    headline,
    one_line,
)
from tltl_runtime.regression.report.reason_order import telling_findings
from tltl_runtime.regression.report.reasons import reasons
from tltl_runtime.regression.suite.suite import LEAST_EPISODES
from tltl_runtime.regression.suite.trace_case import TraceCase
from tltl_runtime.regression.verdict.judged_traces import NO_TRACES, JudgedTraces, TraceSet
from tltlc.api import Diagnostic, TltlError, fileio, traces

_MOST_TRACES: Final = 5
"""At most this many traces that fail are named."""


def report_on_traces(judged: JudgedTraces) -> CaseReport:
    """Return the report on a case of recorded traces that were judged."""
    case, fspa, judgement = judged.case, judged.fspa, judged.judgement
    names = _case_traces(case, fspa.name, judged.now, judged.before)
    unread = (*_unread_texts(judged.now, ""), *_unread_texts(judged.before, " of the baseline"))
    warnings = (*_warning_texts(judged.now, ""), *_warning_texts(judged.before, " of the baseline"))
    if judgement is None:
        return CaseReport(case.name, "", "", "review", (), main=unread, certain=False, traces=names)
    now, before = judged.now.episodes, judged.before.episodes
    summaries, summaries_before = summaries_of(now), summaries_of(before)
    few = tuple(_too_few_texts(judged))
    met, *figure_changes = reasons(judgement, judged.thresholds, summaries, summaries_before, are_traces=True)
    figures, baseline = figures_of(summaries), figures_of(summaries_before)
    explanation = findings(None, fspa, now, before)
    is_worse = judgement.verdict == "fail" or figures.pass_rate < baseline.pass_rate
    new = new_failures(None, fspa, now, before)
    main = (*few, *(unread if judgement.verdict == "review" else ()))
    return CaseReport(
        name=case.name,
        level="",
        variant="",
        verdict=judgement.verdict,
        certain=judgement.certain,
        rate_interval=judgement.rate_interval,
        figures=figures,
        baseline=baseline,
        changes=judgement.changes,
        main=main,
        causes=(met, *(() if judgement.verdict == "review" else unread), *warnings),
        figure_changes=tuple(figure_changes),
        chosen_headline=headline(
            judgement.verdict,
            main,
            telling_findings(explanation, is_worse=is_worse),
            (met, *figure_changes),
            (),
            new,
            is_met=judgement.rate_interval[0] >= judged.thresholds.pass_rate,
        ),
        explanation=explanation,
        new_failures=new,
        failing_traces=_failing_traces(judged, new),
        episodes=now,
        traces=names,
    )


def report_on_broken_traces(case: TraceCase, error: TltlError) -> CaseReport:
    """Return the report on a case whose spec or traces cannot be read. The verdict is ``fail``."""
    file, name = fileio.split_spec_name(case.spec)
    causes = ("it cannot be judged", *map(one_line, error.diagnostics))
    return CaseReport(
        case.name,
        "",
        "",
        "fail",
        causes,
        chosen_headline=": ".join(causes[:2]),
        fault_at=error_location(error),
        traces=_case_traces(case, name or file),
    )


def _case_traces(case: TraceCase, spec: str, now: TraceSet = NO_TRACES, before: TraceSet = NO_TRACES) -> CaseTraces:
    return CaseTraces(
        spec,
        TraceNames(", ".join(case.traces), now.names, len(now.unread)),
        TraceNames(", ".join(case.baseline), before.names, len(before.unread)),
    )


def _failing_traces(judged: JudgedTraces, new: Sequence[Finding]) -> tuple[str, ...]:
    """Return a sentence for each of the first traces that fail, and one with the number of the others.

    The first traces are one for each cause. If the case passes, only traces count that fail in a way that is
    ``new``.
    """
    assert judged.judgement is not None
    new_traces = {index for finding in new for index in finding.episodes}
    causes = [
        (index, cause)
        for index, verdict in enumerate(judged.now.verdicts)
        if (cause := verdict.cause) is not None and (judged.judgement.verdict != "pass" or index in new_traces)
    ]
    first = {(cause.kind, cause.clauses): index for index, cause in reversed(causes)}
    causes.sort(key=lambda pair: pair[0] not in first.values())
    step_s = None if judged.fspa.clock_varies else judged.fspa.clock_s
    texts = [
        f"`{judged.now.names[index]}`: {traces.rejection_text(judged.now.verdicts[index], cause, step_s)}"
        for index, cause in causes[:_MOST_TRACES]
    ]
    left = len(causes) - len(texts)
    return (*texts, *([f"and {left} more"] if left else []))


def _too_few_texts(judged: JudgedTraces) -> Iterator[str]:
    for trace_set, where in ((judged.now, ""), (judged.before, " in the baseline")):
        if (count := len(trace_set.episodes)) < LEAST_EPISODES:
            yield f"only {count} trace{'s' * (count != 1)}{where}: a verdict needs {LEAST_EPISODES}"


def _unread_texts(trace_set: TraceSet, of: str) -> Iterator[str]:
    """Yield a sentence with the number of traces that cannot be judged and the first error.

    Yield nothing if all traces can be judged. ``of`` comes after the number: empty, or
    `` of the baseline``.
    """
    yield from _count_texts(trace_set, of, trace_set.unread, "cannot be judged")


def _warning_texts(trace_set: TraceSet, of: str) -> Iterator[str]:
    """Yield a sentence with the number of traces that have warnings and the first warning.

    Yield nothing if there are no warnings. ``of`` comes after the number: empty, or
    `` of the baseline``.
    """
    yield from _count_texts(trace_set, of, trace_set.warnings, "have warnings")


def _count_texts(
    trace_set: TraceSet, of: str, diagnostics: Sequence[tuple[str, Diagnostic]], verb: str
) -> Iterator[str]:
    if diagnostics:
        name, diagnostic = diagnostics[0]
        total = len(trace_set.unread) + len(trace_set.names)
        yield f"{len(diagnostics)} of {total} traces{of} {verb}: first `{name}` ({one_line(diagnostic)})"
