"""The trajectories of many episodes on the plan of their level: an overview for designers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Final

from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from tltl_runtime.game.episode import Trajectory
from tltl_runtime.game.palette import ENDS, state_colour
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.rendering.plan import (
    DPI,
    LETTERS_PER_INCH,
    LINE,
    MOST_LISTED,
    exit_mark,
    level_axes,
    natural_size,
    png,
    state_label,
)
from tltlc.api import Fspa

_FAINTEST: Final = 0.12
"""The least opacity of a trajectory, if there are very many."""


def draw_trajectories(level: StealthLevel, fspa: Fspa, trajectories: Sequence[Trajectory], title: str) -> bytes:
    """Draw trajectories on the plan of a level, coloured by the automaton's state, as a PNG.

    Marks show where episodes ended; the marks of successes are small. The legend says what remained
    to be satisfied in each state, how many episodes ended in each way, and which mark is an exit.
    """
    visited = sorted({int(state) for trajectory in trajectories for state in trajectory.states[:-1]})[:MOST_LISTED]
    ends = Counter(trajectory.end for trajectory in trajectories)
    width, height = natural_size(level)
    inches = (width, height + (len(visited) + len(ends) + bool(level.exits) + 1) * LINE)
    figure = Figure(figsize=inches, dpi=DPI, layout="constrained")
    axes = level_axes(figure, level)
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
    marks += [exit_mark()] if level.exits else []
    figure.legend(handles=[*lines, *marks], loc="outside lower left", fontsize=8, frameon=False)
    return png(figure)
