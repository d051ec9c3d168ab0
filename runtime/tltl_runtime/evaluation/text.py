"""The report of an evaluation for people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tltl_runtime.evaluation.figures import Ended, Evaluation, Figures
from tltl_runtime.evaluation.statistics import Spread
from tltl_runtime.stealth.recordings.episode import End
from tltl_runtime.support.number_text import column, number, share

_WIDTH: Final = 24
"""Of a column, in letters."""

_MOST_LISTED: Final = 12
"""Of the episodes that ended alike, as many are named."""

_ENDS: Final[Mapping[End, str]] = {"violation": "violated", "limit": "out of time"}


def report_text(evaluations: Mapping[str, Evaluation]) -> str:
    """A table with a column for each way to choose actions, then where failed episodes ended."""
    every = [each.figures for each in evaluations.values()]
    lines = [
        _row("", list(evaluations)),
        _row("episodes", [str(each.episodes) for each in every]),
        _row("pass rate (95 %)", [_rate(each) for each in every]),
        _row("progress", [f"{share(each.progress.mean)} ± {_std(each, each.progress, 2)}" for each in every]),
        _row("reward", [f"{number(each.reward.mean, 2)} ± {_std(each, each.reward, 2)}" for each in every]),
        _row("steps", [f"{each.steps.mean:.0f} ± {_std(each, each.steps, 0)}" for each in every]),
    ]
    for name, each in evaluations.items():
        failed = sum(ended.count for ended in each.ended)
        if failed:
            lines += ["", f"{name}: {failed} of {len(each.episodes)} failed"]
            lines += [line for ended in each.ended for line in _failures(ended)]
    return "\n".join(lines) + "\n"


def _row(name: str, cells: Sequence[str]) -> str:
    return f"{name:<18}{''.join(f'{cell:<{_WIDTH}}' for cell in cells)}".rstrip()


def _rate(each: Figures) -> str:
    low, high = each.pass_interval
    return f"{share(each.pass_rate)} ({share(low)} to {share(high)})"


def _std(each: Figures, spread: Spread, places: int) -> str:
    """A standard deviation, which a single episode does not have."""
    return number(spread.std, places) if each.episodes > 1 else "-"


def _failures(ended: Ended) -> tuple[str, str]:
    listed = ", ".join(map(str, ended.episodes[:_MOST_LISTED])) + (", …" if ended.count > _MOST_LISTED else "")
    what = column(f"  {ended.count} ", f"{_ENDS[ended.end]} in state {ended.state}, remaining: {ended.label}")
    return what, column(f"    episode{'s' if ended.count > 1 else ''} ", listed)
