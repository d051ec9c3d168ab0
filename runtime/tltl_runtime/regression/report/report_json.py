"""The report on a suite of regression tests as JSON data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.suite_summary import suite_summary
from tltl_runtime.regression.suite.suite import Suite
from tltl_runtime.support.record_json import to_json

FORMAT: Final = "tltl-regression"
VERSION: Final = 1

_EPISODE_FIELDS: Final = (
    "index",
    "seed",
    "success",
    "end",
    "progress",
    "reward",
    "steps",
    "unmet",
    "nearest",
    "cause",
    "by",
    "place",
)


def document(
    suite: Suite,
    reports: Sequence[CaseReport],
    *,
    complete: bool,
    left_out: Sequence[str] = (),
    missing: Sequence[str] = (),
) -> dict[str, Any]:
    """Return the report on a suite as JSON data.

    ``complete`` says whether all requested verdicts and retrainings are there. ``left_out`` are the
    names of the cases that were not run because they do not depend on the changed files; ``missing`` are
    those that were not judged because the run was stopped.
    """
    verdicts = [report.verdict for report in reports]
    summary = suite_summary(reports, len(left_out) + len(missing))
    return {
        "format": FORMAT,
        "version": VERSION,
        "suite": suite.path.name,
        "seed": suite.seed,
        "error": suite.error,
        "complete": complete,
        "left_out": list(left_out),
        "verdicts": {verdict: verdicts.count(verdict) for verdict in ("pass", "review", "fail")},
        "summary": {"sentence": summary.sentence, "noun": summary.noun, **summary.counts},
        "cases": [_case(report) for report in reports],
    }


def _case(report: CaseReport) -> dict[str, Any]:
    figures, played = report.figures, report.played
    return {
        "name": report.name,
        "level": report.level,
        "variant": report.variant,
        "spec": played.spec if played else report.traces.spec if report.traces else None,
        "verdict": report.verdict,
        "certain": report.certain,
        **(to_json(figures) if figures else dict.fromkeys(Figures.__match_args__)),
        "rate_interval": list(report.rate_interval),
        "baseline": to_json(report.baseline),
        "changes": to_json(report.changes),
        "headline": report.headline,
        "reasons": list(report.reasons),
        "reason_kinds": [reason.kind for reason in report.ordered_reasons],
        "explanation": [_finding(finding) for finding in report.explanation],
        "played": to_json(played),
        "retrained": to_json(report.retrained),
        "traces": to_json(report.traces),
        "status": report.status,
        "new_failures": [_finding(finding) for finding in report.new_failures],
        "accounts": [_episode(episode) for episode in report.episodes],
    }


def _finding(finding: Finding) -> dict[str, Any]:
    return {
        "text": finding.text,
        "episodes": list(finding.episodes),
        "others": finding.others,
        "kind": finding.kind,
        "short": finding.short or finding.text,
        "symbols": finding.symbols or finding.text,
    }


def _episode(episode: ExplainedEpisode) -> dict[str, Any]:
    data = to_json(episode)
    return {name: data[name] for name in _EPISODE_FIELDS}
