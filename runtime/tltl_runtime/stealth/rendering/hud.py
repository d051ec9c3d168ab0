"""The head-up display of the stealth game: health, stamina, sight, and what remains to be done."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import wrap
from typing import Any, Final

from tltl_runtime.game.hud import LONG, Bar, Hud, Line, clock_text, goal_lines
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.player import DECISION
from tltlc.api import Fspa, formula_text, label_text, replace

LOW_HEALTH: Final = 0.5
"""Up to this health, its bar is red; above, it is green."""

KEYS: Final = ("WASD or arrows: walk   shift: sprint   C: crouch   space: jump", "V: view   R: again   Esc: stop")


def hud(snapshot: Snapshot, info: Mapping[str, Any], fspa: Fspa) -> Hud:
    """Return the head-up display during play.

    ``info`` is that of the environment's last step or reset.
    """
    bars = (
        Bar("health", snapshot.health, "good" if snapshot.health > LOW_HEALTH else "bad"),
        Bar("stamina", snapshot.player.stamina, "plain"),
        Bar("progress", info["progress"], "warn"),
    )
    lines = [Line(f"{clock_text(snapshot.time, fspa, DECISION)}   {info['verdict']}", "quiet")]
    if snapshot.enemies:
        lines.append(_sight_line(snapshot))
    lines += goal_lines(label_text(fspa, info["state"]))
    return Hud(bars, tuple(lines))


def start_screen(display: Hud, level: StealthLevel, fspa: Fspa) -> Hud:
    """Add the title, the goal and the keys to a display, for the screen before the first action."""
    goal = wrap(formula_text(fspa), LONG)
    below = (*wrap(level.doc, LONG), "", *goal, "", *KEYS, "", "Move to begin.")
    return replace(display, title=f"{level.name} {level.variant}", below=below)


def _sight_line(snapshot: Snapshot) -> Line:
    if "chase" in snapshot.modes:
        return Line("you are chased", "bad")
    if any(snapshot.sees):
        return Line("you are in sight", "warn")
    return Line("they search for you", "warn") if "search" in snapshot.modes else Line("nobody sees you", "good")
