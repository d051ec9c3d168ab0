"""The plan of a level from above, with an episode's path coloured by the automaton's state."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import ceil
from typing import Any, Final

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch
from numpy.typing import NDArray

from tltl_runtime.game.palette import INK
from tltl_runtime.game.plan import DPI, LINE, Plan, area, draw_path, plan_axes, plan_size, png, text_scale, write_name
from tltl_runtime.stealth.capabilities.reach import Reach
from tltl_runtime.stealth.enemies.grid import grid_of
from tltl_runtime.stealth.level import Box, Enemy, Point, StealthLevel
from tltl_runtime.stealth.recordings.episode import Episode
from tltlc.api import Notation

SOLIDS: Final = {"floor": "#f1f5f9", "platform": "#cbd5e1", "low": "#a8a29e", "wall": "#475569"}
"""The colour of each kind of solid; :data:`BARRIERS` has the colours of barriers."""
BARRIERS: Final = {"solid": "#d97706", "laser": "#dc2626"}
_SOLID_NAMES: Final = {"floor": "floor", "platform": "platform", "low": "low obstacle", "wall": "wall"}
_BARRIER_NAMES: Final = {"solid": "gate", "laser": "laser"}
SWITCH, EXIT, MOVER, ROUTE = "#facc15", "#16a34a", "#7c3aed", "#dc2626"
_UNREACHED: Final = (0.86, 0.0, 0.0, 0.3)

_COLUMN: Final = 2.0
"""The width of a column of the legend of :func:`draw_level`, in inches."""


def draw_level(level: StealthLevel, reach: Reach) -> bytes:
    """Draw the plan of a level (a map from above) as a PNG.

    Red covers all places where no player can stand.
    """
    width, height = plan_size(level.bounds)
    legend = _legend(level)
    columns = max(1, int(width / _COLUMN))
    figure = Figure(figsize=(width, height + (ceil(len(legend) / columns) + 1) * LINE), dpi=DPI, layout="constrained")
    axes = level_axes(figure, level)
    _add_reach(axes, reach)
    figure.legend(handles=legend, loc="outside lower left", ncols=columns, fontsize=8, frameon=False)
    return png(figure)


def draw_episode(episode: Episode, size: tuple[int, int] | None = None, notation: Notation = "english") -> bytes:
    """Draw the player's path in an episode on the plan of its level, as a PNG.

    See :func:`~tltl_runtime.game.plan.draw_path`.
    """
    plan = Plan(episode.level.bounds, lambda figure: level_axes(figure, episode.level, start=False))
    death = next((row for row, shot in enumerate(episode.snapshots) if shot.health <= 0.0), None)
    path = [shot.player.position for shot in episode.snapshots]
    return draw_path(plan, episode, path, size, notation, death)


def backdrop(
    level: StealthLevel, size: tuple[int, int]
) -> tuple[NDArray[np.uint8], Callable[[Point], tuple[float, float]]]:
    """Return a picture of a level's plan without bodies that move, and a function that finds its pixels.

    The picture is (height, width, 3). The function converts a position in the level to a pixel of
    the picture: x and y from the upper left.
    """
    figure = Figure(figsize=(size[0] / DPI, size[1] / DPI), dpi=DPI, layout="constrained")
    axes = level_axes(figure, level, moving=False, start=False)
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    transform = axes.transData

    def pixel(place: Point) -> tuple[float, float]:
        x, y = transform.transform(place[:2])
        return float(x), size[1] - float(y)

    return np.asarray(canvas.buffer_rgba())[..., :3].copy(), pixel


def _add_reach(axes: Any, reach: Reach) -> None:
    """Paint red, on a plan, all cells in which no player can reach ground to stand on."""
    rows, columns = reach.ground.shape
    west, south = reach.origin
    red = np.where(reach.ground[..., None], 0.0, _UNREACHED)
    extent = (west, west + columns * reach.cell, south, south + rows * reach.cell)
    axes.imshow(red, origin="lower", extent=extent, interpolation="nearest", zorder=2)


def _legend(level: StealthLevel) -> list[Any]:
    """Return the legend of a level's plan: the colours and marks that occur in the plan."""
    kinds = {solid.kind for solid in level.solids}
    handles: list[Any] = [Patch(facecolor=SOLIDS[kind], label=_SOLID_NAMES[kind]) for kind in SOLIDS if kind in kinds]
    barriers = {barrier.kind for barrier in level.barriers}
    handles += [Patch(facecolor=BARRIERS[kind], label=_BARRIER_NAMES[kind]) for kind in BARRIERS if kind in barriers]
    handles.append(Patch(facecolor=_UNREACHED, label="nobody stands there"))
    handles.append(Line2D([], [], marker="o", linestyle="", color=INK, label="start"))
    if level.switches:
        handles.append(Line2D([], [], marker="o", linestyle="", color=SWITCH, markersize=10, label="switch"))
    if level.exits:
        handles.append(exit_mark())
    if level.enemies:
        handles.append(Line2D([], [], linestyle="--", color=ROUTE, label="route of an enemy"))
    if level.movers:
        handles.append(Line2D([], [], linestyle=":", color=MOVER, label="way of a moving obstacle"))
    return handles


