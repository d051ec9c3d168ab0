"""The outline of a level from above: what a game shows of its levels on maps."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Sequence
from math import isfinite
from types import MappingProxyType
from typing import Final

from tltl_runtime.game.geometry import Box, Region
from tltl_runtime.game.png_header import png_size
from tltlc.api import record

MOST_SHAPES: Final = 5_000
"""The most boxes, polygons and regions of an outline, all together."""

MOST_CORNERS: Final = 20_000
"""The most corners of the polygons of an outline, all together."""

MOST_BYTES: Final = 4 << 20
"""The greatest size of the image of an outline."""

MOST_PIXELS: Final = 4_096
"""The greatest width and height of the image of an outline."""

GREATEST: Final = 1e6
"""The greatest absolute value of a coordinate, in metres."""

LEAST_SIDE: Final = 0.01
"""The least length of the sides of a box, in metres."""

LONGEST_NAME: Final = 100
"""The most characters of the name of a shape."""


@record
class NamedBox:
    """A box that stops players, such as a wall. Several boxes may have the same name."""

    name: str
    box: Box


@record
class NamedPolygon:
    """An area with a name, such as a lake. ``corners`` are x and y, in metres, in order; at least three."""

    name: str
    corners: tuple[tuple[float, float], ...]


@record
class MapImage:
    """A PNG picture of a level from above, with its north at the top.

    ``extent`` says where the picture lies: its west, south, east and north, in metres.
    """

    json_texts = MappingProxyType(
        {"png": (lambda png: base64.b64encode(png).decode(), lambda text: base64.b64decode(text, validate=True))}
    )

    png: bytes
    extent: tuple[float, float, float, float]


@record
class LevelOutline:
    """The outline of a level: its bounds and what is in it, all in metres.

    A game may return any values; :func:`outline_problem` checks them.
    """

    bounds: Box
    boxes: tuple[NamedBox, ...] = ()
    polygons: tuple[NamedPolygon, ...] = ()
    regions: tuple[Region, ...] = ()
    image: MapImage | None = None


def hull(outline: LevelOutline) -> Box | None:
    """Return the smallest box around the boxes, polygons, regions and the image of an outline.

    Each side is at least a centimetre long. Return None if the outline has nothing but its bounds.
    """
    corners = [*_corners(outline)]
    if not corners:
        return None
    low, high = (tuple(pick(values) for values in zip(*corners, strict=True)) for pick in (min, max))
    return widened(Box(low, high))


def widened(box: Box) -> Box:
    """Return a box with sides that are at least a centimetre long."""
    sides = zip(box.low, box.high, strict=True)
    return Box(box.low, tuple(max(high, low + LEAST_SIDE) for low, high in sides))  # type: ignore[arg-type]


def outline_problem(outline: LevelOutline) -> str | None:
    """Return what is wrong with an outline, such as "has a box whose sides are shorter than a centimetre".

    The text ends a sentence whose subject is the outline. Return None if nothing is wrong.
    """
    names = [*(box.name for box in outline.boxes), *(polygon.name for polygon in outline.polygons)]
    names += [region.name for region in outline.regions]
    if len(names) > MOST_SHAPES:
        return f"has {len(names):,} shapes, and at most {MOST_SHAPES:,} are allowed"
    corners = sum(len(polygon.corners) for polygon in outline.polygons)
    if corners > MOST_CORNERS:
        return f"has polygons with {corners:,} corners, and at most {MOST_CORNERS:,} are allowed"
    name = next((name for name in names if not 0 < len(name) <= LONGEST_NAME), None)
    if name is not None:
        return f"has the name {name!r:.40}: names have from 1 to {LONGEST_NAME} characters"
    few = next((polygon.name for polygon in outline.polygons if len(polygon.corners) < 3), None)
    if few is not None:
        return f"has a polygon `{few}` with fewer than three corners"
    if not all(isfinite(number) and abs(number) <= GREATEST for corner in _corners(outline) for number in corner):
        return f"has coordinates that are not numbers from -{GREATEST:,.0f} to {GREATEST:,.0f}"
    boxes = (outline.bounds, *_boxes(outline))
    if any(high - low < LEAST_SIDE / 2 for box in boxes for low, high in zip(box.low, box.high, strict=True)):
        return "has a box whose sides are shorter than a centimetre"
    return None if outline.image is None else image_problem(outline.image)


def image_problem(image: MapImage) -> str | None:
    """Return what is wrong with the image of an outline, as in :func:`outline_problem`."""
    if len(image.png) > MOST_BYTES:
        return f"has an image of more than {MOST_BYTES >> 20} MiB"
    size = png_size(image.png)
    if size is None:
        return "has an image that is no PNG picture"
    if max(size) > MOST_PIXELS:
        return f"has an image of {size[0]} x {size[1]} pixels: at most {MOST_PIXELS} x {MOST_PIXELS} are allowed"
    west, south, east, north = image.extent
    return None if west < east and south < north else "has an image whose extent is empty"


def _boxes(outline: LevelOutline) -> list[Box]:
    return [*(item.box for item in outline.boxes), *(region.box for region in outline.regions)]


def _corners(outline: LevelOutline) -> Iterator[Sequence[float]]:
    """Yield corners of an outline's content: two opposite ones of each box, region and image, all of each polygon.

    Corners are (x, y, z). Polygons and the image lie at the bottom of the lowest box or region; at 0 without these.
    """
    boxes = _boxes(outline)
    for box in boxes:
        yield from (box.low, box.high)
    ground = min((box.low[2] for box in boxes), default=0.0)
    for polygon in outline.polygons:
        yield from ((x, y, ground) for x, y in polygon.corners)
    if outline.image is not None:
        west, south, east, north = outline.image.extent
        yield from ((west, south, ground), (east, north, ground))
