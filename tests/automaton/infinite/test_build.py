"""The automata of specifications over infinite traces agree with the definitions in ``docs/semantics.md``."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.automaton.infinite.runs import accepts, compiled, lassos
from tests.automaton.letters import letters, named
from tests.fuzzing import times
from tests.logic.strategies import formulas
from tests.reference_formulas import read_formula
from tltlc import compile_text
from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET, build, spec_from_formula
from tltlc.automaton.fspa import Fspa, State
from tltlc.automaton.infinite import construct
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.automaton.work import DEFAULT_WORK, STEPS_PER_STATE, OutOfWork
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.logic.formula import Formula
from tltlc.pipeline import CompileOptions, compile_source

SMALL = formulas(atoms=("a", "b"), max_leaves=5)
GROUPS = st.sampled_from([(), (("a", "b"),)])


def labels(fspa: Fspa) -> list[str]:
    return [str(state.label) for state in fspa.states]


def state_rows(fspa: Fspa) -> list[tuple[str, str, int | None, bool]]:
    def row(state: State) -> tuple[str, str, int | None, bool]:
        return str(state.label), state.verdict, state.distance, state.accepting

    return list(map(row, fspa.states))


# --- the work -------------------------------------------------------------------------------------


def test_the_state_budget_limits_the_work() -> None:
    assert STEPS_PER_STATE * DEFAULT_STATE_BUDGET == DEFAULT_WORK
    text = "signal a: bool signal b: bool spec s { semantics infinite require G F a & G F b & F G (a | b) }"
    assert compile_text(text, options=CompileOptions(state_budget=DEFAULT_STATE_BUDGET // 100)) == compile_text(text)
    with pytest.raises(TltlError, match="takes too long to build"):
        compile_text(text, options=CompileOptions(state_budget=1))


def test_a_larger_budget_allows_larger_components(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(construct, "_FOR_AN_ATTEMPT", 400)
    formula = read_formula(" & ".join(f"G(p{number} -> F q{number})" for number in range(3)))
    with pytest.raises(OutOfWork):
        construct.rabin(formula)
    assert len(construct.rabin(formula, work=10 * DEFAULT_WORK).steps) == 13


# --- the language ---------------------------------------------------------------------------------


@times(40)
@given(SMALL, GROUPS)
def test_accepts_the_lassos_on_which_the_formula_holds(formula: Formula, groups: tuple[tuple[str, ...], ...]) -> None:
    fspa = compiled(formula, *groups)
    for prefix, cycle in lassos(fspa, 3):
        expected = holds_on_lasso(formula, named(fspa, prefix), named(fspa, cycle))
        assert accepts(fspa, prefix, cycle) == expected, (prefix, cycle)


@settings(max_examples=60, deadline=None)
@given(SMALL, GROUPS)
def test_a_state_accepts_the_lassos_on_which_its_label_holds(
    formula: Formula, groups: tuple[tuple[str, ...], ...]
) -> None:
    fspa = compiled(formula, *groups)
    for state in fspa.states:
        label = read_formula(str(state.label))
        for prefix, cycle in lassos(fspa, 2):
            expected = holds_on_lasso(label, named(fspa, prefix), named(fspa, cycle))
            assert accepts(fspa, prefix, cycle, state.id) == expected, (state, prefix, cycle)


@settings(max_examples=60, deadline=None)
@given(SMALL)
def test_edges_are_sorted_and_only_pairs_split_them(formula: Formula) -> None:
    fspa = compiled(formula)
    keys = [(edge.source, edge.target, marks) for edge, marks in zip(fspa.edges, fspa.marks(), strict=True)]
    assert keys == sorted(set(keys))
    assert all(set(pair.fin) | set(pair.inf) <= set(range(len(fspa.edges))) for pair in fspa.acceptance)
    for pair in fspa.acceptance:
        assert all(one < other for indices in (pair.fin, pair.inf) for one, other in pairwise(indices))


@settings(max_examples=60, deadline=None)
@given(SMALL)
def test_verdicts_and_goals_agree_with_each_other(formula: Formula) -> None:
    fspa = compiled(formula)
    for state in fspa.states:
        assert (state.verdict == "violated") == (state.distance is None)
        assert state.accepting == (state.distance == 0)
        if state.verdict in ("satisfied", "violated"):
            answers = {accepts(fspa, prefix, cycle, state.id) for prefix, cycle in lassos(fspa, 2)}
            assert answers == {state.verdict == "satisfied"}
    assert fspa.spec_size == max((state.distance or 0 for state in fspa.states), default=0)


# --- the paper's formulas -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "states"),
    [
        ("F(s1 & X F(s2 & X F e)) & G p", 5),
        ("F(s1 & X F(s2 & X F e))", 4),
        ("F(s1 & X F(s2 & X F(s3 & X F((r & er) | (l & el))))) & G p", 6),
        ("F(s1 & X F(s2 & X F(s3 & X F((r -> er) & (l -> el))))) & G p", 6),
    ],
)
def test_the_papers_formulas_have_the_same_automaton_as_over_finite_traces(text: str, states: int) -> None:
    infinite, finite = compiled(text), build(spec_from_formula(read_formula(text)))
    assert len(infinite.states) == states
    assert state_rows(infinite) == state_rows(finite)
    assert infinite.edges == finite.edges
    assert (infinite.judge, infinite.spec_size) == (finite.judge, finite.spec_size)


def test_labels_keep_the_operators_and_the_order_of_the_source() -> None:
    assert labels(compiled("G(a -> F b)")) == ["G(a -> F b)", "G(a -> F b) & F b"]
    source = "(a -> X b) & (c | X G d)"
    assert labels(compiled(source)) == [source, "G d", "true", "b & G d", "b", "false"]
    assert labels(compiled("G((a R b) | c)"))[1] == "G(a R b | c) & a R b"


# --- judge ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "judge"),
    [
        ("F e & G p", "goal"),
        ("F(a & X F b)", "goal"),
        ("a U b", "goal"),
        ("X X a", "goal"),
        # After a, every run that is not violated is accepted.
        ("a & G b", "goal"),
        ("G p", "limit"),
        ("G F a", "limit"),
        ("F G a", "limit"),
        ("G(a -> F b)", "limit"),
        ("G F a -> G F b", "limit"),
        # A run may stay in the goal forever without being accepted.
        ("F a & G F b", "limit"),
    ],
)
def test_a_spec_is_judged_at_the_goal_if_staying_there_suffices(text: str, judge: str) -> None:
    assert compiled(text).judge == judge


def test_a_judge_clause_overrides_the_default() -> None:
    (fspa,) = compile_text("signal a: bool spec s { semantics infinite judge at goal require G F a }")
    assert fspa.judge == "goal"


# --- particular specs -----------------------------------------------------------------------------


def test_acceptance_is_on_transitions() -> None:
    fspa = compiled("G F a")
    assert [(edge.source, edge.target, edge.guard.text) for edge in fspa.edges] == [(0, 0, "!a"), (0, 0, "a")]
    assert [(pair.fin, pair.inf) for pair in fspa.acceptance] == [((), (1,))]
    assert state_rows(fspa) == [("G F a", "holding", 0, True)]


def test_exclusive_goals_cannot_be_reached_in_the_same_step() -> None:
    assert compiled("F a & F b").spec_size == 1
    fspa = compiled("F a & F b", ("a", "b"))
    assert fspa.spec_size == 2
    assert len(letters(fspa)) == 3
    assert compiled("G(a & b)", ("a", "b")).states[0].verdict == "violated"


@pytest.mark.parametrize(
    ("weak", "strong"), [("N a", "X a"), ("G(a -> N b)", "G(a -> X b)"), ("a & N !a", "a & X !a"), ("N N a", "X X a")]
)
def test_weak_next_means_the_same_as_next(weak: str, strong: str) -> None:
    one, other = compiled(weak), compiled(strong)
    assert (one.edges, one.acceptance) == (other.edges, other.acceptance)
    assert [state[1:] for state in state_rows(one)] == [state[1:] for state in state_rows(other)]


@pytest.mark.parametrize("text", ["X true", "true", "F a | G !a", "G(a | !a)"])
def test_a_valid_spec_is_satisfied_from_the_start(text: str) -> None:
    fspa = compiled(text)
    assert [(state.verdict, state.distance) for state in fspa.states] == [("satisfied", 0)]


@pytest.mark.parametrize("text", ["N false", "false", "F a & G !a", "G F a & F G !a"])
def test_an_unsatisfiable_spec_is_violated_from_the_start(text: str) -> None:
    fspa = compiled(text)
    assert [(state.verdict, state.distance) for state in fspa.states] == [("violated", None)]
    assert (fspa.acceptance, fspa.spec_size) == ((), 0)


@pytest.mark.parametrize(
    ("body", "code", "blamed"),
    [
        ("keep a reach b avoid a", "TLT0410", ["keep a", "avoid a"]),
        ("require F G a require G F !a reach b", "TLT0410", ["F G a", "G F !a"]),
        ("keep a and not a", "TLT0410", ["keep a and not a"]),
        ("keep weak_next false", "TLT0410", ["keep weak_next false"]),
        ("keep next true", "TLT0411", ["s"]),
        ("reach a or not a", "TLT0411", ["s"]),
        # Every step of an infinite trace has a next step.
        ("keep a then b", None, []),
    ],
)
def test_a_spec_that_is_decided_from_the_start_gets_a_warning(body: str, code: str | None, blamed: list[str]) -> None:
    text = f"signal a: bool signal b: bool spec s {{ semantics infinite {body} }}"
    diagnostics = compile_source(SourceFile("s.tltl", text)).diagnostics
    assert [diagnostic.code for diagnostic in diagnostics] == ([code] if code else [])
    for diagnostic in diagnostics:
        assert [label.source.slice(label.span) for label in diagnostic.labels] == blamed
        assert "last" not in f"{diagnostic.title} {diagnostic.help}"
