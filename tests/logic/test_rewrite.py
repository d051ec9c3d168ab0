"""Each law, and the simplifier, against the oracle."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.logic.strategies import formulas
from tests.reference_formulas import corpus, read_formula
from tltlc.logic import formula as f
from tltlc.logic.formula import Formula
from tltlc.logic.implication import complement, syntactically_implies, value_at_last
from tltlc.logic.oracle import all_traces, holds
from tltlc.logic.rewrite import REWRITES, Rewrite, simplify, size

LAWS = [
    pytest.param(rewrite, law, id=f"{rewrite.name}: {law.strip()}") for rewrite in REWRITES for law in rewrite.law.split(";")
]
TRACES = tuple(all_traces("ab", 3))


def equal(left: Formula, right: Formula, traces: object = TRACES) -> bool:
    assert isinstance(traces, tuple)
    return all(holds(left, trace) == holds(right, trace) for trace in traces)


@pytest.mark.parametrize(("rewrite", "law"), LAWS)
def test_each_law_holds_on_all_traces_up_to_length_4(rewrite: Rewrite, law: str) -> None:
    left, right = (read_formula(side) for side in law.split("="))
    assert rewrite.apply(left) is right
    assert size(right) <= size(left)
    atoms = dict.fromkeys([*left.atoms(), *right.atoms()])
    assert equal(left, right, tuple(all_traces(list(atoms), 4)))


@given(formulas(("a", "b"), 8))
def test_no_rewrite_changes_the_meaning_or_makes_longer(formula: Formula) -> None:
    for node in formula.walk():
        for rewrite in REWRITES:
            if node.op in rewrite.ops:
                rewritten = rewrite.apply(node)
                if rewritten is not node:
                    assert size(rewritten) <= size(node), rewrite.name
                    assert equal(rewritten, node), rewrite.name


@given(formulas(("a", "b"), 12))
def test_simplify_keeps_the_meaning_and_never_makes_longer(formula: Formula) -> None:
    simpler = simplify(formula)
    assert size(simpler) <= size(formula)
    assert equal(simpler, formula)
    assert simplify(simpler) is simpler
