"""The formula of a register is read back from its update, with the same meaning."""

from __future__ import annotations

from itertools import product

import pytest

from tltlc.automaton.remembered_formulas import from_robustness, from_truth
from tltlc.logic.formula import FALSE, TRUE, Formula, and_, atom, iff, implies, not_, or_
from tltlc.logic.oracle import holds
from tltlc.resolve.registers import robustness, truth

A, B, C = atom("a"), atom("b"), atom("c")
FORMULAS = [
    TRUE,
    FALSE,
    A,
    not_(A),
    and_(A, B, not_(C)),
    or_(not_(A), B, C),
    implies(A, B),
    implies(and_(A, B), or_(B, C)),
    not_(implies(A, not_(B))),
    iff(A, B),
    not_(iff(A, or_(B, C))),
    and_(or_(A, B), iff(A, not_(C))),
]


@pytest.mark.parametrize("formula", FORMULAS, ids=str)
def test_the_formula_has_the_same_meaning(formula: Formula) -> None:
    for back in (from_robustness(robustness(formula)), from_truth(truth(formula))):
        assert back is not None
        for letters in product((False, True), repeat=3):
            sample = frozenset(name for name, value in zip("abc", letters, strict=True) if value)
            assert holds(back, [sample]) == holds(formula, [sample])


@pytest.mark.parametrize("formula", [A, not_(A), and_(A, B), or_(A, not_(B)), implies(A, B), iff(A, B)], ids=str)
def test_short_formulas_come_back_as_they_were(formula: Formula) -> None:
    assert from_robustness(robustness(formula)) is formula
    assert from_truth(truth(formula)) is formula
