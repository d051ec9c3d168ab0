"""Clauses for sentences about windows of time, and about what was so long ago, judge traces as their words do."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import pytest

import tltlc
from tests.grammar.sentences import HEAD, read
from tltlc.monitor import Monitor

STEPS = 2
"""The steps of 0.2 s."""
TRACES = [*product((False, True), repeat=5)]
"""Where `spray` holds."""


def is_kept(typed: str, index: int, fire: Sequence[bool], spray: Sequence[bool]) -> bool:
    """Whether a trace keeps the clauses of a reading."""
    clauses = "\n".join(read(typed).readings[index].clauses)
    (fspa,) = tltlc.compile_text(f"{HEAD}spec s {{\n{clauses}\n}}\n")
    monitor = Monitor(fspa)
    rest = {"boss_dead": False, "coins": 0, "lap": 1, "health": 1, "phase": 0, "state": 0}
    steps = zip(fire, spray, strict=True)
    verdicts = [monitor.step({"fire": fires, "spray": sprays, **rest}).verdict for fires, sprays in steps]
    return "violated" not in verdicts


@pytest.mark.parametrize("spray", TRACES)
def test_an_event_so_long_ago_is_any_of_its_kind_or_the_last(spray: tuple[bool, ...]) -> None:
    now = len(spray) - 1
    fire = [step == now for step in range(len(spray))]
    ages = [now - step for step, sprays in enumerate(spray) if sprays]
    typed = "fire only if spray was at least 0.2 s ago"
    assert is_kept(typed, 0, fire, spray) == any(age >= STEPS for age in ages)
    assert is_kept(typed, 1, fire, spray) == (bool(ages) and ages[-1] >= STEPS)
    assert is_kept("fire no sooner than 0.2 s after spray", 0, fire, spray) == all(age >= STEPS for age in ages)


@pytest.mark.parametrize("spray", TRACES)
def test_what_comes_no_sooner_than_a_time_comes_at_no_step_before_it(spray: tuple[bool, ...]) -> None:
    fire = [step == 0 for step in range(len(spray))]
    typed = "when fire, spray no sooner than 0.2 s and no later than 0.4 s"
    comes_in_time = any(spray[STEPS : 2 * STEPS + 1])
    assert is_kept(typed, 0, fire, spray) == (comes_in_time and not any(spray[:STEPS]))
    assert is_kept(typed, 1, fire, spray) == comes_in_time
