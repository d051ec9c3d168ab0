"""Build paths of Bézier curves, piece by piece."""

from __future__ import annotations

from math import dist
from typing import Final

PicturePoint = tuple[float, float]
Curve = tuple[PicturePoint, ...]
"""A start, then three points for each cubic piece: its two control points and its end."""

_SHORT: Final = 0.05
"""A length in pixels. Lines that are not longer are invisible, and their direction is unreliable."""


def add_line(curve: Curve, end: PicturePoint) -> Curve:
    """Extend a curve by a straight line to ``end``, unless the line is too short to see."""
    return (*curve, curve[-1], end, end) if dist(curve[-1], end) > _SHORT else curve


def add_bend(curve: Curve, end: PicturePoint) -> Curve:
    """Extend a curve to ``end`` by a Bézier curve that starts and ends horizontally."""
    x, y = curve[-1]
    half = (end[0] - x) / 2
    return (*curve, (x + half, y), (end[0] - half, end[1]), end)


def add_drop(curve: Curve, end: PicturePoint) -> Curve:
    """Extend a curve down to ``end`` by a Bézier curve that starts and ends vertically."""
    x, y = curve[-1]
    half = (end[1] - y) / 2
    return (*curve, (x, y + half), (end[0], end[1] - half), end)


def svg_path(curve: Curve) -> str:
    """Return the curve as an SVG path, with an arrow at its end."""
    start, *rest = curve
    pieces = "".join(
        "C{:.1f} {:.1f} {:.1f} {:.1f} {:.1f} {:.1f}".format(*rest[i], *rest[i + 1], *rest[i + 2])
        for i in range(0, len(rest), 3)
    )
    before = next((point for point in reversed(curve) if dist(point, curve[-1]) > _SHORT), start)
    return f'<path d="M{start[0]:.1f} {start[1]:.1f}{pieces}"/>{_arrow(before, curve[-1])}'


def _arrow(before: PicturePoint, tip: PicturePoint) -> str:
    length = dist(before, tip) or 1.0
    x, y = (tip[0] - before[0]) / length, (tip[1] - before[1]) / length
    corners = [tip, (tip[0] - 9 * x + 4 * y, tip[1] - 9 * y - 4 * x), (tip[0] - 9 * x - 4 * y, tip[1] - 9 * y + 4 * x)]
    return '<polygon points="{}"/>'.format(" ".join(f"{a:.1f},{b:.1f}" for a, b in corners))
