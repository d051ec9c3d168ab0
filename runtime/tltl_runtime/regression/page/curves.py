"""Small diagrams as inline SVG: progress over time, and how progress is distributed now and before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import ceil
from typing import Final

from tltl_runtime.regression.account import Account
from tltl_runtime.regression.page.markup import Markup, element, short
from tltl_runtime.stealth.episodes.episode import Episode

_WIDTH, _HEIGHT = 420, 190
_LEFT, _RIGHT, _TOP, _BOTTOM = 44, 8, 10, 34
_BINS: Final = 10


def progress_curves(episodes: Mapping[int, Episode]) -> Markup:
    """Progress, in [0, 1], over the seconds of each recorded episode, by index."""
    longest = max((each.snapshots[-1].time for each in episodes.values()), default=0.0)
    frame = _Frame(max(1.0, longest), 1.0)
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
    # The page moves it to the moment that it shows.
    scale = {"data_left": _LEFT, "data_right": _WIDTH - _RIGHT, "data_seconds": short(frame.x_most)}
    cursor = element("line", class_="cursor", y1=_TOP, y2=_HEIGHT - _BOTTOM, hidden="hidden", **scale)
    words = "Progress over time of the recorded episodes"
    return _diagram(words, frame, "time, s", [*lines, cursor], frame.x_ticks(whole=True))


def progress_distribution(now: Sequence[Account], before: Sequence[Account]) -> Markup:
    """The shares of episodes whose best progress lies in each tenth of [0, 1], beside each other."""
    shares = [_shares([each.progress for each in accounts]) for accounts in (now, before)]
    frame = _Frame(1.0, max(0.1, *shares[0], *shares[1]))
    wide = (frame.x(1.0) - frame.x(0.0)) / _BINS
    bars = []
    for kind, found, offset in zip(("now", "before"), shares, (0.08, 0.5), strict=True):
        for place, share in enumerate(found):
            if share:
                low = f"progress {place / _BINS:.1f} to {(place + 1) / _BINS:.1f}"
                top = frame.y(share)
                bars.append(
                    element(
                        "rect",
                        element("title", f"{low}, {kind}: {share:.0%} of the episodes"),
                        class_=f"share {kind}",
                        x=short(frame.x(place / _BINS) + offset * wide),
                        y=short(top),
                        width=short(0.42 * wide),
                        height=short(_HEIGHT - _BOTTOM - top),
                    )
                )
    words = "How progress is distributed over the episodes, now and in the baseline"
    return _diagram(words, frame, "best progress", bars, frame.x_ticks(whole=False), percent=True)


def _corners(frame: _Frame, episode: Episode) -> list[tuple[float, float]]:
    """Where a curve begins, ends and changes its height: between, it is straight."""
    values = episode.progress.tolist()
    times = [shot.time for shot in episode.snapshots]
    rows = {0, len(values) - 1}
    for row, (one, other) in enumerate(pairwise(values)):
        if one != other:
            rows |= {row, row + 1}
    return [(frame.x(times[row]), frame.y(values[row])) for row in sorted(rows)]


def _shares(values: Sequence[float]) -> list[float]:
    counts = [0] * _BINS
    for value in values:
        counts[min(_BINS - 1, int(value * _BINS + 1e-9))] += 1
    return [count / max(1, len(values)) for count in counts]


class _Frame:
    """The axes of a diagram, which begin at 0."""

    def __init__(self, x_most: float, y_most: float) -> None:
        self.x_most, self.y_most = x_most, y_most

    def x(self, value: float) -> float:
        return _LEFT + value / self.x_most * (_WIDTH - _LEFT - _RIGHT)

    def y(self, value: float) -> float:
        return _HEIGHT - _BOTTOM - value / self.y_most * (_HEIGHT - _TOP - _BOTTOM)

    def x_ticks(self, *, whole: bool) -> list[float]:
        step = max(1.0, ceil(self.x_most / 6)) if whole else self.x_most / 5
        return [tick * step for tick in range(int(self.x_most / step + 1e-9) + 1)]


def _diagram(
    words: str, frame: _Frame, x_label: str, inside: Sequence[Markup], ticks: Sequence[float], *, percent: bool = False
) -> Markup:
    drawn = [element("title", words)]
    for share in (0.0, 0.5, 1.0):
        value = share * frame.y_most
        y = short(frame.y(value))
        drawn.append(element("line", class_="grid", x1=_LEFT, x2=_WIDTH - _RIGHT, y1=y, y2=y))
        text = f"{value:.0%}" if percent else f"{value:.1f}"
        drawn.append(element("text", text, class_="tick y", x=_LEFT - 5, y=short(frame.y(value) + 4)))
    below = _HEIGHT - _BOTTOM + 15
    drawn += [element("text", short(tick), class_="tick x", x=short(frame.x(tick)), y=below) for tick in ticks]
    middle = short((_LEFT + _WIDTH - _RIGHT) / 2)
    drawn.append(element("text", x_label, class_="tick x", x=middle, y=_HEIGHT - 3))
    return element("svg", *drawn, *inside, class_="diagram", viewBox=f"0 0 {_WIDTH} {_HEIGHT}", role="img")
