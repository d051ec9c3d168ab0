from __future__ import annotations

import math
import struct
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fixtures import near
from tests.monitor.strategies import PARAMS, SIGNALS, expressions, numbers
from tltlc.expression import python as expression_python
from tltlc.expression.evaluate import evaluate
from tltlc.expression.json import from_json, to_json
from tltlc.expression.python import compile_expressions
from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When

FAILURES = (ZeroDivisionError, OverflowError, ValueError)


def result(compute: Callable[[], float]) -> object:
    """Return the bits of a value, or the type of the error; all NaNs count as equal."""
    try:
        value = compute()
    except FAILURES as error:
        return type(error)
    return "nan" if math.isnan(value) else struct.pack("d", value)


@given(expressions(), st.tuples(numbers, numbers), st.tuples(numbers, numbers))
def test_python_source_computes_the_same_bits(
    expression: Expression, signals: tuple[float, float], params: tuple[float, float]
) -> None:
    constants = dict(zip(PARAMS, params, strict=True))
    (compiled,) = compile_expressions([expression], SIGNALS, constants)
    expected = result(lambda: evaluate(expression, dict(zip(SIGNALS, signals, strict=True)), constants))
    assert result(lambda: compiled(signals)) == expected


@given(expressions())
def test_expressions_are_read_back_from_json(expression: Expression) -> None:
    assert from_json(to_json(expression)) == expression


@pytest.mark.parametrize(
    ("distance", "expected"),
    [(0.0, 1.0), (0.5, 0.5), (1.0, 0.0), (5.0, -56 / 81), (5.5, -0.75), (10.0, -1.0), (11, -1)],
)
def test_closeness_has_the_values_of_the_paper(distance: float, expected: float) -> None:
    """Eq. 2 of the paper with b = 1, B = 10."""
    assert evaluate(near("d"), {"d": distance}, {"level_size": 10.0}) == pytest.approx(expected, abs=1e-15)


@given(st.floats(0.01, 1e6), st.floats(1.001, 1e6))
def test_closeness_halfway_is_minus_three_quarters(close: float, ratio: float) -> None:
    far = close * ratio
    value = evaluate(near("d", close=close), {"d": (close + far) / 2}, {"level_size": far})
    assert value == pytest.approx(-0.75, abs=1e-6)


x = SignalValue("x")


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (Op("-", (Const(8.0), Op("-", (Const(4.0), x)))), 6.0),
        (Op("/", (Const(8.0), Op("*", (Const(2.0), x)))), 2.0),
        (Op("neg", (Op("neg", (x,)),)), 2.0),
        (Op("^", (Op("neg", (x,)), Const(2.0))), 4.0),
        (Op("neg", (Op("^", (x, Const(2.0))),)), -4.0),
        (Op("^", (Op("^", (Op("+", (x, x)), Const(2.0))), Const(3.0))), 4096.0),
        (Op("clamp", (x, Const(-1.0), Const(1.0))), 1.0),
        (Op("*", (x, When(((Condition("<", (x, Const(0.0))), Const(5.0)),), Const(7.0)))), 14.0),
        (Op("max", (x, Const(1.0), Const(3.0))), 3.0),
        (Op("tanh", (Op("exp", (Op("sqrt", (Op("abs", (x,)),)),)),)), math.tanh(math.exp(math.sqrt(2.0)))),
        (When(((Condition("not", (Condition(">", (x, Const(3.0))),)), Const(1.0)),), Const(-1.0)), 1.0),
    ],
)
def test_expressions_have_the_values_computed_by_hand(expression: Expression, expected: float) -> None:
    assert evaluate(expression, {"x": 2.0}, {}) == expected
    assert compile_expressions([expression], ["x"], {})[0]((2.0,)) == expected


def test_only_the_selected_case_is_computed() -> None:
    guarded = When(((Condition(">", (x, Const(0.0))), Op("/", (Const(1.0), x))),), Const(-1.0))
    for expression in (guarded, Op("+", (guarded, Const(0.0)))):
        assert evaluate(expression, {"x": 0.0}, {}) == -1.0
        assert compile_expressions([expression], ["x"], {})[0]((0.0,)) == -1.0


@pytest.mark.parametrize(
    ("expression", "error"),
    [
        (Op("/", (x, Const(0.0))), ZeroDivisionError),
        (Op("exp", (Const(1e9),)), OverflowError),
        (Op("^", (Const(1e300), Const(7.5))), OverflowError),
        (Op("sqrt", (Const(-1.0),)), ValueError),
        (Op("^", (Const(-1.0), Const(0.5))), ValueError),
    ],
)
def test_an_expression_without_a_value_is_an_error(expression: Expression, error: type[Exception]) -> None:
    with pytest.raises(error):
        evaluate(expression, {"x": 1.0}, {})
    with pytest.raises(error):
        compile_expressions([expression], ["x"], {})[0]((1.0,))


@pytest.mark.parametrize("op", ["+", "-", "*", "/", "^", "min", "neg", "when", "condition", "power"])
def test_expressions_of_100_operators_are_computed(op: str) -> None:
    """The arithmetic of a spec may be 100 operators deep, on either side."""
    for left in (True, False):
        expression: Expression = ParamValue("p")
        for _ in range(100):
            pair = (expression, x) if left else (x, expression)
            if op == "when":
                expression = When(((Condition("<", (x, Const(0.0))), pair[0]),), pair[1])
            elif op == "condition":
                expression = When(((Condition("<", pair), Const(0.5)),), Const(0.25))
            elif op == "power":
                expression = Op("^", (Op("*", (expression, Const(0.5))), Const(2.0)))
            elif op == "neg":
                expression = Op("neg", (expression,))
            else:
                expression = Op(op, pair)  # type: ignore[arg-type]
        (compiled,) = compile_expressions([expression], ["x"], {"p": 0.75})
        assert result(lambda: compiled((0.5,))) == result(lambda: evaluate(expression, {"x": 0.5}, {"p": 0.75}))  # noqa: B023


def test_the_size_of_the_source_is_linear_in_the_atoms(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each function names only the signals that it reads.  If each named all of them, 5,000 atoms would take 19 GB."""
    texts: list[str] = []

    def compiled(text: str, *rest: str) -> object:
        texts.append(text)
        return compile(text, *rest)

    monkeypatch.setattr(expression_python, "compile", compiled, raising=False)
    names = [f"x{number}" for number in range(500)]
    functions = compile_expressions([Op("neg", (SignalValue(name),)) for name in names], names, {})
    assert [function(range(500)) for function in functions] == [-number for number in range(500)]
    assert len(texts[0]) < 500 * 100
