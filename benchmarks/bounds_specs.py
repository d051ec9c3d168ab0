"""Specs with bounds at 60 Hz, the same without bounds or without timers, and traces for them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from random import Random
from typing import Final

from benchmarks.specs import source

NAMES: Final = ("deadlines", "metroidvania")
"""The specs whose monitors are timed."""

Trace = list[dict[str, float]]


def _deadlines(name: str, bound: str) -> str:
    return f"""
clock 60 Hz
signal alarm: bool
signal hidden: bool
signal out: bool
spec {name} {{
    keep alarm implies eventually{bound} hidden
    keep hidden implies eventually{bound} out
}}
"""


def _ten() -> str:
    signals = "".join(f"signal a{i}: bool\nsignal b{i}: bool\n" for i in range(10))
    clauses = "".join(f"    keep a{i} implies eventually within 10 min b{i}\n" for i in range(10))
    return f"clock 60 Hz\n{signals}spec ten {{\n{clauses}}}\n"


SPECS: Final = {
    "unbounded": _deadlines("unbounded", ""),
    "deadlines": _deadlines("deadlines", " within 5 s"),
    "ten": _ten(),
    "metroidvania": source("metroidvania").read_text(encoding="utf-8"),
}
"""The texts that are compiled, by the name of the spec in them."""


def _timerless(signals: Sequence[str], clauses: Sequence[str]) -> str:
    declarations = "".join(f"signal {signal}: bool\n" for signal in signals)
    return declarations + "spec without_timers {\n" + "".join(f"    keep {clause}\n" for clause in clauses) + "}\n"


def _responses(count: int) -> list[str]:
    return [clause for i in range(count) for clause in (f"not late{i}", f"due{i} implies next true")]


ATOMS: Final[Mapping[str, Mapping[str, str]]] = {
    "deadlines": {
        "late0": "late(5 s, alarm, hidden)",
        "due0": "due(alarm, hidden)",
        "late1": "late(5 s, hidden, out)",
        "due1": "due(hidden, out)",
    },
    "metroidvania": {
        "boss_door": "boss_door",
        "once_double_jump": "once double_jump",
        **{
            f"breach{pit}": f"breach(the next 10 s, begins falls(pit{pit}), !begins falls(pit{pit}))"
            for pit in (1, 2, 3)
        },
        **{f"begun{pit}": f"(begins falls(pit{pit}))" for pit in (1, 2, 3)},
        "breach4": "breach(the next 1 s, begins damage, !damage)",
        "begun4": "(begins damage)",
        **{f"late{guard}": f"late(5 s, alarm, answers(g{guard + 1}))" for guard in range(3)},
        **{f"due{guard}": f"due(alarm, answers(g{guard + 1}))" for guard in range(3)},
    },
}
"""For the signals of a spec without timers, the atoms of the spec with timers that they stand for."""

TIMERLESS: Final = {
    "deadlines": _timerless([*ATOMS["deadlines"]], _responses(2)),
    "metroidvania": _timerless(
        [*ATOMS["metroidvania"]],
        [
            "boss_door implies once_double_jump",
            *(c for i in (1, 2, 3, 4) for c in (f"not breach{i}", f"begun{i} implies next true")),
            *_responses(3),
        ],
    ),
}
"""The same automata, whose timers are signals."""


def trace(name: str, random: Random, length: int, longest: float = 0.95) -> Trace:
    """Return a trace in which events come at random times.

    ``longest`` is the greatest time to an answer, and the inverse of the least time between falls, as a
    share of what the rules allow: up to 1, the trace breaks no rule.
    """
    answered = _events(random, length, 1, max(1, int(300 * longest)))
    if name == "deadlines":
        columns = {"alarm": _events(random, length, 20, 400), "hidden": answered}
        columns["out"] = _events(random, length, 1, max(1, int(300 * longest)))
    else:
        columns = {
            "double_jump": [float(i == 5) for i in range(length)],
            "boss_door": [float(i > 5 and random.random() < 0.05) for i in range(length)],
            "damage": _events(random, length, max(2, int(62 / longest)), 300),
            "alarm": _events(random, length, 20, 400),
            **{f"falls(pit{pit})": _events(random, length, max(2, int(602 / longest)), 1500) for pit in (1, 2, 3)},
            **{f"answers(g{guard})": _events(random, length, 1, max(1, int(300 * longest))) for guard in (1, 2, 3)},
        }
    return [{signal: column[i] for signal, column in columns.items()} for i in range(length)]


def _events(random: Random, length: int, least: int, most: int) -> list[float]:
    """Return a column in which single samples are 1, from ``least`` to ``most`` samples after each other."""
    column = [0.0] * length
    place = random.randint(0, most - 1)
    while place < length:
        column[place] = 1.0
        place += random.randint(least, most)
    return column
