"""The oracle agrees with worked examples, and with the fast truth tables of these tests."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.logic.strategies import formulas, state_formulas, traces
from tests.logic.truth_table import TruthTable
from tests.reference_formulas import read_formula
from tltlc.logic.formula import Formula
from tltlc.logic.oracle import all_traces, holds, robustness_of_state

TABLE = TruthTable("ab", 3)


@pytest.mark.parametrize(
    ("formula", "trace", "expected"),
    [
        ("X a", "ab a", True),
        ("X a", "a", False),
        ("N a", "a", True),
        ("N a", "a b", False),
        ("F a", "b b a", True),
        ("F a", "b b", False),
        ("G a", "a a ab", True),
        ("G a", "a b", False),
        ("a U b", "a a b", True),
        ("a U b", "a a a", False),
        ("a U b", "a - b", False),
        ("a U b", "b", True),
        ("a W b", "a a a", True),
        ("a W b", "a - b", False),
        ("a R b", "b b ab -", True),
        ("a R b", "b b a", False),
        ("a R b", "b b", True),
        ("a M b", "b b", False),
        ("a M b", "b ab -", True),
        ("X true", "a", False),
        ("F(a & X F b)", "ab -", False),
        ("F(a & X F b)", "ab b", True),
        ("F(a & X F b)", "b a", False),
        ("a -> b", "b", True),
        ("a <-> b", "-", True),
        ("a <-> b", "a", False),
        ("G F a", "a b a", True),
        ("F G a", "a b a", True),
        ("F G a", "a b", False),
    ],
)
def test_operators_hold_on_the_traces_of_worked_examples(formula: str, trace: str, expected: bool) -> None:
    samples = [set(sample) - {"-"} for sample in trace.split()]
    assert holds(read_formula(formula), samples) is expected


def test_a_position_counts_from_the_first_sample() -> None:
    assert not holds(read_formula("a"), ["a", "b"], 1)


@pytest.mark.parametrize(("trace", "position"), [([], 0), (["a"], 1), (["a"], -1)])
def test_a_position_outside_the_trace_is_an_error(trace: list[str], position: int) -> None:
    with pytest.raises(ValueError, match="has no position"):
        holds(read_formula("a"), trace, position)


@given(formulas(("a", "b"), 8))
def test_the_truth_table_agrees_with_the_oracle(formula: Formula) -> None:
    groups = [[trace for trace in all_traces("ab", 3) if len(trace) == n] for n in (1, 2, 3)]
    assert TABLE.all_positions(formula) == tuple(
        tuple(sum(1 << k for k, trace in enumerate(group) if holds(formula, trace, i)) for i in range(len(group[0])))
        for group in groups
    )


@given(formulas(), traces())
def test_only_the_rest_of_a_trace_matters_at_a_position(formula: Formula, trace: tuple[frozenset[str], ...]) -> None:
    for position in range(len(trace)):
        assert holds(formula, trace, position) == holds(formula, trace[position:])


def test_all_traces_are_enumerated_by_length() -> None:
    traces_ = list(all_traces("ab", 3))
    assert len(traces_) == len(set(traces_)) == 4 + 16 + 64
    assert [len(trace) for trace in traces_] == sorted(len(trace) for trace in traces_)


@pytest.mark.parametrize(
    ("formula", "expected"),
    [("a", 0.5), ("!a", -0.5), ("a & b", -0.25), ("a | b", 0.5), ("true", 1), ("false", -1), ("a -> b", -0.25)],
)
def test_robustness_has_the_values_of_worked_examples(formula: str, expected: float) -> None:
    assert robustness_of_state(read_formula(formula), {"a": 0.5, "b": -0.25}) == expected


@given(state_formulas(), st.lists(st.floats(-1, 1).filter(bool), min_size=3, max_size=3))
def test_the_sign_of_the_robustness_is_the_truth_value(formula: Formula, numbers: list[float]) -> None:
    values = dict(zip("abc", numbers, strict=True))
    robustness = robustness_of_state(formula, values)
    assert -1 <= robustness <= 1
    assert (robustness > 0) == holds(formula, [{name for name, value in values.items() if value > 0}])


def test_robustness_of_a_temporal_formula_is_an_error() -> None:
    with pytest.raises(ValueError, match="more than one state"):
        robustness_of_state(read_formula("F a"), {"a": 1.0})
