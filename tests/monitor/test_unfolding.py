"""Registers unfolded into states: the automaton accepts the same traces."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random
from unittest.mock import patch

import pytest

from tests.memory.runs import random_case
from tests.resolve.test_deadlines import RULES, SIGNALS
from tests.unfolded import unfolded as with_states
from tltlc import compile_text
from tltlc.automaton.compare import are_equivalent
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import given_atoms
from tltlc.automaton.work import DEFAULT_WORK, OutOfWork, Work
from tltlc.monitor import Monitor, MonitorError
from tltlc.monitor.guards import holds
from tltlc.monitor.unfolding import unfolded
from tltlc.resolve import specs


@pytest.mark.parametrize("form", RULES)
@pytest.mark.parametrize(("n", "m"), [(1, 1), (4, 2), (7, 7)])
def test_timers_unfold_to_the_states_of_the_bounds(form: str, n: int, m: int) -> None:
    text = f"{SIGNALS}spec s {{ {RULES[form].format(n=n, m=m)} }}"
    with patch.object(specs, "MOST_UNFOLDED", 0):
        (timers,) = compile_text(text)
    with with_states():
        (states,) = compile_text(text)
    result = unfolded(timers, Work(DEFAULT_WORK))
    assert result is not None
    assert not result.registers
    assert {atom.name for atom in result.atoms} <= {"a", "b", "c"}
    assert are_equivalent(result, states)


def test_random_specs_about_the_past_accept_the_same_traces() -> None:
    results = [check_random_spec(seed) for seed in range(120)]
    assert results.count("unfolded") > 20
    assert results.count("remembers numbers") > 20


def check_random_spec(seed: int) -> str:
    case = random_case(seed)
    if case is None or not case.fspa.registers or case.fspa.semantics == "infinite":
        return "other"
    try:
        result = unfolded(case.fspa, Work(400_000))
    except OutOfWork:
        return "too large"
    if result is None:
        return "remembers numbers"
    random = Random(seed)
    for _ in range(5):
        letters = [[random.choice((-1.0, 1.0)) for _ in result.atoms] for _ in range(random.randint(1, 15))]
        assert list(accepts(result, letters)) == list(monitored(case.fspa, letters)), case.requirement
    return "unfolded"


def monitored(fspa: Fspa, letters: list[list[float]]) -> Iterator[tuple[bool, str]]:
    """Yield what a monitor says of each prefix, until it rejects a sample."""
    monitor = Monitor(fspa)
    for letter in letters:
        try:
            step = monitor.step_atoms(letter)
        except MonitorError:
            return
        yield step.accepting, step.verdict


def accepts(fspa: Fspa, letters: list[list[float]]) -> Iterator[tuple[bool, str]]:
    state = 0
    for letter in letters:
        if any(sum(letter[atom] > 0.0 for atom in group) > 1 for group in fspa.exclusive):
            return
        (edge,) = [edge for edge in fspa.edges_from(state) if holds(edge.guard, letter)]
        state = edge.target
        yield fspa.states[state].accepting, fspa.states[state].verdict


def test_the_atoms_are_those_that_do_not_follow_from_others() -> None:
    (fspa,) = compile_text("signal a: bool  signal b: bool  spec s { keep times(a) <= 2  keep b implies once a }")
    result = unfolded(fspa, Work(DEFAULT_WORK))
    assert result is not None
    assert [atom.name for atom in result.atoms] == [fspa.atoms[index].name for index in given_atoms(fspa)] == ["b", "a"]
    # a has never held; it holds for the first or second time, or no longer; and the trap, which remembers nothing.
    assert len(result.states) == 6


@pytest.mark.parametrize(
    "clause",
    ["keep x >= previous(x)", "keep highest(x) > 2", "keep high", "keep times(high) <= 1"],
)
def test_numbers_are_not_unfolded(clause: str) -> None:
    names = "signal x in [0, 9]\nsignal a: bool\n"
    names += "predicate high in [-1, 1] = clamp(x - times(a, 5), -1, 1)\n"
    (fspa,) = compile_text(f"{names}spec s {{ {clause} }}")
    assert unfolded(fspa, Work(DEFAULT_WORK)) is None


def test_without_registers_it_is_the_automaton_itself() -> None:
    (fspa,) = compile_text("signal a: bool  spec s { keep a }")
    assert unfolded(fspa, Work(0)) is fspa


def test_the_work_is_limited() -> None:
    (fspa,) = compile_text("signal a: bool  spec s { keep times(a) <= 1000 }")
    with pytest.raises(OutOfWork):
        unfolded(fspa, Work(10_000))
