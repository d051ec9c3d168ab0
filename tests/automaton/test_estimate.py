"""A product is rejected before it is built only if it is certain to be too large."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.automaton.test_budgets import any_order, names, refusal
from tests.fuzzing import times
from tests.logic.strategies import formulas
from tltlc.automaton.finite import composition
from tltlc.automaton.finite.build import build, minimal_machine, spec_from_formula
from tltlc.automaton.finite.composition import _Composition
from tltlc.automaton.finite.estimate import Estimate
from tltlc.automaton.finite.machine import Machine
from tltlc.automaton.finite.successors import Successors
from tltlc.automaton.transitions import TransitionDiagrams
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula, always, and_, atom, eventually, next_, not_, or_
from tltlc.logic.normal_form import negation_normal_form

ATOMS = ("a", "b", "c")


def machines(
    parts: list[Formula], exclusive: list[list[int]], atoms: tuple[str, ...]
) -> tuple[TransitionDiagrams, list[Machine]]:
    diagrams = TransitionDiagrams()
    successors = Successors(atoms, diagrams)
    composition = _Composition(successors, 1_000, diagrams.allowed_letters(exclusive))
    return diagrams, [composition.minimal(negation_normal_form(part)) for part in parts]


@given(
    st.lists(formulas(atoms=ATOMS, max_leaves=6), min_size=2, max_size=4),
    st.booleans(),
    st.sampled_from([[], [[0, 1]], [[0, 1, 2]]]),
)
@times(100)
def test_the_estimate_never_rejects_a_product_that_fits(
    parts: list[Formula], conjunction: bool, exclusive: list[list[int]]
) -> None:
    diagrams, machines_ = machines(parts, exclusive, ATOMS)
    whole = and_(*parts) if conjunction else or_(*parts)
    _, product, _ = minimal_machine(whole, ATOMS, 100_000, exclusive)
    for budget in range(len(product.transitions), len(product.transitions) + 3):
        assert not Estimate(diagrams, 1_000_000).exceeds(machines_, conjunction, budget)


def chain(number: int) -> Formula:
    """Return two goals in order, over atoms of their own."""
    return eventually(and_(atom(f"a{number}"), next_(eventually(atom(f"b{number}")))))


@pytest.mark.parametrize("conjunction", [True, False])
@pytest.mark.parametrize("exclusive", [True, False])
@pytest.mark.parametrize(("part", "states"), [(lambda number: eventually(atom(f"a{number}")), 2), (chain, 3)])
def test_parts_that_multiply_are_counted(
    part: Callable[[int], Formula], states: int, conjunction: bool, exclusive: bool
) -> None:
    parts = [part(number) if conjunction else negated(part(number)) for number in range(6)]
    atoms = tuple(name for number in range(6) for name in (f"a{number}", f"b{number}"))
    diagrams, machines_ = machines(parts, [list(range(12))] if exclusive else [], atoms)
    assert Estimate(diagrams, 1_000_000).exceeds(machines_, conjunction, states**6 - 1)
    assert not Estimate(diagrams, 1_000_000).exceeds(machines_, conjunction, states**6)


def negated(formula: Formula) -> Formula:
    return negation_normal_form(not_(formula))


def test_parts_that_contradict_each_other_are_not_counted() -> None:
    parts = [*(eventually(atom(name)) for name in names(6)), always(not_(atom("a0")))]
    diagrams, machines_ = machines(parts, [], tuple(names(6)))
    assert not Estimate(diagrams, 1_000_000).exceeds(machines_, True, 1)


def test_the_estimate_stops_at_its_step_limit() -> None:
    diagrams, machines_ = machines([eventually(atom(name)) for name in names(10)], [], tuple(names(10)))
    assert Estimate(diagrams, 1_000_000).exceeds(machines_, True, 500)
    assert not Estimate(diagrams, 1_000).exceeds(machines_, True, 500)


@pytest.mark.parametrize("goals", [16, 30, 60])
def test_many_goals_in_any_order_are_rejected_before_a_product_is_built(
    goals: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the estimate, thirty goals take eleven seconds and 670 MB, for 16,384 states of the first half."""
    sizes: list[int] = []
    machine = _Composition._machine

    def counted(composition: _Composition, obligation: int) -> Machine:
        result = machine(composition, obligation)
        sizes.append(len(result.transitions))
        return result

    monkeypatch.setattr(_Composition, "_machine", counted)
    spec = spec_from_formula(any_order(goals), exclusive=[names(goals)])
    assert refusal(spec, 50_000).title == "the automaton of `spec` needs more than 50000 states"
    assert sizes == [2] * goals


def test_goals_within_the_budget_compile(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(composition, "WHOLE_STEPS", 0)
    spec = spec_from_formula(any_order(7), exclusive=[names(7)])
    assert len(build(spec, state_budget=128).states) == 128
    assert refusal(spec, 127).code == "TLT0501"
    monkeypatch.setitem(WORK, "estimate of states", 0)
    assert len(build(spec, state_budget=128).states) == 128
