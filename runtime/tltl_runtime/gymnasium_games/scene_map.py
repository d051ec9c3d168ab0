"""The map of a scene as an inline SVG: its outline and its landmarks. The page's script draws onto it."""

from __future__ import annotations

import base64
from collections import Counter
from collections.abc import Iterator
from math import floor, log10
from typing import Final

from markupsafe import Markup

from tltl_runtime.game.map_labels import LABEL_OFFSET, MapLabel, placed_labels, thing_label
from tltl_runtime.game.map_picture import map_picture, sign_list
from tltl_runtime.game.map_scale import MapScale
from tltl_runtime.game.mentions import NO_MENTIONS, Mentions
from tltl_runtime.game.outline import LevelOutline, MapImage, NamedPolygon
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltl_runtime.gymnasium_games.scene_map_scale import scene_metre
from tltl_runtime.support.markup import element

_LANDMARK_RADIUS: Final = 22
_BAR_INSET: Final = 30

_SIGNS: Final = {
    "landmark": "stays in its place",
    "area": "area",
    "solid wall": "stops players",
    "solid mentioned": "mentioned in a reason",
}
"""The signs on a map: the CSS class of each, and its meaning in the legend."""


def scene_map(level: SceneLevel, mentions: Mentions = NO_MENTIONS) -> Markup:
    """Draw the map of a scene, which must have an outline; highlight the things and regions in ``mentions``."""
    scale, outline = MapScale(_outline(level).bounds, scene_metre(level)), _outline(level)
    obstacles = [scale.rect(item.box) for item in outline.boxes]
    labels = placed_labels(_thing_labels(level, scale, mentions), obstacles, outline.regions, scale, mentions)
    title = f"Map of {level.name} {level.variant}"
    bar = [*_scale_bar(scale)] if _is_empty(outline) else []
    return map_picture(title, scale, [*_ground(outline, scale, mentions), *bar], _landmarks(level, scale), labels)


def scene_map_key(level: SceneLevel, mentions: Mentions = NO_MENTIONS) -> Markup:
    """Return the legend of a map, with the signs that occur on it."""
    outline = _outline(level)
    present = {
        "landmark": level.landmarks,
        "area": outline.polygons,
        "solid wall": outline.boxes,
        "solid mentioned": any(item.name in mentions.things for item in outline.boxes),
    }
    return sign_list((_sign(kind), meaning) for kind, meaning in _SIGNS.items() if present[kind])


def _outline(level: SceneLevel) -> LevelOutline:
    assert level.outline is not None, "only scenes with outlines have maps"
    return level.outline


def _is_empty(outline: LevelOutline) -> bool:
    return not (outline.boxes or outline.polygons or outline.regions or outline.image)


def _sign(kind: str) -> Markup:
    if kind == "landmark":
        return element("circle", class_=kind, r=6)
    return element("rect", class_=kind, x=-8, y=-5, width=16, height=10)


def _ground(outline: LevelOutline, scale: MapScale, mentions: Mentions) -> Iterator[Markup]:
    yield element("rect", class_="floor", **scale.sides(outline.bounds))
    if outline.image is not None:
        yield _image(outline.image, scale)
    for polygon in outline.polygons:
        yield _area(polygon, scale, is_mentioned=polygon.name in mentions.things)
    over = " over" * (outline.image is not None)
    for item in sorted(outline.boxes, key=lambda item: (item.name in mentions.things, item.box.high[2])):
        kind = f"solid wall{over}{' mentioned' * (item.name in mentions.things)}"
        yield element("rect", element("title", item.name), class_=kind, **scale.sides(item.box))
    for region in outline.regions:
        yield element("rect", class_="region", **scale.sides(region.box))


def _scale_bar(scale: MapScale) -> Iterator[Markup]:
    """Yield a bar in the south-western corner, and its length: 1, 2 or 5 times a power of ten, in metres."""
    longest = scale.size[0] / scale.per_metre / 4
    power = 10.0 ** floor(log10(longest))
    metres = max(power * factor for factor in (1, 2, 5) if power * factor <= longest)
    left, bottom, length = _BAR_INSET, scale.size[1] - _BAR_INSET, round(metres * scale.per_metre)
    yield element("path", class_="scale", d=f"M{left},{bottom - 15}v15h{length}v-15")
    yield element("text", f"{metres:g} m", class_="scale-name", x=left + length // 2, y=bottom - 20)


def _image(image: MapImage, scale: MapScale) -> Markup:
    west, south, east, north = image.extent
    (left, bottom), (right, top) = scale.at((west, south)), scale.at((east, north))
    place = {"x": left, "y": top, "width": right - left, "height": bottom - top}
    data = f"data:image/png;base64,{base64.b64encode(image.png).decode()}"
    return element("image", **place, href=data, preserveAspectRatio="none")


def _area(polygon: NamedPolygon, scale: MapScale, *, is_mentioned: bool) -> Markup:
    title = element("title", polygon.name)
    return element("polygon", title, class_=f"area{' mentioned' * is_mentioned}", points=scale.line(polygon.corners))


def _landmarks(level: SceneLevel, scale: MapScale) -> Iterator[Markup]:
    for name, place in level.landmarks:
        x, y = scale.at(place)
        yield element("circle", element("title", name), class_="landmark", cx=x, cy=y, r=_LANDMARK_RADIUS)


def _thing_labels(level: SceneLevel, scale: MapScale, mentions: Mentions) -> Iterator[MapLabel]:
    """Yield labels for all landmarks, and for the boxes and areas that the report mentions.

    Boxes that share their name with other boxes get no label.
    """
    outline = _outline(level)
    for name, place in level.landmarks:
        yield thing_label(name, "thing-name still", scale.at(place), LABEL_OFFSET, scale, mentions)
    counts = Counter(item.name for item in outline.boxes)
    for item in outline.boxes:
        if item.name in mentions.things and counts[item.name] == 1:
            yield thing_label(item.name, "thing-name", scale.middle(item.box), 0, scale, mentions)
    for polygon in outline.polygons:
        if polygon.name in mentions.things:
            middle = [sum(values) / len(polygon.corners) for values in zip(*polygon.corners, strict=True)]
            yield thing_label(polygon.name, "thing-name", scale.at(middle), 0, scale, mentions)
