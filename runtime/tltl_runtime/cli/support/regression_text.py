"""The text that commands on suites print: the lines of each case and the summary."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import click

from tltl_runtime.cli.support.plain_text import plain_text
from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.report.case_report import CaseReport, new_failure_text
from tltl_runtime.regression.report.retraining_result import OUTCOMES
from tltl_runtime.regression.report.suite_summary import suite_summary, worst_first
from tltl_runtime.regression.suite_run import FinishedCase
from tltl_runtime.support.number_text import mean_text, percent

_COLORS = {"pass": "green", "review": "yellow", "fail": "red"}
_MINOR = ("figure", "version")
"""The kinds of reasons that matter least. They come last, dim."""


def report_lines(results: Sequence[FinishedCase], not_judged: int = 0) -> Iterator[str]:
    """Yield the lines of a report: its result in a sentence, then the lines of each case, failures first.

    ``not_judged`` counts the cases without a result. Without results, there are no lines.
    """
    if not results:
        return
    reports = [result.report for result in results]
    yield click.style(plain_text(suite_summary(reports, not_judged).sentence), bold=True)
    width = max(len(plain_text(report.name)) for report in reports)
    for report, is_cached in worst_first([(result.report, result.is_cached) for result in results]):
        yield from case_lines(report, width, is_cached=is_cached)


def case_lines(report: CaseReport, width: int, *, is_cached: bool) -> Iterator[str]:
    """Yield the lines of a case. Its name is padded to ``width`` columns.

    ``is_cached`` says that the case was not played again.
    """
    verdict = click.style(report.verdict, fg=_COLORS[report.verdict], bold=True)
    # Keep the padding outside of the coloured text, so that `rstrip` can remove it at the end of a line.
    beside = f"{' ' * (6 - len(report.verdict))}  {_figures(report)}{'  (as before)' if is_cached else ''}"
    yield f"{plain_text(report.name):<{width}}  {verdict}{beside.rstrip()}"
    if report.verdict == "pass":
        for finding in report.new_failures:
            yield click.style(f"    {plain_text(new_failure_text(finding))}", fg=_COLORS["review"])
        # Where nothing has changed, the line of a case that passes says it all.
        certain = report.causes[:1] if report.edits or report.version_changes else ()
        texts = (*report.failing_traces, *(report.edits if certain else ()), *certain, *filter(None, [report.lost]))
        minor = report.version_changes
    else:
        reasons = report.ordered_reasons
        texts = tuple(reason.text for reason in reasons if reason.kind not in _MINOR)
        minor = tuple(reason.text for reason in reasons if reason.kind in _MINOR)
    yield from (f"    {plain_text(text)}" for text in dict.fromkeys(texts))
    yield from (click.style(f"    {plain_text(text)}", dim=True) for text in dict.fromkeys(minor))


def summary_line(reports: Sequence[CaseReport], missing: Sequence[str] = ()) -> str:
    """Return one line: how many cases got each verdict, and how many retrainings had each outcome.

    ``missing`` are the names of cases that were not judged. They only matter if there are no
    reports.
    """
    if not reports:
        return "no case was judged" if missing else "there was no case to judge"
    text = f"{len(reports)} case{'s' * (len(reports) != 1)}: {_counts([report.verdict for report in reports], _COLORS)}"
    outcomes = [OUTCOMES[report.retrained.outcome] for report in reports if report.retrained]
    return f"{text}; retrained: {_counts(outcomes, OUTCOMES.values())}" if outcomes else text


def _counts(words: Sequence[str], order: Iterable[str]) -> str:
    return ", ".join(f"{words.count(word)} {word}" for word in order if word in words)


def _figures(report: CaseReport) -> str:
    now, before = report.figures, report.baseline
    if now is None or before is None:
        return ""
    passed = round(now.pass_rate * now.episodes)
    parts = [
        f"{passed:>3} of {now.episodes:<3}  {percent(now.pass_rate):>4}",
        _comparison("progress", now, before),
        click.style(_comparison("reward", now, before), dim=True),
    ]
    return "  ".join(parts)


def _comparison(name: str, now: Figures, before: Figures) -> str:
    texts = (mean_text(getattr(figures, name).mean) for figures in (now, before))
    return "{} {:>6} ({:>6})".format(name, *texts)
