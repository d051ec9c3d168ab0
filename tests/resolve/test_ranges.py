"""The range of an operation contains every value that the evaluator computes, to the last bit."""

from __future__ import annotations

from hypothesis import assume, given
from hypothesis import strategies as st

from tests.resolve.helpers import codes
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import ArithmeticOp, Const, Op, SignalValue
from tltlc.resolve.ranges import range_of

COUNTS: dict[ArithmeticOp, int] = {"+": 3, "-": 2, "*": 3, "/": 2, "neg": 1, "min": 2, "max": 2, "abs": 1, "sqrt": 1}
NUMBERS = st.floats(-4, 4) | st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def ranges(draw: st.DrawFn) -> tuple[tuple[float, float], float]:
    """Draw a range and a value in it, often one of its ends."""
    low, high = sorted((draw(NUMBERS), draw(NUMBERS)))
    return (low, high), draw(st.sampled_from([low, high]) | st.floats(low, high))


def value(expression: Op, values: dict[str, float]) -> float:
    try:
        return evaluate(expression, values, {})
    except (ArithmeticError, ValueError):
        assume(False)
        raise


@given(st.sampled_from(sorted(COUNTS)), st.data())
def test_the_value_of_an_operation_is_in_its_range(op: ArithmeticOp, data: st.DataObject) -> None:
    drawn = [data.draw(ranges()) for _ in range(COUNTS[op])]
    values = {f"x{index}": number for index, (_, number) in enumerate(drawn)}
    result = value(Op(op, tuple(map(SignalValue, values))), values)
    assume(result == result)
    low, high = range_of(op, tuple(bounds for bounds, _ in drawn))
    assert low <= result <= high


@given(st.integers(-4, 5), ranges())
def test_the_value_of_a_power_is_in_its_range(exponent: int, drawn: tuple[tuple[float, float], float]) -> None:
    bounds, base = drawn
    result = value(Op("^", (SignalValue("x"), Const(float(exponent)))), {"x": base})
    low, high = range_of("^", (bounds, (float(exponent), float(exponent))))
    assert low <= result <= high


CUBE_ROOT = 1.2287622212704528
"""A number whose third power by `pow` is slightly smaller than the product of its three factors."""


def test_a_range_contains_the_power_and_the_product() -> None:
    highest = CUBE_ROOT * CUBE_ROOT * CUBE_ROOT
    assert highest > CUBE_ROOT**3
    declared = f"signal x: number in [0, {CUBE_ROOT!r}]\nspec s = F x^3 > "
    assert codes(f"{declared}{CUBE_ROOT**3!r}") == []
    assert codes(f"{declared}{highest!r}") == ["TLT0310"]
