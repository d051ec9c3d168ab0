"""Clauses for sentences about periods judge traces as their words do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pytest

import tltlc
from tests.grammar.sentences import HEAD, read
from tltlc.monitor import Monitor

STEPS = {
    ".": {"fire": False, "spray": False},
    "f": {"fire": True, "spray": False},
    "s": {"fire": False, "spray": True},
    "b": {"fire": True, "spray": True},
}
"""The steps of a trace, by a letter: with `fire`, with `spray`, or with both."""
EVENTS = [
    # Sentence, index of the reading, traces that keep the rule, traces that break it.
    ("at most 2 fire since spray", 0, ["f.fs.f.f", "ffff", "f.fb.f", "f.f"], ["f.f.f", "s.f.f.f", "b.f.f"]),
    ("at most one fire per spray", 0, ["sbs", "f..s.f", "s.f.s.f", "sf.s"], ["sf.f", "f.f", "sbs.f"]),
    ("at most one fire per spray", 1, ["sbs.f", "f.f.f", "s.f.f", "sbs.sbs"], ["sbsb", "bsb"]),
    ("fire at most 1 times while spray", 0, ["sbs.sbs", "fssf.f"], ["sbsb"]),
    ("fire at most 1 times while spray", 1, ["sbs.ss", "fssf.f"], ["sbsb", "sbs.sbs"]),
    ("no more than 1 fire between two spray", 0, ["s.f.s.f", "sfs"], ["s.f.f", "s.f.fs"]),
    ("at least 2 fire between spray and spray", 0, ["sf.fs", "s.f", "....s", "sf.f.f..s"], ["sfs", "f.fs.s"]),
    (
        "exactly one fire between spray and the next spray",
        0,
        ["s.f.s", "f.fs.fs", "sf", "s.."],
        ["s.f.f", "s..s", "s.f.f.s", "s.s"],
    ),
    ("at least 2 fire before spray", 0, ["f.fs", "f.fs.s", "f.b"], ["fs", "s", ".s"]),
    ("at least 2 fire before spray", 1, ["f.fs", "f.fsf.fs"], ["fs", "s", "f.fs.s"]),
    ("at most 1 fire between spray and boss_dead", 0, ["f.f.f", "sf", "s.f"], ["sf.f", "bf.f"]),
    ("when fire twice, spray within 0.2 s", 0, ["f.fs", "f.fsf.s", "f..", "f.f.s"], ["f.f....", "f.fsf.f...."]),
    ("when fire twice, spray within 0.2 s", 1, ["f.fs", "f.fsf.f....", "f.."], ["f.f...."]),
    ("fire at most 0.3 s in total", 0, ["ffff", "f.f.f.f", ".ff.f"], ["fffff", "f.f.f.f.f", ".ff.ff"]),
    ("fire at most 3 steps in total", 0, ["fff", "f.f.f"], ["ffff", "f.f.f.f"]),
]
NUMBERS = [
    ("at most 1 fire per lap", 0, ([True, False, True], [1, 1, 2]), True),
    ("at most 1 fire per lap", 0, ([True, False, True], [1, 1, 1]), False),
    ("at least 1 fire per lap", 0, ([True, False, True, False], [1, 2, 2, 3]), True),
    ("at least 1 fire per lap", 0, ([True, False, False, False], [1, 2, 2, 3]), False),
]
COINS = [
    ("gain at least 5 coins per lap", [1, 1, 2, 2, 3], [0, 5, 6, 10, 12], True),
    ("gain at least 5 coins per lap", [1, 1, 2, 2, 3], [0, 5, 6, 10, 10], False),
    ("gain no more than 5 coins per lap", [1, 1, 2, 2, 2], [0, 5, 9, 10, 14], True),
    ("gain no more than 5 coins per lap", [1, 1, 2, 2, 2], [0, 5, 9, 10, 15], False),
]
FIRES = [
    ("never lose more than 5 coins in one fire", "..ff.", [20, 10, 10, 5, 0], True),
    ("never lose more than 5 coins in one fire", ".fff.", [20, 10, 7, 4, 4], False),
    ("when fire ends, coins >= coins when fire started", "fff.", [5, 3, 9, 5], True),
    ("when fire ends, coins >= coins when fire started", "fff.", [5, 9, 9, 4], False),
    ("coins returns to what it was when fire began", "ff.", [5, 9, 5], True),
    ("coins returns to what it was when fire began", "ff.", [5, 5, 6], False),
]


def is_kept(typed: str, index: int, steps: Sequence[Mapping[str, bool | int]]) -> bool:
    """Whether a trace keeps the clauses of a reading."""
    clauses = "\n".join(read(typed).readings[index].clauses)
    (fspa,) = tltlc.compile_text(f"{HEAD}spec s {{\n{clauses}\n}}\n")
    monitor = Monitor(fspa)
    rest = {
        "fire": False,
        "spray": False,
        "boss_dead": False,
        "coins": 0,
        "lap": 1,
        "health": 1,
        "phase": 0,
        "state": 0,
    }
    verdicts = [monitor.step({**rest, **step}) for step in steps]
    return verdicts[-1].accepting


@pytest.mark.parametrize(("typed", "index", "kept", "broken"), EVENTS)
def test_a_rule_about_events_judges_traces(typed: str, index: int, kept: list[str], broken: list[str]) -> None:
    for traces, expected in ((kept, True), (broken, False)):
        for trace in traces:
            assert is_kept(typed, index, [STEPS[letter] for letter in trace]) is expected, trace


@pytest.mark.parametrize(("typed", "index", "trace", "expected"), NUMBERS)
def test_a_count_begins_with_each_value_of_a_number(
    typed: str, index: int, trace: tuple[list[bool], list[int]], expected: bool
) -> None:
    steps = [{"fire": fire, "lap": lap} for fire, lap in zip(*trace, strict=True)]
    assert is_kept(typed, index, steps) is expected


@pytest.mark.parametrize(("typed", "laps", "coins", "expected"), COINS)
def test_a_number_is_compared_with_its_value_when_the_period_began(
    typed: str, laps: list[int], coins: list[int], expected: bool
) -> None:
    steps = [{"lap": lap, "coins": number} for lap, number in zip(laps, coins, strict=True)]
    assert is_kept(typed, 0, steps) is expected


@pytest.mark.parametrize(("typed", "fires", "coins", "expected"), FIRES)
def test_a_number_is_compared_with_its_value_when_something_began(
    typed: str, fires: str, coins: list[int], expected: bool
) -> None:
    steps = [{**STEPS[letter], "coins": number} for letter, number in zip(fires, coins, strict=True)]
    assert is_kept(typed, 0, steps) is expected
