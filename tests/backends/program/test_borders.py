"""A comparison with a border is true for exactly those numbers for which the expression is above 0."""

from __future__ import annotations

import math
from typing import Final

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.backends.program.interpreter import Scope
from tests.fuzzing import times
from tltlc.program.borders import border_test
from tltlc.program.bounds import ValueRange, range_between
from tltlc.program.tree import (
    BinaryNumber,
    Bool,
    Compare,
    Negate,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
)

X: Final = ProgramVariable("x")
CONSTANTS: Final = st.one_of(
    st.sampled_from((0.0, -0.0, 0.1, 1.0, -1.0, 300.5, 1e-310, 1e200, -1e-200, 1.7e308)),
    st.floats(allow_nan=False, allow_infinity=False),
).map(Real)


def wider(inner: st.SearchStrategy[ProgramExpression]) -> st.SearchStrategy[ProgramExpression]:
    operations = st.sampled_from(("+", "-", "*", "/"))
    return st.one_of(
        inner.map(Negate),
        st.builds(BinaryNumber, operations, inner, CONSTANTS),
        st.builds(BinaryNumber, operations, CONSTANTS, inner),
        st.builds(
            lambda f, one, other: NumericCall(f, (one, other)), st.sampled_from(("min", "max")), inner, CONSTANTS
        ),
        st.builds(
            lambda f, one, other: NumericCall(f, (other, one)), st.sampled_from(("min", "max")), inner, CONSTANTS
        ),
    )


LATE: Final = BinaryNumber("/", BinaryNumber("-", X, Real(300.5)), Real(300.5))


@times(300)
@given(
    node=st.recursive(st.just(X), wider, max_leaves=5),
    ends=st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 2),
    numbers=st.lists(st.floats(allow_nan=False, allow_infinity=False), max_size=5),
)
@example(node=LATE, ends=(0.0, 601.0), numbers=[300.0, 300.5, 301.0])
@example(node=BinaryNumber("/", BinaryNumber("-", X, Real(1e-310)), Real(1e10)), ends=(-1.0, 1.0), numbers=[])
@example(node=Negate(BinaryNumber("*", X, Real(1e-200))), ends=(-1.0, 1.0), numbers=[-5e-324, -0.0, 0.0])
def test_tests_are_equal_up_to_the_border_and_beyond(
    node: ProgramExpression, ends: tuple[float, float], numbers: list[float]
) -> None:
    low, high = sorted(ends)
    test = border_test(node, {"x": ValueRange(low, high)})
    if isinstance(test, Compare):
        assert isinstance(test.right, Real)
        limit = test.right.value
        numbers = [*numbers, limit, math.nextafter(limit, math.inf), math.nextafter(limit, -math.inf)]
    if test is not None:
        for number in (*(min(max(number, low), high) for number in numbers), low, high):
            scope = Scope({"x": number})
            assert scope.value(test) == (scope.value(node) > 0.0), number


def test_a_deadline_is_a_comparison_with_its_border() -> None:
    assert border_test(LATE, {"x": ValueRange(0.0, 601.0)}) == Compare(">", X, Real(300.5))
    assert border_test(Negate(LATE), {"x": ValueRange(0.0, 601.0)}) == Compare("<", X, Real(300.5))


def test_a_test_that_the_range_decides_is_constant() -> None:
    assert border_test(LATE, {"x": ValueRange(0.0, 300.5)}) == Bool(False)
    assert border_test(LATE, {"x": ValueRange(301.0, 601.0)}) == Bool(True)


@pytest.mark.parametrize(
    "node",
    [
        X,
        Real(1.0),
        BinaryNumber("*", X, X),
        BinaryNumber("-", X, ProgramVariable("y")),
        BinaryNumber("*", X, Real(0.0)),
        BinaryNumber("/", Real(1.0), X),
        NumericCall("abs", (X,)),
        NumericCall("min", (X, ProgramVariable("y"))),
        BinaryNumber("-", ProgramVariable("unknown"), Real(1.0)),
    ],
)
def test_other_expressions_have_no_border(node: ProgramExpression) -> None:
    assert border_test(node, {"x": range_between(0.0, 1.0), "y": range_between(0.0, 1.0)}) is None
