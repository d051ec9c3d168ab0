"""The head-up display of a window: bars and lines beside the picture, and a title over it."""

from __future__ import annotations

from textwrap import wrap
from typing import Final, Literal

from tltl_runtime.game.episode import Cause, EndKind
from tltlc.api import Fspa, record, replace

Tone = Literal["plain", "quiet", "good", "bad", "warn", "dark"]
"""The meaning of a line or a bar. A screen shows it by colour."""

LONG: Final = 72
"""Characters per line below a title."""

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


def clock_text(seconds: float, fspa: Fspa, step_s: float) -> str:
    """Return the time of the game as text, such as ``12.3 s, 27 s left``.

    The time left is shown if the spec has a limit. ``step_s`` is the length of a step in seconds.
    """
    if fspa.limit_steps is None:
        return f"{seconds:.1f} s"
    return f"{seconds:.1f} s, {max(0.0, fspa.limit_steps * step_s - seconds):.0f} s left"


def goal_lines(text: str) -> tuple[Line, ...]:
    """Wrap a text that says what remains to be done into lines beside the picture; cut it after ten lines."""
    lines = wrap(text, _WIDTH)
    if len(lines) > _MOST_LINES:
        lines = [*lines[: _MOST_LINES - 1], f"{lines[_MOST_LINES - 1][: _WIDTH - 2]} …"]
    return tuple(map(Line, lines))


def end_screen(display: Hud, cause_of_end: Cause, file: str) -> Hud:
    """Add the end and its cause to a display, for the screen after the last step.

    ``file`` is the name of the recording.
    """
    tone: Tone = "good" if cause_of_end.kind == "success" else "bad"
    below = (*wrap(cause_of_end.text, LONG), f"recorded: {file}", "R: again   Esc: close")
    return replace(display, title=_TITLES[cause_of_end.kind], tone=tone, below=below)
