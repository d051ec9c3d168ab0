"""A level from above, with the way of an episode through it, coloured by the automaton's state."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any, Final

from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from tltl_runtime.stealth.level import Box, Level, Point

_SOLIDS: Final = {"floor": "#f1f5f9", "platform": "#cbd5e1", "low": "#a8a29e", "wall": "#475569"}
_BARRIERS: Final = {"solid": "#d97706", "laser": "#dc2626"}
_STATES: Final = ("#2563eb", "#9333ea", "#0d9488", "#ca8a04", "#db2777", "#65a30d", "#0284c7", "#ea580c")
_METRES_PER_INCH: Final = 2.0


def draw(level: Level, path: Sequence[Point] = (), states: Sequence[int] = ()) -> bytes:
    """The plan of a level as a PNG; ``path`` holds the player's feet, decision by decision, ``states`` the automaton's.

    Without ``states`` the whole path has one colour.  Raises ValueError where there is not one state for each point.
    """
    if states and len(states) != len(path):
        raise ValueError(f"{len(path)} points need as many states, not {len(states)}")
    (x0, y0, _), (x1, y1, _) = level.bounds.low, level.bounds.high
    figure = Figure(figsize=((x1 - x0) / _METRES_PER_INCH, (y1 - y0) / _METRES_PER_INCH + 0.4), layout="constrained")
    axes = figure.add_subplot(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", title=f"{level.name} {level.variant}")
    axes.set_xlabel("x, m")
    axes.set_ylabel("y, m")
    for solid in sorted(level.solids, key=lambda solid: solid.box.high[2]):
        axes.add_patch(_area(solid.box, facecolor=_SOLIDS[solid.kind], edgecolor="#94a3b8", linewidth=0.4))
    for barrier in level.barriers:
        axes.add_patch(_area(barrier.box, facecolor=_BARRIERS[barrier.kind], alpha=0.8))
        _name(axes, barrier.name, _middle(barrier.box))
    for mover in level.movers:
        axes.plot(*_flat(mover.path), color="#7c3aed", linestyle=":", linewidth=1.5)
        _name(axes, mover.name, mover.path[0])
    for enemy in level.enemies:
        axes.plot(*_flat([*enemy.route, enemy.route[0]]), color="#dc2626", linestyle="--", linewidth=1.0)
        _name(axes, enemy.name, enemy.route[0])
    for switch in level.switches:
        axes.add_patch(Circle(switch.position[:2], switch.radius, facecolor="#facc15", alpha=0.5))
        _name(axes, switch.name, switch.position)
    for way_out in level.exits:
        axes.plot(*way_out.position[:2], marker="*", markersize=14, color="#16a34a")
        _name(axes, way_out.name, way_out.position)
    axes.plot(*level.start.position[:2], marker="o", markersize=7, color="#0f172a")
    for first in range(len(path) - 1):
        colour = _STATES[states[first] % len(_STATES)] if states else _STATES[0]
        axes.plot(*_flat(path[first : first + 2]), color=colour, linewidth=2.0, solid_capstyle="round")
    written = BytesIO()
    figure.savefig(written, format="png", dpi=100, metadata={"Software": None})
    return written.getvalue()


def _area(box: Box, **style: Any) -> Rectangle:
    (x0, y0, _), (x1, y1, _) = box.low, box.high
    return Rectangle((x0, y0), x1 - x0, y1 - y0, **style)


def _middle(box: Box) -> Point:
    (x0, y0, z0), (x1, y1, _) = box.low, box.high
    return (x0 + x1) / 2, (y0 + y1) / 2, z0


def _flat(points: Sequence[Point]) -> tuple[list[float], list[float]]:
    return [point[0] for point in points], [point[1] for point in points]


def _name(axes: Any, name: str, place: Point) -> None:
    axes.annotate(name, place[:2], xytext=(0, 7), textcoords="offset points", ha="center", fontsize=8, color="#0f172a")
