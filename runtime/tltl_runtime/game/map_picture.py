"""The frame of a map as SVG: its view, its layers and its names."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from markupsafe import Markup

from tltl_runtime.game.map_labels import MapLabel
from tltl_runtime.game.map_scale import MapScale
from tltl_runtime.support.markup import element

_MARGIN: Final = 30
_LAYERS: Final = ("heat", "trajectories", "ends", "live")
"""The layers that the page's script draws into, from bottom to top."""


def map_picture(
    title: str, scale: MapScale, ground: Iterable[Markup], things: Iterable[Markup], labels: Iterable[MapLabel]
) -> Markup:
    """Return a map as SVG.

    From bottom to top, it shows the ground, the heat map, the things, the trajectories and their ends,
    the names, and what moves. The page's script draws the heat map, the trajectories, their ends and
    what moves.
    """
    width, height = scale.size
    above = [element("g", class_=layer) for layer in _LAYERS[1:]]
    return element(
        "svg",
        *ground,
        element("g", class_=_LAYERS[0]),
        *things,
        *above[:-1],
        element("g", *map(_label, labels), class_="names"),
        above[-1],
        class_="plan map",
        viewBox=f"{-_MARGIN} {-_MARGIN} {width + 2 * _MARGIN} {height + 2 * _MARGIN}",
        role="group",
        aria_label=title,
    )


def sign_list(rows: Iterable[tuple[Markup, str]]) -> Markup:
    """Return the legend of a map; each row is a sign and its meaning.

    Signs are drawn in a square of 16 by 16 units around the origin.
    """
    return element(
        "ul",
        *(element("li", _sign(shape), meaning) for shape, meaning in rows),
        class_="legend signs",
        aria_label="Signs of the map",
    )


def _sign(shape: Markup) -> Markup:
    return element("svg", shape, class_="plan", viewBox="-8 -8 16 16", aria_hidden="true")


def _label(name: MapLabel) -> Markup:
    lines = [element("tspan", line, x=name.x, dy="1.1em" if row else 0) for row, line in enumerate(name.lines)]
    return element("text", *lines, class_=f"{name.kind}{' mentioned' * name.is_mentioned}", x=name.x, y=name.y)
