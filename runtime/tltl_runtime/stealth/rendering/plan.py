"""The plan of a level from above, with an episode's path coloured by the automaton's state."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from io import BytesIO
from itertools import pairwise
from math import ceil
from typing import Any, Final

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, Rectangle
from numpy.typing import NDArray

from tltl_runtime.game.palette import ENDS, INK, state_colour
from tltl_runtime.stealth.capabilities.reach import Reach
from tltl_runtime.stealth.enemies.grid import grid_of
from tltl_runtime.stealth.level import Box, Enemy, Point, StealthLevel
from tltl_runtime.stealth.recordings.episode import Episode
from tltlc.api import Fspa, Notation, label_text

SOLIDS: Final = {"floor": "#f1f5f9", "platform": "#cbd5e1", "low": "#a8a29e", "wall": "#475569"}
"""The colour of each kind of solid; :data:`BARRIERS` has the colours of barriers."""
BARRIERS: Final = {"solid": "#d97706", "laser": "#dc2626"}
_SOLID_NAMES: Final = {"floor": "floor", "platform": "platform", "low": "low obstacle", "wall": "wall"}
_BARRIER_NAMES: Final = {"solid": "gate", "laser": "laser"}
SWITCH, EXIT, MOVER, ROUTE = "#facc15", "#16a34a", "#7c3aed", "#dc2626"
_UNREACHED: Final = (0.86, 0.0, 0.0, 0.3)

DPI: Final = 100
_METRES_PER_INCH: Final = 2.0
_LONGEST_SIDE: Final = 40.0
"""The longest side of a picture, in inches; larger levels are scaled down."""

LINE: Final = 0.22
"""The height of a line of the legend, in inches."""

_COLUMN: Final = 2.0
"""The width of a column of the legend of :func:`draw_level`, in inches."""

_ROOMY: Final = 6.0
"""A plan at least this wide and high, in inches, has text of full size.

A smaller plan has text of full size only if it has its :func:`natural_size`.
"""

MOST_LISTED: Final = 12
"""The greatest number of states that the legend lists."""

LETTERS_PER_INCH: Final = 12
"""Characters per inch of a line of the legend; longer lines are cut."""


def draw_level(level: StealthLevel, reach: Reach) -> bytes:
    """Draw the plan of a level as a PNG. Red covers all places where no player can stand."""
    width, height = natural_size(level)
    legend = _legend(level)
    columns = max(1, int(width / _COLUMN))
    figure = Figure(figsize=(width, height + (ceil(len(legend) / columns) + 1) * LINE), dpi=DPI, layout="constrained")
    axes = level_axes(figure, level)
    _add_reach(axes, reach)
    figure.legend(handles=legend, loc="outside lower left", ncols=columns, fontsize=8, frameon=False)
    return png(figure)


def draw_episode(episode: Episode, size: tuple[int, int] | None = None, notation: Notation = "english") -> bytes:
    """Draw the plan of an episode as a PNG.

    The PNG is ``size`` (width, height) pixels large. By default, the plan has its
    :func:`natural_size`. It shows the player's path, where the automaton's state changed, and how
    the episode ended. The legend says what remained to be satisfied in each state.
    """
    states = episode.states.tolist()
    path = [shot.player.position for shot in episode.snapshots]
    visited = list(dict.fromkeys(states))[:MOST_LISTED]
    below = (len(visited) + 2) * LINE
    width, height = natural_size(episode.level)
    inches = (size[0] / DPI, size[1] / DPI) if size else (width, height + below)
    figure = Figure(figsize=inches, dpi=DPI, layout="constrained")
    axes = level_axes(figure, episode.level, start=False)
    scale = _text_scale(figure, episode.level)
    title = f"{episode.level.name} {episode.level.variant}, {episode.player}, seed {episode.seed}: {episode.end}"
    axes.set_title("")
    # A character is about 0.65 times as wide as it is high.
    figure.suptitle(title, fontsize=min(12.0, inches[0] * 72 / (0.65 * len(title))))
    _add_path(axes, path, states)
    dot = 9 * scale
    marks = [_mark(axes, path[0], "o", "white", "start", dot)]
    # The last row is left out: the mark of the end covers it and names its state.
    for row in (row for row in range(1, len(states) - 1) if states[row] != states[row - 1]):
        _mark(axes, path[row], "o", state_colour(states[row]), str(states[row]), dot)
        axes.annotate(str(states[row]), path[row][:2], color="white", fontsize=6, ha="center", va="center", zorder=7)
    death = next((row for row, shot in enumerate(episode.snapshots) if shot.health <= 0.0), None)
    if death is not None:
        marks.append(_mark(axes, path[death], "P", "white", "without health", 1.6 * dot))
    marks.append(_mark(axes, path[-1], *ENDS[episode.end], f"end: {episode.end}, state {states[-1]}", dot))
    marks[-1].set_zorder(8)
    letters = int(inches[0] * LETTERS_PER_INCH / scale)
    lines = [
        Line2D(
            [], [], color=state_colour(state), linewidth=3, label=state_label(episode.fspa, state, letters, notation)
        )
        for state in visited
    ]
    figure.legend(handles=[*lines, *marks], loc="outside lower left", fontsize=8 * scale, frameon=False)
    return png(figure)


def backdrop(
    level: StealthLevel, size: tuple[int, int]
) -> tuple[NDArray[np.uint8], Callable[[Point], tuple[float, float]]]:
    """Return a picture of a level's plan without what moves, and a function for positions in it.

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
    """Paint red on a plan all cells in which no player can reach ground to stand on."""
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
    """Return the entry for exits in legends, a star."""
    return Line2D([], [], marker="*", linestyle="", color=EXIT, markersize=12, label="exit")


