"""Place the names of regions and things on the map of a level, so that they do not overlap."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import hypot
from typing import Final

from tltl_runtime.game.geometry import Region
from tltl_runtime.game.map_scale import MapScale, Rect
from tltl_runtime.game.mentions import Mentions, region_text
from tltlc.api import record, replace

_LETTER_WIDTH: Final = 25
_LINE_HEIGHT: Final = 48
"""The width of a letter and the height of a line, in centimetres, on a map of usual size.

On the screen, text keeps its size whatever the size of the map.
"""

LABEL_OFFSET: Final = 35
"""Centimetres from the centre of a small thing to the baseline of its name."""

_MARGIN: Final = 12
"""Centimetres between the western side of a region and its name."""

_ROWS: Final = (0, -1, 2, 3, -2)
"""The rows in which the name of a thing is tried, in order: as lines below its default position."""

_STEP: Final = 50
"""Centimetres between the positions in which the name of a region is tried."""


@record
class MapLabel:
    """A name on the map.

    ``lines`` are its lines of text. The baseline of the first line is at ``y``, in centimetres. ``kind``
    is a CSS class: a ``region-name`` starts at ``x``, a ``thing-name`` or ``enemy-name`` is centred
    there. ``is_mentioned`` says that the report mentions the name.
    """

    lines: tuple[str, ...]
    kind: str
    x: int
    y: int
    is_mentioned: bool = False


def thing_label(
    name: str, kind: str, place: tuple[int, int], above: int, scale: MapScale, mentions: Mentions
) -> MapLabel:
    """Return the label of a thing at its default position: ``above`` centimetres above ``place``.

    The label is moved to the side if it would not fit on the map. ``kind`` is its CSS class.
    """
    half = _LETTER_WIDTH * len(name) // 2
    middle = min(max(place[0], half), max(half, scale.size[0] - half))
    return MapLabel((name,), kind, middle, place[1] - above, name in mentions.things)


def placed_labels(
    things: Iterable[MapLabel],
    obstacles: Iterable[Rect],
    regions: Sequence[Region],
    scale: MapScale,
    mentions: Mentions,
) -> Iterator[MapLabel]:
    """Yield all labels of a map at their final positions.

    First come the labels of ``things``, moved apart. Then come the labels of ``regions``, which are placed
    so that they overlap neither the labels of things nor ``obstacles``, if possible.
    """
    occupied: list[Rect] = []
    for label in things:
        separated = _separated(label, occupied, scale.size)
        occupied.append(_label_rect(separated))
        yield separated
    occupied += obstacles
    for row, region in enumerate(regions):
        # Where regions overlap, the first one names the place.
        earlier_regions = [scale.rect(earlier.box) for earlier in regions[:row]]
        is_mentioned = region.name in mentions.regions
        label = _region_label(region, scale.rect(region.box), earlier_regions, occupied, is_mentioned=is_mentioned)
        occupied.append(_label_rect(label))
        yield label


def _separated(label: MapLabel, occupied: Sequence[Rect], size: tuple[int, int]) -> MapLabel:
    """Move a label to the position at which it overlaps the rectangles in ``occupied`` least.

    The label stays on the map, which has the width and height ``size``. Among equally good positions,
    prefer those straight above or below the label's own.
    """
    half = _LETTER_WIDTH * len(label.lines[0]) // 2
    right, lowest = max(half, size[0] - half), max(_LINE_HEIGHT, size[1])
    candidates = [
        replace(
            label,
            x=min(max(half, label.x + side * half), right),
            y=min(max(_LINE_HEIGHT, label.y + row * _LINE_HEIGHT), lowest),
        )
        for side in (0, 1, -1, 2, -2)
        for row in _ROWS
    ]
    return min(candidates, key=lambda candidate: sum(_overlap(_label_rect(candidate), rect) for rect in occupied))


def _region_label(
    region: Region, inside: Rect, earlier_regions: Sequence[Rect], occupied: Sequence[Rect], *, is_mentioned: bool
) -> MapLabel:
    """Place the name of a region in the rectangle ``inside``, near its north-western corner.

    The name avoids the rectangles in ``earlier_regions`` and ``occupied`` if possible.
    """
    name = region_text(region.name)
    best, least = (
        MapLabel((name,), "region-name", inside[0] + _MARGIN, inside[1] + _LINE_HEIGHT, is_mentioned),
        float("inf"),
    )
    # A name that is too long for one line gets a line for each word.
    lines = (name,) if _LETTER_WIDTH * len(name) <= inside[2] - inside[0] else tuple(name.split())
    width, height = _LETTER_WIDTH * max(map(len, lines)) + _MARGIN, _LINE_HEIGHT * len(lines)
    for left in range(inside[0], max(inside[0], inside[2] - width) + 1, _STEP):
        for top in range(inside[1], max(inside[1], inside[3] - height) + 1, _STEP):
            place = (left, top, left + width, top + height)
            distance = hypot(left - inside[0], top - inside[1])
            overlap = sum(_overlap(place, rect) for rect in occupied)
            overlap += 10 * sum(_overlap(place, rect) for rect in earlier_regions)
            if (cost := distance + overlap) < least:
                best, least = MapLabel(lines, "region-name", left + _MARGIN, top + _LINE_HEIGHT, is_mentioned), cost
    return best


def _label_rect(label: MapLabel) -> Rect:
    """Return the rectangle that a label occupies."""
    width = _LETTER_WIDTH * max(map(len, label.lines))
    left = label.x if label.kind == "region-name" else label.x - width // 2
    return left, label.y - _LINE_HEIGHT, left + width, label.y + _LINE_HEIGHT * (len(label.lines) - 1)


def _overlap(first: Rect, second: Rect) -> int:
    """Return the area of the intersection of two rectangles."""
    width = min(first[2], second[2]) - max(first[0], second[0])
    height = min(first[3], second[3]) - max(first[1], second[1])
    return max(0, width) * max(0, height)
