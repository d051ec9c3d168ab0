"""What commands on suites print: a line for each case, why it has its verdict, and the sum."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import click

from tltl_runtime.commands.plain import plain
from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.case_report import CaseReport

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
    """How many cases have which verdict; ``missing`` were not judged."""
    if not reports:
        return "no case was judged" if missing else "no case was to be played"
    counts = [(sum(each.verdict == verdict for each in reports), verdict) for verdict in _COLORS]
    return f"{len(reports)} case{'s' * (len(reports) != 1)}: " + ", ".join(
        f"{count} {verdict}" for count, verdict in counts if count
    )


def _figures(report: CaseReport) -> str:
    now, before = report.figures, report.baseline
    if now is None or before is None:
        return ""
    passed = round(now.pass_rate * now.episodes)
    parts = [f"{passed:>3} of {now.episodes:<3}", _against("progress", now, before), _against("reward", now, before)]
    return "  ".join(parts)


def _against(name: str, now: Figures, before: Figures) -> str:
    return f"{name} {getattr(now, name).mean:5.2f} ({getattr(before, name).mean:5.2f})"
