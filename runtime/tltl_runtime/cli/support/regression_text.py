"""What commands on suites print: a line for each case, why it has its verdict, and the sum."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import click

from tltl_runtime.cli.support.printable import plain
from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.retrain.retrained import OUTCOMES

_COLORS = {"pass": "green", "review": "yellow", "fail": "red"}


def case_lines(report: CaseReport, width: int, *, kept: bool) -> Iterator[str]:
    """The lines on a case, whose name is given ``width`` columns."""
    verdict = click.style(report.verdict, fg=_COLORS[report.verdict], bold=True)
    # Blanks stand outside of the colour, so that none is left at the end of a line.
    beside = f"{' ' * (6 - len(report.verdict))}  {_figures(report)}{'  (as before)' if kept else ''}"
    yield f"{plain(report.name):<{width}}  {verdict}{beside.rstrip()}"
    if report.verdict != "pass":
        yield from (f"    {plain(reason)}" for reason in report.reasons)


def sum_line(reports: Sequence[CaseReport], missing: Sequence[str] = ()) -> str:
    """How many cases have which verdict, and what their trainings came to; ``missing`` were not judged."""
    if not reports:
        return "no case was judged" if missing else "no case was to be played"
    said = f"{len(reports)} case{'s' * (len(reports) != 1)}: {_counts([each.verdict for each in reports], _COLORS)}"
    trained = [OUTCOMES[each.retrained.outcome] for each in reports if each.retrained]
    return f"{said}; trained anew: {_counts(trained, OUTCOMES.values())}" if trained else said


def _counts(words: Sequence[str], order: Iterable[str]) -> str:
    return ", ".join(f"{words.count(word)} {word}" for word in order if word in words)


def _figures(report: CaseReport) -> str:
    now, before = report.figures, report.baseline
    if now is None or before is None:
        return ""
    passed = round(now.pass_rate * now.episodes)
    parts = [f"{passed:>3} of {now.episodes:<3}", _against("progress", now, before), _against("reward", now, before)]
    return "  ".join(parts)


def _against(name: str, now: Figures, before: Figures) -> str:
    return f"{name} {getattr(now, name).mean:5.2f} ({getattr(before, name).mean:5.2f})"
