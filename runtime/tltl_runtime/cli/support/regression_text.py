"""The text that commands on suites print: the lines of each case and the summary."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import click

from tltl_runtime.cli.support.plain_text import plain_text
from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.retraining_result import OUTCOMES
from tltl_runtime.support.number_text import number, percent

_COLORS = {"pass": "green", "review": "yellow", "fail": "red"}


def case_lines(report: CaseReport, width: int, *, is_cached: bool) -> Iterator[str]:
    """Yield the lines of a case. Its name is padded to ``width`` columns.

    ``is_cached`` says that the case was not played again.
    """
    verdict = click.style(report.verdict, fg=_COLORS[report.verdict], bold=True)
    # Keep the padding outside of the coloured text, so that `rstrip` can remove it at the end of a line.
    beside = f"{' ' * (6 - len(report.verdict))}  {_figures(report)}{'  (as before)' if is_cached else ''}"
    yield f"{plain_text(report.name):<{width}}  {verdict}{beside.rstrip()}"
    if report.verdict != "pass":
        reasons = report.reasons
    else:
        # Where nothing has changed, the line of a case that passes says it all.
        certain = report.causes[:1] if report.edits else ()
        reasons = (*(report.edits if certain else ()), *certain, *((report.lost,) if report.lost else ()))
    yield from (f"    {plain_text(reason)}" for reason in dict.fromkeys(reasons))


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
        _comparison("reward", now, before),
    ]
    return "  ".join(parts)


def _comparison(name: str, now: Figures, before: Figures) -> str:
    texts = (number(getattr(figures, name).mean, 2) for figures in (now, before))
    return "{} {:>5} ({:>5})".format(name, *texts)
