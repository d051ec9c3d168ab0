"""Diagrams as inline SVG: progress over time, and the distribution of progress now and in the baseline.

Functions draw them, not templates, because nearly every attribute is computed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import ceil
from typing import Final

from markupsafe import Markup

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.moments import has_clock
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.support.markup import coordinate, element
from tltl_runtime.support.number_text import percent

_WIDTH, _HEIGHT = 420, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 44, 8, 10, 34
_BINS: Final = 10
"""The number of bins for the progress of failed episodes."""

_GAP: Final = 0.5
"""The gap between the bins of failed episodes and the bar of successes, in widths of a bin."""


def progress_curves(episodes: Mapping[int, RecordedEpisode]) -> Markup:
    """Plot progress, in [0, 1], over time for each recorded episode: in seconds, or in steps without a clock."""
    longest = max((float(recording.times[-1]) for recording in episodes.values()), default=0.0)
    frame = _CurveAxes(max(1.0, longest))
    lines = [
        element(
            "polyline",
            element("title", f"episode {index}: {episode.end}"),
            class_=f"curve {'success' if episode.success else 'failure'}",
            data_episode=index,
            points=" ".join(f"{coordinate(x)},{coordinate(y)}" for x, y in _corners(frame, episode)),
        )
        for index, episode in episodes.items()
    ]
    # The page's script moves the cursor to the current moment.
    scale = {"data_left": _LEFT, "data_right": _WIDTH - _RIGHT, "data_seconds": coordinate(frame.x_most)}
    cursor = element("line", class_="cursor", y1=_TOP, y2=_HEIGHT - _BOTTOM, hidden="hidden", **scale)
    description = "Progress over time of the recorded episodes"
    is_timed = any(has_clock(episode.times) for episode in episodes.values())
    return _diagram(description, frame, "time, s" if is_timed else "step", [*lines, cursor], frame.x_ticks())


def progress_distribution(now: Sequence[ExplainedEpisode], before: Sequence[ExplainedEpisode]) -> Markup:
    """Draw a histogram of the best progress of each episode.

    Ten bins over [0, 1] show the shares of failed episodes; the last bar shows the share of
    successes. The bars of the episodes ``now`` are filled. Those of the episodes ``before``, in the
    baseline, are outlines.
    """
    frame = _CurveAxes(_BINS + _GAP + 1.0)
    bars = []
    for kind, episodes in (("now", now), ("before", before)):
        for bin_, share in enumerate(_shares(episodes)):
            if share:
                title = element("title", f"{_bin_text(bin_)}, {kind}: {percent(share)} of the episodes")
                left, top = frame.x(_left_end(bin_)), frame.y(share)
                inset = 0.1 * (frame.x(1.0) - frame.x(0.0))
                sides = {"x": coordinate(left + inset), "y": coordinate(top), "width": coordinate(8 * inset)}
                height = coordinate(_HEIGHT - _BOTTOM - top)
                bars.append(element("rect", title, class_=f"share {kind}", **sides, height=height))
    description = "How progress is distributed over the episodes, now and in the baseline"
    ticks = [(float(bin_), coordinate(bin_ / _BINS)) for bin_ in range(_BINS)]
    ticks.append((_left_end(_BINS) + 0.5, "1 (met)"))
    return _diagram(description, frame, "best progress", bars, ticks, percent_ticks=True)


def _left_end(bin_: int) -> float:
    """Return where a bin of the histogram begins on the x axis, in widths of a bin.

    There is a gap before the last bin, which shows the successes.
    """
    return bin_ + _GAP * (bin_ == _BINS)


def _bin_text(bin_: int) -> str:
    if bin_ == _BINS:
        return "progress 1, the spec is met"
    return f"progress {bin_ / _BINS:.1f} to {(bin_ + 1) / _BINS:.1f}"


def _shares(episodes: Sequence[ExplainedEpisode]) -> list[float]:
    """Return the share of episodes in each bin of the histogram: ten for failures, one for successes.

    A failed episode that had reached progress 1 is in the last bin of the failures.
    """
    counts = [0] * (_BINS + 1)
    for episode in episodes:
        counts[_BINS if episode.summary.success else min(_BINS - 1, int(episode.summary.progress * _BINS + 1e-9))] += 1
    return [count / max(1, len(episodes)) for count in counts]


def _corners(frame: _CurveAxes, episode: RecordedEpisode) -> list[tuple[float, float]]:
    """Return the points (x, y), in SVG units, at which an episode's curve of progress starts, ends or bends."""
    values, times = episode.progress.tolist(), episode.times.tolist()
    rows = {0, len(values) - 1}
    for row, (value, next_value) in enumerate(pairwise(values)):
        if value != next_value:
            rows |= {row, row + 1}
    return [(frame.x(times[row]), frame.y(values[row])) for row in sorted(rows)]


class _CurveAxes:
    """The axes of a diagram: x from 0 to ``x_most``, y from 0 to 1. They convert values to SVG units."""

    def __init__(self, x_most: float) -> None:
        self.x_most = x_most

    def x(self, value: float) -> float:
        return _LEFT + value / self.x_most * (_WIDTH - _LEFT - _RIGHT)

    def y(self, value: float) -> float:
        return _HEIGHT - _BOTTOM - value * (_HEIGHT - _TOP - _BOTTOM)

    def x_ticks(self) -> list[tuple[float, str]]:
        """Return the marks on the x axis: at most seven whole numbers, each with its text."""
        step = max(1, ceil(self.x_most / 6))
        return [(float(tick), str(tick)) for tick in range(0, int(self.x_most + 1e-9) + 1, step)]


def _diagram(
    description: str,
    frame: _CurveAxes,
    x_label: str,
    contents: Sequence[Markup],
    ticks: Sequence[tuple[float, str]],
    *,
    percent_ticks: bool = False,
) -> Markup:
    elements = [element("title", description)]
    for value in (0.0, 0.25, 0.5, 0.75, 1.0):
        y = coordinate(frame.y(value))
        elements.append(element("line", class_="grid", x1=_LEFT, x2=_WIDTH - _RIGHT, y1=y, y2=y))
        text = f"{value:.0%}" if percent_ticks else coordinate(value)
        elements.append(element("text", text, class_="tick y", x=_LEFT - 5, y=coordinate(frame.y(value) + 4)))
    label_y = _HEIGHT - _BOTTOM + 15
    elements += [element("text", text, class_="tick x", x=coordinate(frame.x(tick)), y=label_y) for tick, text in ticks]
    middle = coordinate((_LEFT + _WIDTH - _RIGHT) / 2)
    elements.append(element("text", x_label, class_="tick x", x=middle, y=_HEIGHT - 3))
    return element("svg", *elements, *contents, class_="diagram", viewBox=f"0 0 {_WIDTH} {_HEIGHT}", role="img")