def natural_size(level: StealthLevel) -> tuple[float, float]:
    """Return the width and height, in inches, that a level's plan has by default.

    An inch shows two metres, unless the level is so large that it is scaled down. The height has
    0.4 inches more than the level needs.
    """
    (x0, y0, _), (x1, y1, _) = level.bounds.low, level.bounds.high
    width, height = (x1 - x0) / _METRES_PER_INCH, (y1 - y0) / _METRES_PER_INCH
    shrink = min(1.0, _LONGEST_SIDE / max(width, height))
    return width * shrink, height * shrink + 0.4


def _text_scale(figure: Figure, level: StealthLevel) -> float:
    """Return how large text in a figure is, compared with a plan of :func:`natural_size`.

    The result is from 0.6 to 1: small plans have smaller text.
    """
    roomy = np.minimum(natural_size(level), _ROOMY)
    return float(np.clip((figure.get_size_inches() / roomy).min(), 0.6, 1.0))


def level_axes(figure: Figure, level: StealthLevel, moving: bool = True, start: bool = True) -> Any:
    """Draw a level in new axes of a figure, with the metre as the unit, and return the axes.

    With ``moving``, the plan shows the beginning: barriers are drawn as shut, and movers and
    enemies are named at their initial positions. With ``start``, it shows the player's start. If
    text of full size does not fit, only switches and exits are named.
    """
    (x0, y0, _), (x1, y1, _) = level.bounds.low, level.bounds.high
    axes: Any = figure.add_subplot(
        xlim=(x0, x1),
        ylim=(y0, y1),
        aspect="equal",
        title=f"{level.name} {level.variant}",
        xlabel="x, m",
        ylabel="y, m",
    )
    scale = _text_scale(figure, level)
    roomy, letters = scale == 1.0, 8 * scale
    axes.tick_params(labelsize=10 * scale)
    for axis in (axes.xaxis, axes.yaxis):
        axis.label.set_size(10 * scale)
    for solid in sorted(level.solids, key=lambda solid: solid.box.high[2]):
        axes.add_patch(_area(solid.box, facecolor=SOLIDS[solid.kind], edgecolor="#94a3b8", linewidth=0.4))
    for barrier in level.barriers:
        axes.add_patch(_area(barrier.box, facecolor=BARRIERS[barrier.kind], alpha=0.8 if moving else 0.25))
        if roomy:
            _name(axes, barrier.name, _middle(barrier.box), letters)
    for mover in level.movers:
        axes.plot(*_coordinates(mover.path), color=MOVER, linestyle=":", linewidth=1.5)
        if moving and roomy:
            _name(axes, mover.name, mover.path[0], letters)
    for enemy in level.enemies:
        axes.plot(*_coordinates(patrol_path(level, enemy)), color=ROUTE, linestyle="--", linewidth=1.0)
        if moving and roomy:
            _name(axes, enemy.name, enemy.route[0], letters)
    for switch in level.switches:
        axes.add_patch(Circle(switch.position[:2], switch.radius, facecolor=SWITCH, alpha=0.5))
        _name(axes, switch.name, switch.position, letters)
    for exit_ in level.exits:
        axes.plot(*exit_.position[:2], marker="*", markersize=14 * scale, color=EXIT)
        _name(axes, exit_.name, exit_.position, letters)
    if start:
        axes.plot(*level.start.position[:2], marker="o", markersize=7, color=INK)
    return axes


