"""The head-up display: health, stamina, sight, what remains to be done, and the end."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import wrap
from typing import Any, Final, Literal

from tltl_runtime.game.episode import Cause, EndKind
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot
from tltl_runtime.stealth.world.player import DECISION
from tltlc.api import Fspa, formula_text, label_text, record, replace

Tone = Literal["plain", "quiet", "good", "bad", "warn", "dark"]
"""The meaning of a line or a bar. A screen shows it by colour."""

KEYS: Final = ("WASD or arrows: walk   shift: sprint   C: crouch   space: jump", "V: view   R: again   Esc: stop")

_TITLES: Final[dict[EndKind, str]] = {
    "success": "success",
    "killed": "you died",
    "violated": "the spec is violated",
    "limit": "time is up",
    "no way": "time is up",
    "stopped": "stopped",
}
_WIDTH: Final = 36
"""Characters per line beside the picture."""
_LONG: Final = 72
"""Characters per line below a title."""
_MOST_LINES: Final = 10
"""At most this many lines beside the picture say what remains to be done."""


@record
class Bar:
    """A bar in the head-up display that shows a named number in [0, 1]."""

    name: str
    value: float
    tone: Tone


@record
class Line:
    """A line of text in the head-up display."""

    text: str
    tone: Tone = "plain"


@record
class Hud:
    """The head-up display: bars and lines.

    While the game stands still, there is also a ``title``, with the lines ``below``.
    """

    bars: tuple[Bar, ...]
    lines: tuple[Line, ...]
    title: str = ""
    tone: Tone = "plain"
    below: tuple[str, ...] = ()


def hud(snapshot: Snapshot, info: Mapping[str, Any], fspa: Fspa) -> Hud:
    """Return the head-up display during play.

    ``info`` is that of the environment's last step or reset.
    """
    bars = (
        Bar("health", snapshot.health, "good" if snapshot.health > 0.5 else "bad"),
        Bar("stamina", snapshot.player.stamina, "plain"),
        Bar("progress", info["progress"], "warn"),
    )
    lines = [Line(f"{_clock(snapshot.time, fspa)}   {info['verdict']}", "quiet")]
    if snapshot.enemies:
        lines.append(_sight_line(snapshot))
    lines += [Line(text) for text in _shorten(label_text(fspa, info["state"]))]
    return Hud(bars, tuple(lines))


def start_screen(display: Hud, level: StealthLevel, fspa: Fspa) -> Hud:
    """Add the title, the goal and the keys to a display, for the screen before the first action."""
    goal = wrap(formula_text(fspa), _LONG)
    below = (*wrap(level.doc, _LONG), "", *goal, "", *KEYS, "", "Move to begin.")
    return replace(display, title=f"{level.name} {level.variant}", below=below)


def end_screen(display: Hud, cause_of_end: Cause, file: str) -> Hud:
    """Add the end and its cause to a display, for the screen after the last step.

    ``file`` is the name of the recording.
    """
    tone: Tone = "good" if cause_of_end.kind == "success" else "bad"
    below = (*wrap(cause_of_end.text, _LONG), f"recorded: {file}", "R: again   Esc: close")
    return replace(display, title=_TITLES[cause_of_end.kind], tone=tone, below=below)


def _clock(seconds: float, fspa: Fspa) -> str:
    """Return the game time as text, with the time left if the spec has a limit."""
    if fspa.limit_steps is None:
        return f"{seconds:.1f} s"
    return f"{seconds:.1f} s, {max(0.0, fspa.limit_steps * DECISION - seconds):.0f} s left"


def _sight_line(snapshot: Snapshot) -> Line:
    if "chase" in snapshot.modes:
        return Line("you are chased", "bad")
    if any(snapshot.sees):
        return Line("you are in sight", "warn")
    return Line("they search for you", "warn") if "search" in snapshot.modes else Line("nobody sees you", "good")


def _shorten(text: str) -> list[str]:
    lines = wrap(text, _WIDTH)
    if len(lines) <= _MOST_LINES:
        return lines
    return [*lines[: _MOST_LINES - 1], f"{lines[_MOST_LINES - 1][: _WIDTH - 2]} …"]
