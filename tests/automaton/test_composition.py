"""Building by parts and building as a whole give the same automaton."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.reference_formulas import read_formula
from tltlc.automaton.finite import composition
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.logic.formula import Formula, and_, or_

PARTS = st.lists(formulas(atoms=("a", "b", "c"), max_leaves=5), min_size=2, max_size=4)
GROUPS = st.sampled_from([(), (("a", "b"),)])


def shape(fspa: Fspa) -> tuple[object, ...]:
    """Return everything but the labels, which may be written differently."""
    states = tuple((state.accepting, state.verdict, state.distance) for state in fspa.states)
    return states, fspa.edges


@given(PARTS, st.sampled_from([and_, or_]), GROUPS)
@times(60)
def test_the_parts_give_the_same_automaton(
    parts: list[Formula], join: Callable[..., Formula], groups: tuple[tuple[str, ...], ...]
) -> None:
    spec = spec_from_formula(join(*parts), exclusive=groups)
    whole = build(spec)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(composition, "WHOLE_STEPS", 0)
        by_parts = build(spec)
    assert _isomorphic(whole, by_parts)


def _isomorphic(one: Fspa, other: Fspa) -> bool:
    """Whether a renumbering of the states maps one automaton to the other.

    Starting at the initial states, the guards determine the renumbering.
    """
    if len(one.states) != len(other.states) or len(one.edges) != len(other.edges):
        return False
    number, queue = {0: 0}, [0]
    for state in queue:
        targets = {edge.guard.primes: edge.target for edge in other.edges_from(number[state])}
        for edge in one.edges_from(state):
            target = targets.get(edge.guard.primes)
            if target is None or number.setdefault(edge.target, target) != target:
                return False
            if edge.target not in queue:
                queue.append(edge.target)
    return all(
        (a.accepting, a.verdict, a.distance) == (b.accepting, b.verdict, b.distance)
        for a, b in ((one.states[i], other.states[j]) for i, j in number.items())
    )


def test_settled_states_of_the_parts_settle_the_product(monkeypatch: pytest.MonkeyPatch) -> None:
    """A part that is satisfied leaves the product, even if the letters are restricted."""
    monkeypatch.setattr(composition, "WHOLE_STEPS", 0)
    fspa = build(spec_from_formula(read_formula("F a & F b & F c"), exclusive=[("a", "b", "c")]))
    assert {str(state.label) for state in fspa.states} == {
        "F a & F b & F c",
        *("F b & F c", "F a & F c", "F a & F b"),
        *("F a", "F b", "F c", "true"),
    }


def test_labels_of_a_product_come_from_its_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(composition, "WHOLE_STEPS", 0)
    fspa = build(spec_from_formula(read_formula("F(a & X F b) & G p")))
    assert {str(state.label) for state in fspa.states} == {"F(a & X F b) & G p", "F b & G p", "G p", "false"}
