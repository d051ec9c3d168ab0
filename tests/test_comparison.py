"""Inclusion and equivalence of automata, against the definitions of what formulas mean."""

from __future__ import annotations

import inspect
import sys
from itertools import product

import pytest
from hypothesis import given, settings

from tests.automaton.infinite.runs import compiled
from tests.logic.strategies import formulas
from tests.reference_formulas import read_formula
from tltlc import compile_text
from tltlc.automaton.compare import Trace, are_equivalent, is_included, less_is_left, separating
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.automaton.infinite.work import OutOfWork
from tltlc.logic.formula import Formula
from tltlc.logic.oracle import all_traces, holds

SMALL = formulas(atoms=("a", "b"), max_leaves=4)
SAMPLES = [frozenset(names) for names in ((), ("a",), ("b",), ("a", "b"))]


def finite(formula: Formula | str, *exclusive: tuple[str, ...]) -> Fspa:
    if isinstance(formula, str):
        formula = read_formula(formula)
    return build(spec_from_formula(formula, exclusive=exclusive))


@settings(max_examples=150, deadline=None)
@given(SMALL, SMALL)
def test_over_finite_traces_a_shortest_one_tells_them_apart(one: Formula, other: Formula) -> None:
    found = separating(finite(one), finite(other))
    apart = [each for each in all_traces(("a", "b"), 3) if holds(one, each) and not holds(other, each)]
    if found is None:
        assert not apart
        return
    assert found.cycle == ()
    assert holds(one, found.prefix) and not holds(other, found.prefix)
    assert len(found.prefix) <= min((len(each) for each in apart), default=len(found.prefix))
    assert apart or len(found.prefix) > 3


@settings(max_examples=100, deadline=None)
@given(SMALL, SMALL)
def test_what_is_impossible_is_on_no_trace(one: Formula, other: Formula) -> None:
    a, b = finite(one), finite(other)
    known = {atom.name for atom in (*a.atoms, *b.atoms)}
    literals = tuple(each for each in (("b", True), ("a", False)) if each[0] in known)
    if not literals:
        return
    found = separating(a, b, impossible=[literals])

    def is_possible(letter: frozenset[str]) -> bool:
        return not all((name in letter) == wanted for name, wanted in literals)

    apart = [
        each
        for each in all_traces(("a", "b"), 3)
        if all(map(is_possible, each)) and holds(one, each) and not holds(other, each)
    ]
    if found is None:
        assert not apart
        return
    assert all(map(is_possible, found.prefix))
    assert holds(one, found.prefix) and not holds(other, found.prefix)
    assert len(found.prefix) <= min((len(each) for each in apart), default=len(found.prefix))


def test_after_a_goal_less_is_left() -> None:
    fspa = finite("F a & F b")
    is_left = less_is_left(fspa)
    after = {edge.target for edge in fspa.edges if edge.source == 0} - {0}
    assert len(after) == 3
    assert all(is_left(0, state) and not is_left(state, 0) for state in after)
    assert is_left(0, 0)
    with pytest.raises(OutOfWork):
        less_is_left(fspa, work=1)(0, 1)


@settings(max_examples=150, deadline=None)
@given(SMALL, SMALL)
def test_over_infinite_traces_a_lasso_tells_them_apart(one: Formula, other: Formula) -> None:
    found = separating(compiled(one), compiled(other))
    if found is not None:
        assert holds_on_lasso(one, found.prefix, found.cycle) and not holds_on_lasso(other, found.prefix, found.cycle)
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
def test_relations(make, one: str, other: str, relation: str) -> None:  # type: ignore[no-untyped-def]
    first, second = make(one), make(other)
    ways = is_included(first, second), is_included(second, first)
    assert ways == {"equal": (True, True), "stricter": (True, False), "neither": (False, False)}[relation]
    assert are_equivalent(first, second) == (relation == "equal")


def test_what_only_infinite_traces_tell() -> None:
    assert separating(compiled("F G a"), compiled("G F a")) is None
    found = separating(compiled("G F a & G F b"), compiled("F G (a | b)"))
    assert found is not None
    assert {"a", "b"} <= set().union(*found.cycle) and frozenset() in found.cycle
    assert separating(finite("F G a"), finite("G F a")) is None and are_equivalent(finite("F G a"), finite("G F a"))


def test_atoms_of_both_count_by_their_names() -> None:
    assert separating(finite("F b"), finite("F b & F a")) == Trace((frozenset({"b"}),))
    assert is_included(finite("G b & G a"), finite("G a"))


def test_traces_on_which_exclusive_atoms_hold_together_are_none() -> None:
    both = ("a", "b")
    assert separating(finite("F(a & b)", both), finite("false")) is None
    assert separating(finite("F(a & b)"), finite("F c", ("a", "b"))) is None
    assert separating(compiled("G F (a & b)"), compiled("F c", both)) is None
    assert separating(finite("F(a & b)"), finite("F c")) is not None


def test_automata_of_both_kinds_are_not_compared() -> None:
    with pytest.raises(ValueError, match="`spec` is over finite traces, and `spec` over infinite ones"):
        separating(finite("F a"), compiled("F a"))


def test_work_is_bounded() -> None:
    with pytest.raises(OutOfWork):
        separating(compiled("G F a & G F b"), compiled("F G (a | b)"), work=10)


@pytest.mark.parametrize("compare", [is_included, are_equivalent])
def test_the_work_of_answers_is_bounded(compare) -> None:  # type: ignore[no-untyped-def]
    one, other = compiled("G F a & G F b"), compiled("G F b & G F a")
    assert compare(one, other)
    with pytest.raises(OutOfWork):
        compare(one, other, work=10)


def test_many_atoms_need_no_deep_stack_of_the_caller() -> None:
    fspa = finite(" & ".join(f"a{number}" for number in range(300)))
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(len(inspect.stack(0)) + 200)
    try:
        assert are_equivalent(fspa, fspa)
    finally:
        sys.setrecursionlimit(before)


def test_artefacts_of_sources() -> None:
    text = "signal a: bool signal b: bool spec one { reach a then b } spec two { reach a reach b }"
    one, two = compile_text(text)
    assert is_included(one, two)
    assert separating(two, one) == Trace((frozenset({"a", "b"}),))


def test_the_edges_of_a_state_are_put_together_in_pairs() -> None:
    def goals(count: int) -> Fspa:
        signals = "".join(f"signal a{number}: bool\n" for number in range(8))
        return compile_text(f"{signals}spec s = {' & '.join(f'F a{number}' for number in range(count))}\n")[0]

    one, other = goals(7), goals(8)
    # One after the other, each edge takes a step for all that was put together before, which takes 400,000 steps.
    assert separating(other, one, work=250_000) is None
    assert separating(one, other, work=250_000) is not None
