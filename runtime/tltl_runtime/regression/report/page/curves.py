"""Diagrams as inline SVG: progress over time, and the distribution of progress now and before.

Functions draw them, not templates: nearly every attribute is computed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import ceil
from typing import Final

from markupsafe import Markup

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.report.page.markup import element, short
from tltl_runtime.support.number_text import percent

_WIDTH, _HEIGHT = 420, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 44, 8, 10, 34
_BINS: Final = 10
"""The number of bins for the progress of failed episodes."""

_GAP: Final = 0.5
"""The gap between these bins and the bar of the successful episodes, in widths of a bin."""


def progress_curves(episodes: Mapping[int, RecordedEpisode]) -> Markup:
    """Plot progress, in [0, 1], over time, in seconds, of each recorded episode."""
    longest = max((float(recording.times[-1]) for recording in episodes.values()), default=0.0)
    frame = _Frame(max(1.0, longest))
    lines = [
        element(
            "polyline",
            element("title", f"episode {index}: {episode.end}"),
            class_=f"curve {'success' if episode.success else 'failure'}",
            data_episode=index,
            points=" ".join(f"{short(x)},{short(y)}" for x, y in _corners(frame, episode)),
        )
        for index, episode in episodes.items()
    ]
    # The page's script moves the cursor to the current moment.
    scale = {"data_left": _LEFT, "data_right": _WIDTH - _RIGHT, "data_seconds": short(frame.x_most)}
    cursor = element("line", class_="cursor", y1=_TOP, y2=_HEIGHT - _BOTTOM, hidden="hidden", **scale)
    words = "Progress over time of the recorded episodes"
    return _diagram(words, frame, "time, s", [*lines, cursor], frame.x_ticks())


def progress_distribution(now: Sequence[Account], before: Sequence[Account]) -> Markup:
    """Plot the shares of episodes by their best progress.

    Failed episodes are in tenths of [0, 1]; the last bar shows the successful ones.  The bars of now are
    filled, the bars of the baseline are outlines around them.
    """
    frame = _Frame(_BINS + _GAP + 1.0)
    bars = []
    for kind, accounts in (("now", now), ("before", before)):
        for place, share in enumerate(_shares(accounts)):
            if share:
                title = element("title", f"{_bin(place)}, {kind}: {percent(share)} of the episodes")
                left, top = frame.x(_left(place)), frame.y(share)
                inset = 0.1 * (frame.x(1.0) - frame.x(0.0))
                sides = {"x": short(left + inset), "y": short(top), "width": short(8 * inset)}
                height = short(_HEIGHT - _BOTTOM - top)
                bars.append(element("rect", title, class_=f"share {kind}", **sides, height=height))
    words = "How progress is distributed over the episodes, now and in the baseline"
    ticks = [(float(place), short(place / _BINS)) for place in range(_BINS)]
    ticks.append((_left(_BINS) + 0.5, "1 (met)"))
    return _diagram(words, frame, "best progress", bars, ticks, percent_ticks=True)


def _left(place: int) -> float:
    """The left end of a bin; the bin of the successful episodes is set apart."""
    return place + _GAP * (place == _BINS)


def _bin(place: int) -> str:
    if place == _BINS:
        return "progress 1, the spec is met"
    return f"progress {place / _BINS:.1f} to {(place + 1) / _BINS:.1f}"


def _shares(accounts: Sequence[Account]) -> list[float]:
    """The share of episodes in each bin.

    An episode that reached progress 1 and then broke the spec is in the last bin of the failed ones.
    """
    counts = [0] * (_BINS + 1)
    for account in accounts:
        counts[_BINS if account.summary.success else min(_BINS - 1, int(account.summary.progress * _BINS + 1e-9))] += 1
    return [count / max(1, len(accounts)) for count in counts]


def _corners(frame: _Frame, episode: RecordedEpisode) -> list[tuple[float, float]]:
    """The points at which a curve starts, ends or changes its value; it is straight in between."""
    values, times = episode.progress.tolist(), episode.times.tolist()
    rows = {0, len(values) - 1}
    for row, (one, other) in enumerate(pairwise(values)):
        if one != other:
            rows |= {row, row + 1}
    return [(frame.x(times[row]), frame.y(values[row])) for row in sorted(rows)]


class _Frame:
    """The axes of a diagram: x from 0 to ``x_most``, y from 0 to 1."""

    def __init__(self, x_most: float) -> None:
        self.x_most = x_most

    def x(self, value: float) -> float:
        return _LEFT + value / self.x_most * (_WIDTH - _LEFT - _RIGHT)

    def y(self, value: float) -> float:
        return _HEIGHT - _BOTTOM - value * (_HEIGHT - _TOP - _BOTTOM)

    def x_ticks(self) -> list[tuple[float, str]]:
        """At most seven whole numbers on the x axis, with their labels."""
        step = max(1, ceil(self.x_most / 6))
        return [(float(tick), str(tick)) for tick in range(0, int(self.x_most + 1e-9) + 1, step)]


def _diagram(
    words: str,
    frame: _Frame,
    x_label: str,
    inside: Sequence[Markup],
    ticks: Sequence[tuple[float, str]],
    *,
    percent_ticks: bool = False,
) -> Markup:
    drawn = [element("title", words)]
    for value in (0.0, 0.25, 0.5, 0.75, 1.0):
        y = short(frame.y(value))
        drawn.append(element("line", class_="grid", x1=_LEFT, x2=_WIDTH - _RIGHT, y1=y, y2=y))
        text = f"{value:.0%}" if percent_ticks else short(value)
        drawn.append(element("text", text, class_="tick y", x=_LEFT - 5, y=short(frame.y(value) + 4)))
    below = _HEIGHT - _BOTTOM + 15
    drawn += [element("text", text, class_="tick x", x=short(frame.x(tick)), y=below) for tick, text in ticks]
    middle = short((_LEFT + _WIDTH - _RIGHT) / 2)
    drawn.append(element("text", x_label, class_="tick x", x=middle, y=_HEIGHT - 3))
    return element("svg", *drawn, *inside, class_="diagram", viewBox=f"0 0 {_WIDTH} {_HEIGHT}", role="img")
