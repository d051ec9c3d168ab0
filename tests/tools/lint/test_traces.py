"""The sets of traces that other tests use agree with the definition of the logic."""

from __future__ import annotations

from hypothesis import given

from tests.fuzzing import times
from tests.logic.strategies import formulas, traces
from tests.tools.lint.traces import LONGEST, Traces, subsets
from tltlc.logic.formula import Formula
from tltlc.logic.oracle import holds

LETTERS = subsets(["a", "b"])


@times(40)
@given(formulas(["a", "b"]), traces(["a", "b"], max_length=LONGEST))
def test_sets_of_traces_agree_with_the_oracle_on_single_traces(
    formula: Formula, trace: tuple[frozenset[str], ...]
) -> None:
    number = sum(LETTERS.index(letter) * len(LETTERS) ** step for step, letter in enumerate(trace))
    satisfying = Traces(LETTERS).satisfying(formula)[len(trace) - 1]
    assert bool(satisfying >> number & 1) == holds(formula, trace)
    at_some_step = Traces(LETTERS).holding_at_some_step(formula)[len(trace) - 1]
    assert bool(at_some_step >> number & 1) == any(holds(formula, trace, step) for step in range(len(trace)))
