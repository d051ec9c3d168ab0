"""Budgets of edges, guards, parts and labels: what compiles within them, and the errors beyond them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, combinations, product
from typing import Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.logic.strategies import state_formulas
from tests.reference_formulas import read_formula
from tltlc.automaton.finite import build as build_module
from tltlc.automaton.finite import composition
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.finite.successors import Successors
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.build import build_infinite
from tltlc.automaton.transitions import TransitionDiagrams
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula, and_, atom, eventually, iff, next_, or_
from tltlc.logic.normal_form import negation_normal_form
from tltlc.logic.oracle import holds
from tltlc.monitor.guards import holds as guard_holds
from tltlc.resolve.spec import Spec


def any_order(goals: int) -> Formula:
    """Return the conjunction of goals that may be met in any order, or at once."""
    return and_(*(eventually(atom(f"a{number}")) for number in range(goals)))


def names(goals: int) -> list[str]:
    return [f"a{number}" for number in range(goals)]


@pytest.mark.parametrize(
    ("goals", "exclusive"),
    [(2, False), (3, False), pytest.param(4, False, marks=pytest.mark.slow), (2, True), (3, True), (4, True)],
)
def test_goals_in_any_order_are_met_as_the_oracle_says(goals: int, exclusive: bool) -> None:
    formula = any_order(goals)
    fspa = build(spec_from_formula(formula, exclusive=[names(goals)] if exclusive else []))
    possible = [*map(frozenset, powerset(names(goals)))]
    possible = [letter for letter in possible if len(letter) <= 1] if exclusive else possible
    for trace in product(possible, repeat=goals):
        assert fspa.states[run(fspa, trace)].accepting == holds(formula, trace)


@pytest.mark.parametrize("goals", [2, 5, 8, 10])
def test_exclusive_goals_in_any_order_have_few_edges(goals: int) -> None:
    fspa = build(spec_from_formula(any_order(goals), exclusive=[names(goals)]))
    assert len(fspa.states) == 2**goals
    assert len(fspa.edges) == goals * 2 ** (goals - 1) + 2**goals


def test_goals_in_any_order_have_an_edge_to_each_set_of_remaining_goals() -> None:
    assert len(build(spec_from_formula(any_order(7))).edges) == 3**7


def test_too_many_edges_are_an_error_before_guards_and_labels_are_made(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(build_module, "Guards", None)
    monkeypatch.setattr(build_module, "Labels", None)
    with pytest.raises(TltlError) as raised:
        build(spec_from_formula(any_order(13)))
    (diagnostic,) = raised.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == ("TLT0502", "the automaton of `spec` has more than 1000000 edges")
    assert (
        diagnostic.help
        == "declare atoms that never hold together `exclusive`, give the goals an order, or split the spec"
    )


@pytest.mark.parametrize("semantics", ["finite", "infinite"])
def test_the_limit_of_edges_is_exact(semantics: Literal["finite", "infinite"], monkeypatch: pytest.MonkeyPatch) -> None:
    spec = replace(spec_from_formula(any_order(3), exclusive=[names(3)]), semantics=semantics)
    monkeypatch.setitem(WORK, "edges", 20)
    assert len(built(spec).edges) == 20
    monkeypatch.setitem(WORK, "edges", 19)
    with pytest.raises(TltlError) as raised:
        built(spec)
    (diagnostic,) = raised.value.diagnostics
    assert (diagnostic.title, diagnostic.help) == (
        "the automaton of `spec` has more than 19 edges",
        "give the goals an order, or split the spec",
    )


def built(spec: Spec, budget: int = 1_000) -> Fspa:
    make = build_infinite if spec.semantics == "infinite" else build
    return make(spec, state_budget=budget)


def test_partial_products_of_guards_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(WORK, "partial products", 100)
    assert build(spec_from_formula(read_formula("F (a & b | c)")))
    equal = and_(*(iff(atom(f"a{number}"), atom(f"b{number}")) for number in range(6)))
    with pytest.raises(TltlError) as raised:
        build(spec_from_formula(equal))
    (diagnostic,) = raised.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == (
        "TLT0502",
        "all guards of `spec` have more than 100 partial products",
    )


def run(fspa: Fspa, trace: Iterable[frozenset[str]]) -> int:
    """Return the state after a trace."""
    state = 0
    for letter in trace:
        values = [1.0 if atom.name in letter else -1.0 for atom in fspa.atoms]
        (edge,) = (edge for edge in fspa.edges_from(state) if guard_holds(edge.guard, values))
        state = edge.target
    return state


def powerset(names: Sequence[str]) -> Iterator[tuple[str, ...]]:
    return chain.from_iterable(combinations(names, size) for size in range(len(names) + 1))


@pytest.mark.parametrize("semantics", ["finite", "infinite"])
def test_the_help_on_too_many_exclusive_atoms_counts_their_pairs(semantics: Literal["finite", "infinite"]) -> None:
    """A group of 142 atoms has 10,011 pairs, each of which counts as a prime implicant; two groups have about half."""
    goal = eventually(or_(*map(atom, names(142))))
    diagnostic = refusal(replace(spec_from_formula(goal, exclusive=[names(142)]), semantics=semantics))
    assert (diagnostic.code, diagnostic.help) == (
        "TLT0502",
        "declare fewer atoms `exclusive`, or use several smaller groups: now there are 10011 exclusive pairs",
    )
    halves = [names(142)[:71], names(142)[71:]]
    assert built(replace(spec_from_formula(goal, exclusive=halves), semantics=semantics))


def test_the_help_does_not_blame_exclusive_atoms_for_other_large_guards() -> None:
    parity = atom("a0")
    for name in names(16)[1:]:
        parity = iff(atom(name), parity)
    diagnostic = refusal(spec_from_formula(eventually(parity), exclusive=[names(2)]))
    assert (diagnostic.code, diagnostic.help) == ("TLT0502", "split the spec, or declare the condition as a predicate")


def test_the_states_of_all_parts_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """A disjunction of n parts takes n - 1 products, each of which is within the budget alone."""
    parts = [and_(*(eventually(atom(name)) for name in chosen)) for chosen in combinations(names(5), 3)]
    spec = spec_from_formula(or_(*parts))
    monkeypatch.setattr(composition, "WHOLE_STEPS", 0)
    monkeypatch.setitem(WORK, "states of parts", 500)
    assert build(spec, state_budget=32)
    monkeypatch.setitem(WORK, "states of parts", 100)
    assert refusal(spec, 32).title == "the automaton of `spec` needs more than 32 states"


def test_long_labels_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    formula = atom("a4")
    for number in (3, 2, 1, 0):
        formula = or_(atom(f"a{number}"), next_(formula))
    spec = spec_from_formula(and_(eventually(atom("b")), or_(formula, eventually(formula))))
    assert build(spec)
    monkeypatch.setitem(WORK, "label nodes", 20)
    diagnostic = refusal(spec)
    assert (diagnostic.code, diagnostic.title) == (
        "TLT0501",
        "the automaton of `spec` needs labels with more than 20 operators and atoms",
    )


@given(state_formulas(("a", "b", "c"), max_leaves=5), state_formulas(("a", "b", "c"), max_leaves=5), st.booleans())
@times(80)
def test_joining_constrained_transitions_keeps_the_constraint(one: Formula, other: Formula, conjunction: bool) -> None:
    diagrams = TransitionDiagrams()
    successors = Successors(["a", "b", "c"], diagrams)
    allowed = diagrams.allowed_letters([[0, 1, 2]])
    left, right = (successors.of_formula(negation_normal_form(formula)) for formula in (one, other))
    join = diagrams.conjoin if conjunction else diagrams.disjoin
    joined = join(diagrams.constrain(left, allowed), diagrams.constrain(right, allowed))
    assert diagrams.constrain(joined, allowed) == diagrams.constrain(join(left, right), allowed)


def test_a_product_over_exclusive_atoms_makes_few_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    """An earlier version built the transitions for all letters, and restricted them to the possible ones afterwards."""
    created: list[TransitionDiagrams] = []
    monkeypatch.setattr(build_module, "TransitionDiagrams", lambda: created.append(TransitionDiagrams()) or created[-1])
    monkeypatch.setattr(build_module, "_labels", None)
    with pytest.raises(TypeError):
        build(spec_from_formula(any_order(10), exclusive=[names(10)]))
    (diagrams,) = created
    assert len(diagrams.variable) < 35 * 2**10


def refusal(spec: Spec, budget: int = 1_000) -> Diagnostic:
    with pytest.raises(TltlError) as raised:
        built(spec, budget)
    (diagnostic,) = raised.value.diagnostics
    return diagnostic
