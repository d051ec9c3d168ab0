"""Signatures of formulas: the truth on sampled traces, so that they never refute an implication that holds."""

from __future__ import annotations

from hypothesis import given

from tests.fuzzing import times
from tests.logic.small_formulas import formulas_up_to
from tests.logic.strategies import formulas
from tests.logic.truth_table import TruthTable
from tltlc.logic import formula as f
from tltlc.logic.formula import Formula
from tltlc.logic.oracle import holds
from tltlc.logic.signature import signature

TABLE = TruthTable("ab", 3)


@times(100)
@given(formulas(max_leaves=12))
def test_a_signature_is_the_truth_on_the_sampled_traces(formula: Formula) -> None:
    atoms = {name: signature(f.atom(name)) for name in "abc"}
    bits = signature(formula)
    for k in (0, 17, 63):
        trace = [{name for name, word in atoms.items() if word >> (64 * i + k) & 1} for i in range(3)]
        for i in range(3):
            assert holds(formula, trace, i) == bool(bits >> (64 * i + k) & 1)


def test_equivalent_formulas_share_a_signature_and_others_rarely_do() -> None:
    small = formulas_up_to(4)
    signature_of = {TABLE.of(formula): signature(formula) for formula in small}
    assert all(signature(formula) == signature_of[TABLE.of(formula)] for formula in small)
    assert len(set(signature_of.values())) > 0.98 * len(signature_of)


def test_a_deep_formula_has_a_signature() -> None:
    deep = f.atom("a")
    for _ in range(10_000):
        deep = f.or_(f.atom("b"), f.next_(deep))
    assert signature(deep)