def exit_mark() -> Line2D:
    """Return the entry for exits in a plan's legend, a star."""
    return Line2D([], [], marker="*", linestyle="", color=EXIT, markersize=12, label="exit")


def level_axes(figure: Figure, level: StealthLevel, moving: bool = True, start: bool = True) -> Any:
    """Draw a level from above in new axes of a figure, with the metre as the unit, and return the axes.

    With ``moving``, the plan shows the beginning of an episode: barriers are drawn as shut, and
    movers (moving boxes) and enemies are named at their initial positions. With ``start``, it shows
    the player's start. If text of full size does not fit, only switches and exits are named.
    """
    scale = text_scale(figure, level.bounds)
    roomy, letters = scale == 1.0, 8 * scale
    axes = plan_axes(figure, level.bounds, f"{level.name} {level.variant}", scale)
    for solid in sorted(level.solids, key=lambda solid: solid.box.high[2]):
        axes.add_patch(area(solid.box, facecolor=SOLIDS[solid.kind], edgecolor="#94a3b8", linewidth=0.4))
    for barrier in level.barriers:
        axes.add_patch(area(barrier.box, facecolor=BARRIERS[barrier.kind], alpha=0.8 if moving else 0.25))
        if roomy:
            write_name(axes, barrier.name, _middle(barrier.box), letters)
    for mover in level.movers:
        axes.plot(*_coordinates(mover.path), color=MOVER, linestyle=":", linewidth=1.5)
        if moving and roomy:
            write_name(axes, mover.name, mover.path[0], letters)
    for enemy in level.enemies:
        axes.plot(*_coordinates(patrol_path(level, enemy)), color=ROUTE, linestyle="--", linewidth=1.0)
        if moving and roomy:
            write_name(axes, enemy.name, enemy.route[0], letters)
    for switch in level.switches:
        axes.add_patch(Circle(switch.position[:2], switch.radius, facecolor=SWITCH, alpha=0.5))
        write_name(axes, switch.name, switch.position, letters)
    for exit_ in level.exits:
        axes.plot(*exit_.position[:2], marker="*", markersize=14 * scale, color=EXIT)
        write_name(axes, exit_.name, exit_.position, letters)
    if start:
        axes.plot(*level.start.position[:2], marker="o", markersize=7, color=INK)
    return axes


def patrol_path(level: StealthLevel, enemy: Enemy) -> list[tuple[float, float]]:
    """Return the corners of the path on which an enemy walks its route while all barriers are shut.

    The path leads around obstacles and ends where it begins.
    """
    floor = grid_of(level).floor(range(len(level.barriers)))
    route = [point[:2] for point in (*enemy.route, enemy.route[0])]
    path = route[:1]
    for goal in route[1:]:
        while (corner := floor.next_point(path[-1], goal)) not in (None, path[-1], goal):
            path.append(corner)
        path.append(goal)
    return path


def _middle(box: Box) -> Point:
    (x0, y0, z0), (x1, y1, _) = box.low, box.high
    return (x0 + x1) / 2, (y0 + y1) / 2, z0


def _coordinates(points: Iterable[Sequence[float]]) -> tuple[list[float], list[float]]:
    sequence = list(points)
    return [point[0] for point in sequence], [point[1] for point in sequence]
