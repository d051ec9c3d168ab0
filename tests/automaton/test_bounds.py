"""Bounds count down: of several copies of a bound only the tightest stays, so a bound of n takes about n states."""

from __future__ import annotations

import inspect
import pickle
import sys

import pytest

import tltlc
from tests.unfolded import unfolded
from tltlc.automaton.diagrams import Diagrams
from tltlc.automaton.finite.readback import ObligationWriter
from tltlc.automaton.finite.successors import Successors
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.after_automaton import ObligationAutomaton
from tltlc.automaton.transitions import TransitionDiagrams
from tltlc.automaton.work import Work
from tltlc.logic import formula as f
from tltlc.logic.bounded_operators import count_down
from tltlc.logic.formula import Formula

A, B = f.atom("a"), f.atom("b")


def compiled(formula: str, semantics: str) -> Fspa:
    with unfolded():
        (fspa,) = tltlc.compile_text(
            f"signal a: bool signal b: bool signal c: bool spec s {{ semantics {semantics} require {formula} }}"
        )
    return fspa


def within(steps: int, body: Formula = A) -> Formula:
    """``F[0,steps] body``."""
    formula = body
    for _ in range(steps):
        formula = f.or_(body, f.next_(formula))
    return formula


def for_all(steps: int, body: Formula = A) -> Formula:
    """``G[0,steps] body``."""
    formula = body
    for _ in range(steps):
        formula = f.and_(body, f.weak_next(formula))
    return formula


@pytest.mark.parametrize("body", [A, f.or_(A, B), f.and_(A, B), f.next_(A)])
@pytest.mark.parametrize("bound", [within, for_all])
def test_bounded_formulas_count_down(bound, body: Formula) -> None:  # type: ignore[no-untyped-def]
    step = f.next_ if bound is within else f.weak_next
    for steps in (1, 2, 5):
        assert count_down(step(bound(steps, body))) is step(bound(steps - 1, body))
    assert count_down(step(body)) is None


@pytest.mark.parametrize(
    "formula",
    [
        A,
        within(3),
        f.next_(f.or_(A, f.weak_next(A))),
        f.next_(f.or_(A, f.next_(B))),
        f.next_(f.or_(A, f.next_(f.or_(B, f.next_(B))))),
        f.next_(f.or_(A, f.next_(f.and_(A, f.next_(A))))),
        f.next_(f.or_(f.next_(A), A)),
    ],
    ids=str,
)
def test_other_formulas_do_not_count_down(formula: Formula) -> None:
    assert count_down(formula) is None


@pytest.mark.parametrize("semantics", ["finite", "infinite"])
@pytest.mark.parametrize(
    ("formula", "states"),
    [
        ("G(a -> F[0,15] b)", 17),
        ("G(a -> F[0,15] (b & c))", 17),
        ("G(a -> G[0,15] b)", 17),
        ("F(a & G[0,15] b)", 17),
        ("F(a & F[0,15] b)", 17),
        ("G(a -> F[2,8] b)", 17),
        ("F[0,8] b & G[0,8] c", 19),
        ("G(a -> F[0,8] G[0,3] b)", 56),
        pytest.param("G(a -> F[0,60] b)", 62, marks=pytest.mark.slow),
        pytest.param("G(a -> F[0,60] (b & c))", 62, marks=pytest.mark.slow),
        pytest.param("G(a -> G[0,60] b)", 62, marks=pytest.mark.slow),
        pytest.param("F(a & G[0,60] b)", 62, marks=pytest.mark.slow),
        pytest.param("F(a & F[0,60] b)", 62, marks=pytest.mark.slow),
        pytest.param("G(a -> F[2,20] b)", 41, marks=pytest.mark.slow),
        pytest.param("F[0,20] b & G[0,20] c", 43, marks=pytest.mark.slow),
        pytest.param("G(a -> F[0,20] G[0,3] b)", 152, marks=pytest.mark.slow),
    ],
)
def test_overlapping_bounds_have_these_sizes(formula: str, states: int, semantics: str) -> None:
    fspa = compiled(formula, semantics)
    assert len(fspa.states) == states


@pytest.mark.parametrize("semantics", ["finite", "infinite"])
def test_labels_of_states_count_a_bound_down(semantics: str) -> None:
    labels = {str(state.label) for state in compiled("G(a -> F[0,50] b)", semantics).states}
    assert labels >= {f"G(a -> F[0,50] b) & F[0,{steps}] b" for steps in range(2, 50)}


@pytest.mark.parametrize("bound", [within, for_all])
def test_long_bounds_need_no_deep_stack(bound) -> None:  # type: ignore[no-untyped-def]
    longest, before = bound(1_000), sys.getrecursionlimit()
    step = f.next_ if bound is within else f.weak_next
    successors, after = Successors(["a"], TransitionDiagrams()), ObligationAutomaton(["a"], Diagrams(Work(1_000)))
    sys.setrecursionlimit(len(inspect.stack(0)) + 1_100)
    try:
        assert successors.of_obligation(successors.obligation(step(longest)))
        assert after.after(after.obligation(f.next_(within(1_000))))
    finally:
        sys.setrecursionlimit(before)


def test_labels_of_long_bounds_are_not_searched_for_redundant_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    searched: set[int] = set()
    support = ObligationWriter.support

    def watched(writer: ObligationWriter, obligation: int) -> list[int]:
        searched.add(obligation)
        return support(writer, obligation)

    monkeypatch.setattr(ObligationWriter, "support", watched)
    labels = [str(state.label) for state in compiled("F[0,300] b", "finite").states]
    assert {f"F[0,{steps}] b" for steps in range(2, 301)} <= set(labels)
    assert len(searched) < 150


def test_the_automaton_of_a_long_bound_can_be_pickled() -> None:
    fspa = compiled("F[0,600] b", "finite")
    copy = pickle.loads(pickle.dumps(fspa))
    assert copy == fspa
    assert copy.states[0].label is fspa.states[0].label
    assert pickle.loads(pickle.dumps(fspa.formula)) is fspa.formula
