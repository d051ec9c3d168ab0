"""Plans: pictures of levels from above, with paths coloured by the automaton's state, as PNG files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from io import BytesIO
from itertools import pairwise
from typing import Any, Final

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from tltl_runtime.game.episode import RecordedEpisode, Trajectory
from tltl_runtime.game.geometry import Box, Point
from tltl_runtime.game.palette import ENDS, INK, state_colour
from tltlc.api import Fspa, Notation, label_text, record

DPI: Final = 100
_METRES_PER_INCH: Final = 2.0
_LONGEST_SIDE: Final = 40.0
"""The longest side of a picture, in inches; larger levels are scaled down."""

LINE: Final = 0.22
"""The height of a line of the legend, in inches."""

_ROOMY: Final = 6.0
"""A picture at least this wide and high, in inches, has text of full size.

A smaller picture has text of full size only if it is as large as its :func:`plan_size`.
"""

MOST_LISTED: Final = 12
"""The greatest number of states that the legend lists."""

LETTERS_PER_INCH: Final = 12
"""Characters per inch of a line of the legend; longer lines are cut."""

_FAINTEST: Final = 0.12
"""The least opacity of a trajectory, if there are very many."""


@record
class Plan:
    """How to draw the plan of a level.

    ``bounds`` are those of the level. ``axes`` is a function that draws the level into a new figure and
    returns its axes. ``metre`` says how many metres of the level a metre on the plan stands for.
    ``marks`` are handles of matplotlib for further entries of the legend.
    """

    bounds: Box
    axes: Callable[[Figure], Any]
    metre: float = 1.0
    marks: tuple[Any, ...] = ()


def draw_path(
    plan: Plan,
    episode: RecordedEpisode,
    path: Sequence[Point],
    size: tuple[int, int] | None,
    notation: Notation,
    death: int | None = None,
) -> bytes:
    """Draw the path of an episode on the plan of its level; return a PNG.

    ``path`` has a point for the moment of the reset and one for each step. The picture shows the path,
    where the automaton's state changed, and how the episode ended. The legend says, in ``notation``,
    what remained to be satisfied in each state.

    ``size`` is the width and height of the picture, in pixels; if it is None, the plan has its
    :func:`plan_size`. ``death`` is the index in ``path`` of the moment at which the player had no health
    left; None if there is none.
    """
    states = episode.states.tolist()
    visited = list(dict.fromkeys(states))[:MOST_LISTED]
    below = (len(visited) + 2) * LINE
    width, height = plan_size(plan.bounds, plan.metre)
    inches = (size[0] / DPI, size[1] / DPI) if size else (width, height + below)
    figure = Figure(figsize=inches, dpi=DPI, layout="constrained")
    axes = plan.axes(figure)
    scale = text_scale(figure, plan.bounds, plan.metre)
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


def draw_paths(plan: Plan, fspa: Fspa, trajectories: Sequence[Trajectory], title: str) -> bytes:
    """Draw trajectories on the plan of a level, coloured by the automaton's state; return a PNG.

    Marks show where episodes ended; the marks of successes are small. The legend says what remained
    to be satisfied in each state and how many episodes ended in each way.
    """
    visited = sorted({int(state) for trajectory in trajectories for state in trajectory.states[:-1]})[:MOST_LISTED]
    ends = Counter(trajectory.end for trajectory in trajectories)
    width, height = plan_size(plan.bounds, plan.metre)
    inches = (width, height + (len(visited) + len(ends) + len(plan.marks) + 1) * LINE)
    figure = Figure(figsize=inches, dpi=DPI, layout="constrained")
    axes = plan.axes(figure)
    axes.set_title(title, fontsize=min(12.0, inches[0] * 72 / (0.65 * len(title))))
    opacity = max(_FAINTEST, min(0.9, 4.0 / max(1, len(trajectories))))
    for trajectory in trajectories:
        pieces = [trajectory.points[row : row + 2] for row in range(len(trajectory.points) - 1)]
        colours = [state_colour(int(state)) for state in trajectory.states[:-1]]
        axes.add_collection(LineCollection(pieces, colors=colours, linewidths=1.5, alpha=opacity, zorder=4))
    for trajectory in trajectories:
        (marker, colour), success = ENDS[trajectory.end], trajectory.end == "success"
        style = {"markersize": 4 if success else 8, "zorder": 5 if success else 6}
        axes.plot(*trajectory.points[-1], marker=marker, color=colour, markeredgecolor="white", **style)
    letters = int(inches[0] * LETTERS_PER_INCH)
    lines = [
        Line2D([], [], color=state_colour(state), linewidth=3, label=state_label(fspa, state, letters))
        for state in visited
    ]
    marks = []
    for end, count in sorted(ends.items()):
        label = f"end: {end}, {count} episode{'s' * (count != 1)}"
        marks.append(Line2D([], [], linestyle="", marker=ENDS[end][0], color=ENDS[end][1], label=label))
    figure.legend(handles=[*lines, *marks, *plan.marks], loc="outside lower left", fontsize=8, frameon=False)
    return png(figure)


def plan_size(bounds: Box, metre: float = 1.0) -> tuple[float, float]:
    """Return the width and height, in inches, that the plan of a level has by default.

    An inch shows two metres of the plan; very large plans are scaled down. ``metre`` is as in
    :class:`Plan`. The height has 0.4 inches more than the level needs.
    """
    (x0, y0, _), (x1, y1, _) = bounds.low, bounds.high
    width, height = (x1 - x0) / metre / _METRES_PER_INCH, (y1 - y0) / metre / _METRES_PER_INCH
    shrink = min(1.0, _LONGEST_SIDE / max(width, height))
    return width * shrink, height * shrink + 0.4


def text_scale(figure: Figure, bounds: Box, metre: float = 1.0) -> float:
    """Return the factor, from 0.6 to 1, by which the text of a figure is scaled.

    It is below 1 if a side of the figure is shorter than six inches, and shorter than in the plan's
    :func:`plan_size`.
    """
    roomy = np.minimum(plan_size(bounds, metre), _ROOMY)
    return float(np.clip((figure.get_size_inches() / roomy).min(), 0.6, 1.0))


def plan_axes(figure: Figure, bounds: Box, title: str, scale: float, unit: str = "m") -> Any:
    """Return new axes of a figure for a plan; ``scale`` is the factor of its text, from :func:`text_scale`.

    ``unit`` is the unit of the coordinates; empty if it is not known.
    """
    of_unit = f", {unit}" if unit else ""
    (x0, y0, _), (x1, y1, _) = bounds.low, bounds.high
    axes: Any = figure.add_subplot(
        xlim=(x0, x1), ylim=(y0, y1), aspect="equal", title=title, xlabel=f"x{of_unit}", ylabel=f"y{of_unit}"
    )
    axes.tick_params(labelsize=10 * scale)
    for axis in (axes.xaxis, axes.yaxis):
        axis.label.set_size(10 * scale)
    return axes


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
    notations other than English, the verdict follows if it is ``satisfied`` or ``violated``.
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


def area(box: Box, **style: Any) -> Rectangle:
    """Return a rectangle of matplotlib that shows a box from above; ``style`` are the rectangle's properties."""
    (x0, y0, _), (x1, y1, _) = box.low, box.high
    return Rectangle((x0, y0), x1 - x0, y1 - y0, **style)


def write_name(axes: Any, name: str, place: Point, size: float) -> None:
    """Write a name above a place; ``size`` is the size of its letters, in points."""
    # matplotlib treats text between dollar signs as mathematics.
    name = name.replace("$", r"\$")
    axes.annotate(name, place[:2], xytext=(0, 7), textcoords="offset points", ha="center", fontsize=size, color=INK)
