"""Advice on games whose steps are slow."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from tltl_runtime.wire.wire_game import WireGame

SLOW: Final = 200.0
"""Steps a second; fewer are slow."""

_MANY_STEPS: Final = 1_000_000
"""A usual number of steps of a training."""

_REAL_TIME: Final = (0.8, 1.05)
"""A game whose speed is this share of its clock seems to wait for the wall's clock."""

_GODOT_OPTIONS: Final = ("--fixed-fps", "--disable-render-loop")


def speed_advice(wire: WireGame | None, steps_per_s: float, clock_s: float | None) -> str:
    """Return how long a training takes with a slow game, and what makes the game faster; empty for a fast game.

    ``wire`` says how a game in another process is started; None for one in this process. ``clock_s`` is the length of
    a step in seconds by the game's own clock; None if it is unknown.
    """
    if steps_per_s >= SLOW:
        return ""
    takes = f"{_MANY_STEPS:,} steps of a training take {_time_text(_MANY_STEPS / max(steps_per_s, 1e-9))} in one game"
    return f"{takes}; {_way_out(wire, steps_per_s, clock_s)}"


def _way_out(wire: WireGame | None, steps_per_s: float, clock_s: float | None) -> str:
    if wire is None:
        return "let a step of the environment be several ticks of the game, or observe less"
    missing = [option for option in _GODOT_OPTIONS if option not in wire.process]
    if _is_godot(wire) and missing:
        options = " ".join(missing).replace("--fixed-fps", "--fixed-fps N")
        where = ", where N is the project's physics frames a second" if "--fixed-fps" in missing else ""
        return f"Godot waits for the wall's clock: add `{options}` to `process`{where}"
    if clock_s and _REAL_TIME[0] <= steps_per_s * clock_s <= _REAL_TIME[1]:
        return (
            "that is its own clock, so it seems to wait for the wall's: let each step be played at once, without vsync "
            "and without a limit of frames a second"
        )
    more = "" if wire.connect else ", and let `train` play more games at once (`envs` and `workers` under `[rollout]`)"
    return f"play without a window, sound and vsync, let an action last several ticks{more}"


def _is_godot(wire: WireGame) -> bool:
    return bool(wire.process) and "godot" in Path(wire.process[0]).name.lower()


def _time_text(seconds: float) -> str:
    if seconds < 48 * 3600:
        return f"{seconds / 3600:.1f} hours"
    return f"{seconds / 86400:.0f} days"
