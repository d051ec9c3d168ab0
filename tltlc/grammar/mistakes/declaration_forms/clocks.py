"""Read clocks in other forms: ``rate 30 fps``, ``dt = 0.1``, ``clock: 60 Hz``, ``timestep 1/60 s``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.declaration_forms.meant import Cursor, MeantDeclaration

_RATES: Final = frozenset(
    """
    rate fps framerate frame_rate tickrate tick_rate frequency freq hz sampling sample_rate samplerate sampling_rate
    update_rate refresh_rate steps_per_second ticks_per_second frames_per_second target_fps simulation_rate
    """.split()
)
"""Words after which a number without a unit counts samples per second."""
_PERIODS: Final = frozenset(
    """
    dt delta_t deltatime delta_time timestep time_step step_size step_time tick_time frame_time step_length period
    sample_time sampling_time sampling_period fixed_dt timestep_s dt_s step_s fixed_timestep
    """.split()
)
"""Words after which a number without a unit is a number of seconds."""
_NEUTRAL: Final = frozenset(
    "clock tick ticks step steps frame frames time timing simulation sample samples game".split()
)
"""Words that name a clock together with one of the others, or with a number that has a unit."""
CLOCK_WORDS: Final = _RATES | _PERIODS
_FILLERS: Final = (":", "=", "is", "at", "of", "every", "fixed", "with", "to", "@")
_PER_SECOND: Final = ("second", "sec", "s")
_SECONDS: Final = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("ms", "msec", "msecs", "millisecond", "milliseconds"), "ms"),
}
_FREQUENCIES: Final = ("hz", "fps", "hertz")
_COUNTED: Final = ("frames", "steps", "ticks", "samples", "updates", "frame", "step", "tick", "times")


def read_clock(tokens: Sequence[Token]) -> MeantDeclaration | None:
    """Return the clock that a piece is meant to declare, or None."""
    cursor = Cursor(tokens)
    words: list[str] = []
    while cursor.token.text.lower() in CLOCK_WORDS | _NEUTRAL:
        words.append(cursor.token.text.lower())
        cursor.at += 1
    if not words or not _names_clock(words):
        return None
    while cursor.accept(*_FILLERS):
        pass
    if cursor.accept("varies", "variable", "varying", "any"):
        return MeantDeclaration("clock", ("clock varies",), ("clock varies",)) if _is_end(cursor, words) else None
    if cursor.token.type != "NUMBER":
        return None
    number = cursor.token.text
    cursor.at += 1
    is_fraction = number == "1" and cursor.peek().text == "/" and cursor.peek(1).type == "NUMBER"
    if is_fraction:
        number = cursor.peek(1).text
        cursor.at += 2
    unit = _unit(cursor)
    if unit is None or not _is_end(cursor, words):
        return None
    if not unit:
        unit = _unit_of(words)
    if not unit:
        help_ = f"write `clock {number} Hz` for {number} steps a second, `clock {number} s` for the time of one step"
        return MeantDeclaration("clock", (f"clock {number} Hz",), (), False, help_)
    if is_fraction:
        unit = {"s": "Hz", "Hz": "s"}.get(unit, "")
    line = f"clock {number} {unit}"
    return MeantDeclaration("clock", (line,), (line,)) if unit and float(number) > 0 else None


def _names_clock(words: Sequence[str]) -> bool:
    """Whether words such as ``tick rate`` name a clock; ``step`` and ``time`` alone do not."""
    return words[0] == "clock" or bool(CLOCK_WORDS.intersection(words)) or words == ["time", "step"]


def _unit_of(words: Sequence[str]) -> str:
    """Return the unit of a number after these words: ``Hz``, ``s``, or empty if it may be either."""
    if _RATES.intersection(words):
        return "Hz"
    return "s" if _PERIODS.intersection(words) or list(words) == ["time", "step"] else ""


def _unit(cursor: Cursor) -> str | None:
    """Read a unit and return ``Hz``, ``s`` or ``ms``; empty if there is none, None if it is another one."""
    word = cursor.token.text.lower()
    if cursor.is_done or word in (";", ","):
        return ""
    if word in _SECONDS:
        cursor.at += 1
        return _SECONDS[word]
    if word in _FREQUENCIES:
        cursor.at += 1
        return "Hz"
    cursor.accept(*_COUNTED)
    is_per_second = (cursor.accept("per", "a", "each") or cursor.accept("/")) and cursor.accept(*_PER_SECOND)
    return "Hz" if is_per_second else None


def _is_end(cursor: Cursor, words: Sequence[str]) -> bool:
    """Read a mark at the end; return whether nothing else follows."""
    cursor.accept(";", ",")
    return cursor.is_done and bool(words)
