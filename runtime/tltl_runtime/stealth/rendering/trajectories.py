"""The trajectories of many episodes on the plan of their level: an overview for designers."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.game.episode import Trajectory
from tltl_runtime.game.plan import Plan, draw_paths
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.rendering.plan import exit_mark, level_axes
from tltlc.api import Fspa


def draw_trajectories(level: StealthLevel, fspa: Fspa, trajectories: Sequence[Trajectory], title: str) -> bytes:
    """Draw the trajectories of many episodes on the plan of a level (a map from above), as a PNG.

    See :func:`~tltl_runtime.game.plan.draw_paths`. The legend also says which mark is an exit.
    """
    marks = (exit_mark(),) if level.exits else ()
    return draw_paths(
        Plan(level.bounds, lambda figure: level_axes(figure, level), marks=marks), fspa, trajectories, title
    )
