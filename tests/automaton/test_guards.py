"""Guard robustness is the signed L-infinity distance to the border of the guard, however the guard is written."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.logic.strategies import state_formulas
from tltlc.automaton import guards
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Guard
from tltlc.automaton.transitions import ACCEPT, REJECT, TransitionDiagrams
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.logic import oracle
from tltlc.logic.formula import Formula, and_, atom, iff, not_, or_

ATOMS = ("a", "b", "c")
VALUES = st.tuples(*[st.floats(-1, 1).filter(lambda x: x != 0)] * len(ATOMS))


def guard_of(formula: Formula) -> Guard | None:
    """Return the guard under which a trace of one sample satisfies the formula, or None if none does."""
    # Mention all atoms, in order, so that their indices match ATOMS.
    mentioned = [or_(atom(name), not_(atom(name))) for name in ATOMS]
    fspa = build(spec_from_formula(and_(*mentioned, formula)))
    assert [a.name for a in fspa.atoms] == list(ATOMS)
    goal = [state.id for state in fspa.states if state.accepting]
    goal_guards = [edge.guard for edge in fspa.edges_from(0) if edge.target in goal]
    return goal_guards[0] if goal_guards else None


def robustness(guard: Guard | None, values: Sequence[float]) -> float:
    """The max over primes of the min over literals; true is 1 and false -1 (``docs/semantics.md``)."""
    if guard is None:
        return -1.0
    return max(
        min((values[index] if polarity else -values[index] for index, polarity in prime), default=1.0)
        for prime in guard.primes
    )


def signed_distance(formula: Formula, values: Sequence[float]) -> float:
    """The distance to the nearest letter with the other truth value, by brute force over letters."""
    here = tuple(value > 0 for value in values)
    true = {
        letter
        for letter in product((False, True), repeat=len(ATOMS))
        if oracle.holds(formula, [{name for name, value in zip(ATOMS, letter, strict=True) if value}])
    }
    other_letters = [
        letter for letter in product((False, True), repeat=len(ATOMS)) if (letter in true) != (here in true)
    ]
    distance = min(
        (max(abs(v) for v, a, b in zip(values, here, letter, strict=True) if a != b) for letter in other_letters),
        default=1.0,
    )
    return distance if here in true else -distance


@given(state_formulas(ATOMS, max_leaves=8), VALUES)
@times(133)
def test_robustness_is_the_signed_distance_to_the_border(formula: Formula, values: tuple[float, ...]) -> None:
    assert robustness(guard_of(formula), values) == signed_distance(formula, values)


@given(state_formulas(ATOMS, max_leaves=6))
@times(40)
def test_robustness_does_not_depend_on_how_the_guard_is_written(formula: Formula) -> None:
    """Shannon's expansion can change min and max, but keeps the prime implicants."""
    split = or_(and_(atom("a"), formula), and_(not_(atom("a")), formula))
    one, other = guard_of(formula), guard_of(split)
    assert (one is None) == (other is None)
    if one is not None and other is not None:
        assert one == other


def test_a_guard_with_too_many_primes_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guards, "PRIME_LIMIT", 3)
    parity = iff(atom("a"), iff(atom("b"), atom("c")))
    with pytest.raises(TltlError) as raised:
        build(spec_from_formula(parity))
    assert raised.value.diagnostics[0].code == "TLT0502"


def test_guards_with_too_many_primes_together_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guards, "TOTAL_PRIME_LIMIT", 3)
    with pytest.raises(TltlError) as raised:
        build(spec_from_formula(iff(atom("a"), atom("b"))))
    assert raised.value.diagnostics[0].title == "all guards of `spec` have more than 3 prime implicants"


def test_a_guard_with_too_many_products_is_an_error() -> None:
    """The parity of 25 atoms is a diagram of 49 nodes and a sum of 2^24 products."""
    parity = atom("a0")
    for number in range(1, 25):
        parity = iff(parity, atom(f"a{number}"))
    with pytest.raises(TltlError) as raised:
        build(spec_from_formula(parity))
    assert raised.value.diagnostics[0].code == "TLT0502"


def test_a_short_form_stays_a_sum_where_the_product_would_be_very_long(monkeypatch: pytest.MonkeyPatch) -> None:
    diagrams = TransitionDiagrams()
    guard = REJECT
    for pair in range(3):
        both = diagrams.node(2 * pair, REJECT, diagrams.node(2 * pair + 1, REJECT, ACCEPT))
        guard = diagrams.disjoin(guard, both)
    monkeypatch.setattr(guards, "PRIME_LIMIT", 7)
    formula = guards.Guards(diagrams, "abcdef").formula(guard)
    assert str(formula) == "a & b | c & d | e & f"
