"""Inclusion and equivalence of automata agree with the semantics of formulas."""

from __future__ import annotations

import inspect
import sys
from itertools import product

import pytest
from hypothesis import given

from tests.automaton.infinite.runs import compiled
from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.reference_formulas import read_formula
from tltlc import compile_text
from tltlc.automaton.compare import Trace, are_equivalent, is_included, separating, state_inclusion
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.automaton.work import OutOfWork
from tltlc.logic.formula import Formula
from tltlc.logic.oracle import all_traces, holds

SMALL = formulas(atoms=("a", "b"), max_leaves=4)
SAMPLES = [frozenset(names) for names in ((), ("a",), ("b",), ("a", "b"))]


def finite(formula: Formula | str, *exclusive: tuple[str, ...]) -> Fspa:
    if isinstance(formula, str):
        formula = read_formula(formula)
    return build(spec_from_formula(formula, exclusive=exclusive))


@times(60)
@given(SMALL, SMALL)
def test_over_finite_traces_a_shortest_counterexample_is_found(one: Formula, other: Formula) -> None:
    counterexample = separating(finite(one), finite(other))
    expected = [trace for trace in all_traces(("a", "b"), 3) if holds(one, trace) and not holds(other, trace)]
    if counterexample is None:
        assert not expected
        return
    assert counterexample.cycle == ()
    assert holds(one, counterexample.prefix) and not holds(other, counterexample.prefix)
    assert len(counterexample.prefix) <= min((len(trace) for trace in expected), default=len(counterexample.prefix))
    assert expected or len(counterexample.prefix) > 3


@times(40)
@given(SMALL, SMALL)
def test_a_counterexample_has_no_impossible_samples(one: Formula, other: Formula) -> None:
    a, b = finite(one), finite(other)
    known = {atom.name for atom in (*a.atoms, *b.atoms)}
    literals = tuple(literal for literal in (("b", True), ("a", False)) if literal[0] in known)
    if not literals:
        return
    counterexample = separating(a, b, impossible=[literals])

    def is_possible(letter: frozenset[str]) -> bool:
        return not all((name in letter) == wanted for name, wanted in literals)

    expected = [
        trace
        for trace in all_traces(("a", "b"), 3)
        if all(map(is_possible, trace)) and holds(one, trace) and not holds(other, trace)
    ]
    if counterexample is None:
        assert not expected
        return
    assert all(map(is_possible, counterexample.prefix))
    assert holds(one, counterexample.prefix) and not holds(other, counterexample.prefix)
    assert len(counterexample.prefix) <= min((len(trace) for trace in expected), default=len(counterexample.prefix))


def test_reaching_a_goal_leaves_strictly_less_to_do() -> None:
    fspa = finite("F a & F b")
    is_left = state_inclusion(fspa)
    after = {edge.target for edge in fspa.edges if edge.source == 0} - {0}
    assert len(after) == 3
    assert all(is_left(0, state) and not is_left(state, 0) for state in after)
    assert is_left(0, 0)
    with pytest.raises(OutOfWork):
        state_inclusion(fspa, work=1)(0, 1)


@times(60)
@given(SMALL, SMALL)
def test_over_infinite_traces_a_lasso_is_found(one: Formula, other: Formula) -> None:
    lasso = separating(compiled(one), compiled(other))
    if lasso is not None:
        assert holds_on_lasso(one, lasso.prefix, lasso.cycle) and not holds_on_lasso(other, lasso.prefix, lasso.cycle)
        return
    for before, after in ((0, 1), (0, 2), (1, 1), (1, 2), (2, 1)):
        for samples in product(SAMPLES, repeat=before + after):
            prefix, cycle = samples[:before], samples[before:]
            assert not holds_on_lasso(one, prefix, cycle) or holds_on_lasso(other, prefix, cycle)


@pytest.mark.parametrize("make", [finite, compiled])
@pytest.mark.parametrize(
    ("one", "other", "relation"),
    [
        ("F(a & X F b)", "F a & F b", "stricter"),
        ("G(a & b)", "G b & G a", "equal"),
        ("a U b", "a W b", "stricter"),
        ("F a", "F b", "neither"),
        ("a R b", "b W (a & b)", "equal"),
    ],
)
def test_inclusion_and_equivalence(make, one: str, other: str, relation: str) -> None:  # type: ignore[no-untyped-def]
    first, second = make(one), make(other)
    included = is_included(first, second), is_included(second, first)
    assert included == {"equal": (True, True), "stricter": (True, False), "neither": (False, False)}[relation]
    assert are_equivalent(first, second) == (relation == "equal")


def test_differences_only_over_infinite_traces() -> None:
    assert separating(compiled("F G a"), compiled("G F a")) is None
    lasso = separating(compiled("G F a & G F b"), compiled("F G (a | b)"))
    assert lasso is not None
    assert {"a", "b"} <= set().union(*lasso.cycle) and frozenset() in lasso.cycle
    assert separating(finite("F G a"), finite("G F a")) is None and are_equivalent(finite("F G a"), finite("G F a"))


def test_atoms_are_matched_by_name() -> None:
    assert separating(finite("F b"), finite("F b & F a")) == Trace((frozenset({"b"}),))
    assert is_included(finite("G b & G a"), finite("G a"))


def test_counterexamples_respect_exclusive_atoms() -> None:
    both = ("a", "b")
    assert separating(finite("F(a & b)", both), finite("false")) is None
    assert separating(finite("F(a & b)"), finite("F c", ("a", "b"))) is None
    assert separating(compiled("G F (a & b)"), compiled("F c", both)) is None
    assert separating(finite("F(a & b)"), finite("F c")) is not None


def test_finite_and_infinite_automata_cannot_be_compared() -> None:
    with pytest.raises(ValueError, match="`spec` is over finite traces, and `spec` over infinite ones"):
        separating(finite("F a"), compiled("F a"))


def test_work_is_bounded() -> None:
    with pytest.raises(OutOfWork):
        separating(compiled("G F a & G F b"), compiled("F G (a | b)"), work=10)


@pytest.mark.parametrize("compare", [is_included, are_equivalent])
def test_the_work_of_inclusion_and_equivalence_is_bounded(compare) -> None:  # type: ignore[no-untyped-def]
    one, other = compiled("G F a & G F b"), compiled("G F b & G F a")
    assert compare(one, other)
    with pytest.raises(OutOfWork):
        compare(one, other, work=10)


def test_many_atoms_need_no_deep_stack() -> None:
    fspa = finite(" & ".join(f"a{number}" for number in range(300)))
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(len(inspect.stack(0)) + 200)
    try:
        assert are_equivalent(fspa, fspa)
    finally:
        sys.setrecursionlimit(before)


def test_compiled_specs_can_be_compared() -> None:
    text = "signal a: bool signal b: bool spec one { reach a then b } spec two { reach a reach b }"
    one, two = compile_text(text)
    assert is_included(one, two)
    assert separating(two, one) == Trace((frozenset({"a", "b"}),))


def test_the_edges_of_a_state_are_combined_in_pairs() -> None:
    def goals(count: int) -> Fspa:
        signals = "".join(f"signal a{number}: bool\n" for number in range(8))
        return compile_text(f"{signals}spec s = {' & '.join(f'F a{number}' for number in range(count))}\n")[0]

    one, other = goals(7), goals(8)
    # If edges were combined one after the other, each one would visit the whole result so far: 400,000 steps in all.
    assert separating(other, one, work=250_000) is None
    assert separating(one, other, work=250_000) is not None
