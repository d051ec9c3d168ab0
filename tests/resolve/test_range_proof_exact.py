"""The sympy proofs alone; in the full check, cheaper methods leave them little to do."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.resolve.test_range_proof import CLOSE, FAR, D, H, X, Y, near, op, value_at
from tltlc.expression.tree import Const, Expression, ParamValue, SignalValue
from tltlc.resolve.range_proof.cases import Constraint, cases
from tltlc.resolve.range_proof.continuity import meetings
from tltlc.resolve.range_proof.exact import proves_all, proves_within_exactly
from tltlc.resolve.range_proof.interval import EVERYTHING
from tltlc.resolve.range_proof.proof import ProofGoal
from tltlc.resolve.range_proof.region import ConstrainedBox, Variable

BOX: dict[Variable, tuple[float, float]] = {
    D: (0.0, float("inf")),
    FAR: (2.0, 10000.0),
    CLOSE: (0.5, 1.5),
    X: (-1.0, 1.0),
    H: (0.0, 1.0),
    Y: EVERYTHING,
}


def proves(value: Expression, low: float, high: float, *constraints: Constraint) -> bool:
    region = ConstrainedBox(BOX, {}).constrain(constraints)
    assert region is not None
    return proves_within_exactly(value, constraints, region, low, high)


@pytest.mark.parametrize("close", [Const(1.0), CLOSE])
def test_each_case_of_near_and_each_border_are_proved(close: Expression) -> None:
    expression = near(close, FAR)
    for case in cases(expression):
        assert proves(case.value, -1.0, 1.0, *case.constraints)
    borders = list(meetings(cases(expression), ConstrainedBox(BOX, {}), frozenset()))
    assert len(borders) == 2
    if close != CLOSE:
        for meeting in borders:
            difference = op("-", meeting.first.value, meeting.second.value)
            assert proves_within_exactly(difference, meeting.constraints, meeting.region, 0.0, 0.0)


@pytest.mark.parametrize(
    ("value", "least", "most"),
    [
        (op("/", op("*", 2, Y), op("+", 1, op("^", Y, 2))), -1, 1),
        (op("-", op("*", 3, op("^", H, 2)), op("*", 2, op("^", H, 3))), 0, 1),
        (op("*", op("-", X, H), op("+", X, H)), -1, 1),
        (op("/", op("-", X, H), op("+", 2, op("*", X, H))), -2, 0.5),
        (op("+", op("^", X, 4), op("-", op("^", X, 3), X)), -1.0, 1.7),
        (op("/", D, op("+", D, FAR)), 0, 1),
        (op("-", op("sqrt", H), H), 0, 0.25),
    ],
)
def test_tight_bounds_are_proved(value: Expression, least: float, most: float) -> None:
    assert proves(value, least, most)


@pytest.mark.parametrize(
    ("value", "low", "high"),
    [
        (op("/", op("*", 2, Y), op("+", 1, op("^", Y, 2))), -1, 0.999),
        (op("-", op("*", 3, op("^", H, 2)), op("*", 2, op("^", H, 3))), 0.001, 1),
        (op("/", 1, op("-", H, 0.123456)), -1e12, 1e12),
        (op("/", D, op("+", D, FAR)), 0, 0.9999),
        (op("*", X, Y), -1e9, 1e9),
        (op("+", op("*", H, op("^", Y, 2)), Y), -1e9, 1e300),
        (op("-", op("/", X, FAR), 1e-323), 0.0, 1.0),
    ],
)
def test_false_bounds_are_not_proved(value: Expression, low: float, high: float) -> None:
    assert not proves(value, low, high)


def test_min_does_not_hide_a_division_by_zero() -> None:
    task = ProofGoal(op("min", 1, op("/", 1, op("-", H, 0.123456))), (), -1e12, 1.0)
    assert not proves_all([task], ConstrainedBox(BOX, {}))


NAMES: list[SignalValue | ParamValue] = [X, H, FAR, CLOSE, D, Y]
SMALL = st.one_of(st.integers(-4, 4).map(lambda n: Const(n / 2)), st.sampled_from([X, H, CLOSE, Y]))
RATIONAL = st.recursive(
    SMALL,
    lambda inner: st.one_of(
        st.builds(op, st.sampled_from(["+", "-", "*", "/"]), inner, inner),
        st.builds(lambda a: op("^", a, 2), inner),
        st.builds(lambda a: op("sqrt", op("^", a, 2)), inner),
    ),
    max_leaves=6,
)


@times(40)
@given(RATIONAL, st.one_of(st.none(), RATIONAL), st.integers(-4, 4), st.integers(0, 4), st.integers(0, 10**6))
def test_a_proof_holds_at_every_sample(
    value: Expression, limit: Expression | None, low: int, width: int, seed: int
) -> None:
    constraints = () if limit is None else (Constraint(limit, False),)
    region = ConstrainedBox(BOX, {}).constrain(constraints)
    if region is None or not proves_within_exactly(value, constraints, region, low, low + width):
        return
    random_ = random.Random(seed)
    for _ in range(500):
        point = {}
        for name in NAMES:
            least, most = (max(BOX[name][0], -20.0), min(BOX[name][1], 20.0))
            point[name.name] = random_.choice([least, most, 0.5, random_.uniform(least, most), random_.uniform(-1, 1)])
            point[name.name] = min(max(point[name.name], least), most)
        if limit is not None and not (value_at(limit, point) or -1.0) >= 0:
            continue
        actual = value_at(value, point)
        assert actual is not None
        assert low - 1e-8 <= actual <= low + width + 1e-8
