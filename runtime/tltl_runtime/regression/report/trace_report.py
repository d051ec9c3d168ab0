"""The report on a case of recorded traces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.explain.explain import findings, new_failures
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
from tltlc.api import Diagnostic, TltlError, fileio


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


def _too_few_texts(judged: JudgedTraces) -> Iterator[str]:
    for traces, where in ((judged.now, ""), (judged.before, " in the baseline")):
        if (count := len(traces.episodes)) < LEAST_EPISODES:
            yield f"only {count} trace{'s' * (count != 1)}{where}: a verdict needs {LEAST_EPISODES}"


def _unread_texts(traces: TraceSet, of: str) -> Iterator[str]:
    """Yield a sentence with the number of traces that cannot be judged and the first error.

    Yield nothing if all traces can be judged. ``of`` comes after the number: empty, or
    `` of the baseline``.
    """
    yield from _count_texts(traces, of, traces.unread, "cannot be judged")


def _warning_texts(traces: TraceSet, of: str) -> Iterator[str]:
    """Yield a sentence with the number of traces that have warnings and the first warning.

    Yield nothing if there are no warnings. ``of`` comes after the number: empty, or
    `` of the baseline``.
    """
    yield from _count_texts(traces, of, traces.warnings, "have warnings")


def _count_texts(traces: TraceSet, of: str, diagnostics: Sequence[tuple[str, Diagnostic]], verb: str) -> Iterator[str]:
    if diagnostics:
        name, diagnostic = diagnostics[0]
        total = len(traces.unread) + len(traces.names)
        yield f"{len(diagnostics)} of {total} traces{of} {verb}: first `{name}` ({one_line(diagnostic)})"