def patrol_path(level: StealthLevel, enemy: Enemy) -> list[tuple[float, float]]:
    """Return the points of an enemy's patrol, around obstacles, with all barriers shut."""
    floor = grid_of(level).floor(range(len(level.barriers)))
    route = [point[:2] for point in (*enemy.route, enemy.route[0])]
    path = route[:1]
    for goal in route[1:]:
        while (corner := floor.next_point(path[-1], goal)) not in (None, path[-1], goal):
            path.append(corner)
        path.append(goal)
    return path


def _add_path(axes: Any, path: Sequence[Point], states: Sequence[int]) -> None:
    pieces = [(start[:2], end[:2]) for start, end in pairwise(path)]
    colours = [state_colour(state) for state in states[: len(pieces)]]
    axes.add_collection(LineCollection(pieces, colors=colours, linewidths=2.0, capstyle="round", zorder=4))


def _mark(axes: Any, place: Point, marker: str, colour: str, label: str, size: float) -> Any:
    (mark,) = axes.plot(
        *place[:2],
        marker=marker,
        markersize=size,
        markerfacecolor=colour,
        markeredgecolor=INK,
        linestyle="",
        label=label,
        zorder=6,
    )
    return mark


def state_label(fspa: Fspa, state: int, letters: int, notation: Notation = "english") -> str:
    """Return the label of a state in the legend.

    It has the state's number and what remains to be satisfied, cut to ``letters`` characters. In
    notations other than English, the verdict follows if it is settled.
    """
    automaton_state = fspa.states[state]
    text = label_text(fspa, state, notation)
    if len(text) > letters:
        text = text[: letters - 1] + "…"
    settled = (
        f" ({automaton_state.verdict})"
        if automaton_state.verdict in ("satisfied", "violated") and notation != "english"
        else ""
    )
    # matplotlib treats text between dollar signs as mathematics.
    return f"state {state}: {text}{settled}".replace("$", r"\$")


def png(figure: Figure) -> bytes:
    """Encode a figure as a PNG; equal figures give equal bytes."""
    buffer = BytesIO()
    figure.savefig(buffer, format="png", dpi=DPI, metadata={"Software": None})
    return buffer.getvalue()


def _area(box: Box, **style: Any) -> Rectangle:
    (x0, y0, _), (x1, y1, _) = box.low, box.high
    return Rectangle((x0, y0), x1 - x0, y1 - y0, **style)


def _middle(box: Box) -> Point:
    (x0, y0, z0), (x1, y1, _) = box.low, box.high
    return (x0 + x1) / 2, (y0 + y1) / 2, z0


def _coordinates(points: Iterable[Sequence[float]]) -> tuple[list[float], list[float]]:
    sequence = list(points)
    return [point[0] for point in sequence], [point[1] for point in sequence]


def _name(axes: Any, name: str, place: Point, size: float) -> None:
    axes.annotate(name, place[:2], xytext=(0, 7), textcoords="offset points", ha="center", fontsize=size, color=INK)
