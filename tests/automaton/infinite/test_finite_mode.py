"""Infinite and finite mode agree on co-safety and safety formulas, which a finite prefix decides."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import given, reject
from hypothesis import strategies as st

from tests.automaton.infinite.lassos import ABC, Lasso, accepts, lassos
from tests.automaton.letters import step
from tests.fuzzing import times
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.construct import rabin
from tltlc.automaton.infinite.lasso import holds_on_lasso
from tltlc.automaton.work import OutOfWork
from tltlc.logic import formula as f
from tltlc.logic import oracle
from tltlc.logic.formula import Formula

LITERALS = st.sampled_from([literal for name in ABC for literal in (f.atom(name), f.not_(f.atom(name)))])


def _over(unary: Sequence[object], binary: Sequence[object]) -> st.SearchStrategy[Formula]:
    def grown(inner: st.SearchStrategy[Formula]) -> st.SearchStrategy[Formula]:
        operands = st.lists(inner, min_size=2, max_size=3)
        one = st.builds(lambda make, operand: make(operand), st.sampled_from(unary), inner)
        two = st.builds(lambda make, left, right: make(left, right), st.sampled_from(binary), inner, inner)
        return one | two | operands.map(lambda all_: f.and_(*all_)) | operands.map(lambda all_: f.or_(*all_))

    return st.recursive(LITERALS, grown, max_leaves=6)


CO_SAFETY = _over([f.next_, f.eventually], [f.until, f.strong_release])
SAFETY = _over([f.weak_next, f.always], [f.weak_until, f.release])
WORDS = st.lists(lassos(), min_size=6, max_size=6)


@given(CO_SAFETY, WORDS)
@times(60)
def test_a_co_safety_formula_holds_where_a_prefix_satisfies_it(formula: Formula, words: list[Lasso]) -> None:
    _agree(formula, words, "satisfied", if_met=True)


@given(SAFETY, WORDS)
@times(60)
def test_a_safety_formula_holds_where_no_prefix_violates_it(formula: Formula, words: list[Lasso]) -> None:
    _agree(formula, words, "violated", if_met=False)


def _agree(formula: Formula, words: list[Lasso], verdict: str, *, if_met: bool) -> None:
    finite = build(spec_from_formula(formula))
    try:
        infinite = rabin(formula, ABC, work=300_000)
    except OutOfWork:
        reject()
    for word in words:
        expected = _meets(finite, word, verdict) == if_met
        assert holds_on_lasso(formula, *word) == expected
        assert accepts(infinite, ABC, word) == expected


def _meets(fspa: Fspa, word: Lasso, verdict: str) -> bool:
    """Whether a prefix of the trace reaches a state with that verdict.

    Repeating the cycle once more than there are states is enough.
    """
    prefix, cycle = word
    state = 0
    for sample in (*prefix, *cycle * (len(fspa.states) + 1)):
        state = step(fspa, state, tuple(atom.name in sample for atom in fspa.atoms))
        if fspa.states[state].verdict == verdict:
            return True
    return False


@given(CO_SAFETY, lassos())
@times(80)
def test_a_co_safety_formula_holds_on_a_lasso_if_it_holds_on_a_long_prefix(formula: Formula, word: Lasso) -> None:
    prefix, cycle = word
    rounds = 1 + sum(1 for node in formula.walk() if node.is_temporal)
    trace = [*prefix, *cycle * rounds, *cycle]
    assert holds_on_lasso(formula, prefix, cycle) == oracle.holds(formula, trace)
