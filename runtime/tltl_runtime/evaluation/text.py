"""The report of an evaluation as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tltl_runtime.evaluation.figures import Evaluation, FailureGroup, Figures
from tltl_runtime.evaluation.statistics import Spread
from tltl_runtime.spec.episode_summary import End
from tltl_runtime.support.number_text import column, number, share
from tltlc.api import traces

_WIDTH: Final = 24
"""The width of a column, in characters."""

_MOST_LISTED: Final = 12
"""At most this many episodes of a group of failures are listed."""

_ENDS: Final[Mapping[End, str]] = {"violation": "violated", "limit": "out of time"}


def report_text(evaluations: Mapping[str, Evaluation]) -> str:
    """Return the statistics of evaluations as a table, and below it why and how failed episodes ended.

    The table has a column for each evaluation. The keys of ``evaluations`` are the headings of the
    columns. They say how actions were chosen: ``sampled`` or ``arg-max``.
    """
    columns = [evaluation.figures for evaluation in evaluations.values()]
    lines = [
        _row("", list(evaluations)),
        _row("episodes", [str(fig.episodes) for fig in columns]),
        *_lost_row(evaluations),
        _row("pass rate (95 %)", [_rate(fig) for fig in columns]),
        _row("progress", [f"{share(fig.progress.mean)} ± {_std(fig, fig.progress, 2)}" for fig in columns]),
        _row("reward", [f"{number(fig.reward.mean, 2)} ± {_std(fig, fig.reward, 2)}" for fig in columns]),
        _row("steps", [f"{fig.steps.mean:.0f} ± {_std(fig, fig.steps, 0)}" for fig in columns]),
    ]
    for name, evaluation in evaluations.items():
        failed = sum(group.count for group in evaluation.ended)
        if failed:
            lines += ["", f"{name}: {failed} of {len(evaluation.episodes)} failed"]
            lines += [f"  {traces.group_text(group, len(evaluation.episodes))}" for group in evaluation.causes]
            lines += [line for group in evaluation.ended for line in _failures(group)]
    return "\n".join(lines) + "\n"


def _lost_row(evaluations: Mapping[str, Evaluation]) -> list[str]:
    """Return the row with the number of episodes that were lost with their games; no row if none was."""
    counts = [len(evaluation.lost) for evaluation in evaluations.values()]
    return [_row("lost", list(map(str, counts)))] if any(counts) else []


def _row(name: str, cells: Sequence[str]) -> str:
    return f"{name:<18}{''.join(f'{cell:<{_WIDTH}}' for cell in cells)}".rstrip()


def _rate(figures: Figures) -> str:
    low, high = figures.pass_interval
    return f"{share(figures.pass_rate)} ({share(low)} to {share(high)})"


def _std(figures: Figures, spread: Spread, places: int) -> str:
    """Return the standard deviation ``spread.std`` as text; ``-`` if there is only one episode."""
    return number(spread.std, places) if figures.episodes > 1 else "-"


def _failures(group: FailureGroup) -> tuple[str, str]:
    indices = ", ".join(map(str, group.episodes[:_MOST_LISTED])) + (", …" if group.count > _MOST_LISTED else "")
    heading = column(f"  {group.count} ", f"{_ENDS[group.end]} in state {group.state}, remaining: {group.label}")
    return heading, column(f"    episode{'s' if group.count > 1 else ''} ", indices)
