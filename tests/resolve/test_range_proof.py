"""The check of predicates proves ranges or finds counterexamples, and is correct in both cases."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When
from tltlc.resolve import spec
from tltlc.resolve.range_proof import RangeProblem, check_predicate

D, X, Y, H, OPEN = (
    SignalValue("distance(s1)"),
    SignalValue("x"),
    SignalValue("y"),
    SignalValue("health"),
    SignalValue("open"),
)
FAR, CLOSE = ParamValue("far"), ParamValue("close")
SIGNALS = {
    "distance(s1)": spec.Signal("distance(s1)", "length", 0.0, None),
    "x": spec.Signal("x", "number", -1.0, 1.0),
    "y": spec.Signal("y", "number", None, None),
    "health": spec.Signal("health", "ratio", 0.0, 1.0),
    "open": spec.Signal("open", "bool", None, None),
}
PARAMS = {
    "far": spec.Param("far", "length", 20.0, 2.0, 10000.0),
    "close": spec.Param("close", "length", 1.0, 0.5, 1.5),
}


@pytest.fixture(autouse=True)
def no_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLTLC_CACHE_DIR", "")


def op(name: str, *args: Expression | float) -> Op:
    return Op(name, tuple(Const(float(a)) if isinstance(a, (int, float)) else a for a in args))  # type: ignore[arg-type]


def cond(left: Expression, name: str, right: Expression | float) -> Condition:
    return Condition(name, (left, Const(float(right)) if isinstance(right, (int, float)) else right))  # type: ignore[arg-type]


def near(close: Expression, far: Expression) -> Expression:
    """Return closeness by equation (2) of Gutiérrez-Sánchez et al., IEEE Trans. Games 2024."""
    falling = op("-", op("^", op("/", op("-", far, D), op("-", far, close)), 2), 1)
    return When(
        ((cond(D, "<", close), op("-", 1, op("/", D, close))), (cond(D, "<=", far), falling)),
        Const(-1.0),
    )


def check(expression: Expression, low: float = -1.0, high: float = 1.0) -> tuple[RangeProblem, ...]:
    return check_predicate(expression, SIGNALS, PARAMS, low, high)


def kinds(expression: Expression, low: float = -1.0, high: float = 1.0) -> list[str]:
    return [finding.kind for finding in check(expression, low, high)]


@pytest.mark.parametrize("close", [Const(1.0), CLOSE])
def test_near_is_in_range_and_continuous_for_every_far(close: Expression) -> None:
    assert check(near(close, FAR)) == ()


def test_near_is_in_range_for_an_unbounded_far() -> None:
    params = {"far": spec.Param("far", "length", 20.0, 2.0, None)}
    assert check_predicate(near(Const(1.0), FAR), SIGNALS, params, -1.0, 1.0) == ()


def test_near_with_far_below_close_divides_by_zero_and_jumps() -> None:
    wrong, jump = check(near(Const(3.0), FAR))
    assert wrong == RangeProblem(
        "range_wrong",
        "with distance(s1) = 3, far = 3 the value divides by zero",
        {"distance(s1)": 3.0, "far": 3.0},
        is_undefined=True,
    )
    assert jump.kind == "discontinuous"
    assert jump.message == "with distance(s1) = 3, far = 2 the value jumps from 0 to -1"


def test_near_with_far_above_close_is_fine() -> None:
    params = {"far": spec.Param("far", "length", 20.0, 4.0, 10000.0)}
    assert check_predicate(near(Const(3.0), FAR), SIGNALS, params, -1.0, 1.0) == ()


@pytest.mark.parametrize(
    ("expression", "low", "high"),
    [
        (H, 0, 1),
        (op("-", op("*", 2, H), 1), -1, 1),
        (op("clamp", Y, -1, 1), -1, 1),
        (op("max", -1, op("min", 1, op("-", op("/", D, 10), 1))), -1, 1),
        (op("tanh", Y), -1, 1),
        (op("exp", op("neg", D)), 0, 1),
        (op("-", 1, op("sqrt", H)), 0, 1),
        (When(((cond(OPEN, ">", 0.5), H),), Const(-1.0)), -1, 1),
        (When(((cond(op("abs", X), "<", 0.5), op("-", 1, op("*", 2, op("abs", X)))),), Const(0.0)), 0, 1),
        (When(((Condition("and", (cond(X, ">", 0.25), cond(op("/", 1, X), "<", 3))), H),), H), 0, 1),
        (op("*", op("*", 4, H), op("-", 1, H)), 0, 1),
        (op("/", op("*", 2, X), op("+", 1, op("*", X, X))), -1, 1),
        (op("/", op("*", 2, Y), op("+", 1, op("^", Y, 2))), -1, 1),
        (op("-", op("*", 3, op("^", H, 2)), op("*", 2, op("^", H, 3))), 0, 1),
        (op("clamp", op("-", 1, op("*", X, X)), -1, 0.5), 0, 0.5),
        (op("/", op("-", FAR, CLOSE), op("+", FAR, CLOSE)), 0, 1),
    ],
)
def test_correct_predicates_are_proved(expression: Expression, low: float, high: float) -> None:
    assert check(expression, low, high) == ()


@pytest.mark.parametrize(
    ("expression", "message"),
    [
        (op("*", 2, H), "with health = 1 the value is 2"),
        (op("/", X, H), "with x = -1, health = 0 the value divides by zero"),
        (op("sqrt", X), "with x = -1 the value takes a root or power that no real number has"),
        (op("/", 1, op("+", 1, op("exp", Y))), "with y = 1e+06 the value is too large to compute"),
        (op("/", D, 1000), "with distance(s1) = 1e+06 the value is 1000"),
        (Const(1.5), "the value is 1.5"),
    ],
)
def test_a_wrong_range_has_a_counterexample(expression: Expression, message: str) -> None:
    (finding,) = check(expression)
    assert (finding.kind, finding.message) == ("range_wrong", message)


def test_a_narrow_peak_is_an_error_only_if_it_leaves_the_range() -> None:
    peak = op("/", 1, op("+", 1, op("*", 1e6, op("^", op("-", X, 0.123), 2))))
    assert check(peak, 0, 1) == ()
    assert kinds(peak, 0, 0.9) == ["range_wrong"]


def test_a_range_without_a_proof_is_reported_as_unproved() -> None:
    identity = op("/", Y, op("sqrt", op("+", 1, op("^", Y, 2))))
    assert kinds(identity) == ["range_unproved"]


@pytest.mark.parametrize(
    ("when", "expected"),
    [
        (When(((cond(X, "<", 0.3), Const(0.0)),), op("-", X, 0.3)), []),
        (When(((cond(X, "<", 0.3), Const(0.0)),), op("-", X, 0.2)), ["discontinuous"]),
        (When(((cond(X, "<", H), X),), H), []),
        (When(((cond(X, "<", H), X),), op("neg", H)), ["discontinuous"]),
        (When(((cond(op("^", X, 2), "<", 0.25), op("^", X, 2)),), Const(0.25)), []),
        (When(((cond(OPEN, ">", 0), Const(1.0)),), Const(-1.0)), []),
        (When(((cond(FAR, ">", 100), Const(1.0)),), Const(-1.0)), []),
        (op("+", 0.5, When(((cond(X, "<", 0), Const(0.0)),), Const(0.1))), ["discontinuous"]),
        (When(((cond(X, ">", 0), op("clamp", op("/", 1, X), 0, 1)),), Const(0.5)), ["discontinuous"]),
    ],
)
def test_jumps_between_cases_are_found(when: Expression, expected: list[str]) -> None:
    assert kinds(when) == expected


def test_an_expression_with_too_many_cases_is_not_checked() -> None:
    many: Expression = Const(0.0)
    for number in range(12):
        many = op("+", many, When(((cond(X, "<", number / 12), Const(0.01)),), Const(-0.01)))
    assert kinds(many) == ["range_unchecked"]


def test_a_very_large_expression_is_not_checked() -> None:
    large: Expression = X
    for _ in range(60):
        large = op("*", large, op("/", large, 2))
    assert kinds(large) == ["range_unchecked"]


def test_a_very_deep_expression_is_not_checked() -> None:
    deep: Expression = X
    for _ in range(5000):
        deep = op("neg", deep)
    assert kinds(deep) == ["range_unchecked"]


VARIABLES = [X, H, FAR, CLOSE]
NUMBERS = st.integers(-8, 8).map(lambda n: Const(n / 4))
LEAVES = st.one_of(NUMBERS, st.sampled_from(VARIABLES))


def _operators(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    comparison = st.builds(lambda a, o, b: cond(a, o, b), inner, st.sampled_from(["<", "<=", ">", ">="]), inner)
    return st.one_of(
        st.builds(op, st.sampled_from(["+", "-", "*", "/", "min", "max"]), inner, inner),
        st.builds(op, st.sampled_from(["neg", "abs", "sqrt", "tanh"]), inner),
        st.builds(lambda a, n: op("^", a, n), inner, st.sampled_from([-1, 2, 3, 0.5])),
        st.builds(lambda c, a, b: When(((c, a),), b), comparison, inner, inner),
    )


EXPRESSIONS = st.recursive(LEAVES, _operators, max_leaves=7)
RANGES = {"x": (-1.0, 1.0), "health": (0.0, 1.0), "far": (2.0, 10000.0), "close": (0.5, 1.5)}


def value_at(expression: Expression, point: dict[str, float]) -> float | None:
    try:
        value = evaluate(expression, point, point)
    except (ArithmeticError, ValueError):
        return None
    return value if math.isfinite(value) else None


def samples(seed: int, count: int) -> Iterator[dict[str, float]]:
    """Yield random points of the ranges; some coordinates are ends or round numbers."""
    random_ = random.Random(seed)
    for _ in range(count):
        yield {
            name: random_.choice(
                [low, high, random_.uniform(low, high), random_.uniform(low, high), min(max(0.25, low), high)]
            )
            for name, (low, high) in RANGES.items()
        }


@times(60)
@given(EXPRESSIONS, st.sampled_from([(-1.0, 1.0), (0.0, 1.0), (-0.5, 3.0)]), st.integers(0, 10**6))
def test_proved_ranges_hold_and_wrong_ones_fail_at_the_witness(
    expression: Expression, declared: tuple[float, float], seed: int
) -> None:
    low, high = declared
    findings = {finding.kind: finding for finding in check(expression, low, high)}
    if "range_wrong" in findings:
        value = value_at(expression, dict(findings["range_wrong"].witness))
        assert value is None or not low <= value <= high
        for name, value in findings["range_wrong"].witness.items():
            assert RANGES[name][0] <= value <= RANGES[name][1]
    elif not findings.keys() & {"range_unproved", "range_unchecked"}:
        for point in samples(seed, 1000):
            value = value_at(expression, point)
            assert value is not None
            assert low - 1e-8 <= value <= high + 1e-8


@times(40)
@given(LEAVES, EXPRESSIONS, EXPRESSIONS, st.sampled_from([X, H]), st.integers(0, 10**6))
def test_values_agree_across_borders_unless_a_jump_is_found(
    at: Expression, inside: Expression, outside: Expression, variable: SignalValue, seed: int
) -> None:
    expression = When(((cond(variable, "<", at), inside),), outside)
    findings = {finding.kind: finding for finding in check(expression, -1e3, 1e3)}
    if findings.keys() & {
        "range_wrong",
        "range_unproved",
        "range_unchecked",
        "continuity_unproved",
        "continuity_unchecked",
    }:
        return
    if "discontinuous" in findings:
        point = dict(findings["discontinuous"].witness)
        across = [value_at(expression, {**point, n: v + s}) for n, v in point.items() for s in (-1e-9, 1e-9)]
        here = value_at(expression, point)
        assert here is not None
        assert any(value is not None and abs(value - here) > 1e-7 for value in across)
        return
    for point in samples(seed, 200):
        border = value_at(at, point)
        if border is not None and RANGES[variable.name][0] < border < RANGES[variable.name][1]:
            left, right = (value_at(expression, {**point, variable.name: border + s}) for s in (-1e-12, 1e-12))
            assert left is not None
            assert right is not None
            assert abs(left - right) < 1e-4


@pytest.mark.parametrize("side", [(-1e308, 1e308), (-1.7e308, 1.7e308), (1e200, 1.7e308), (-1e308, -1e200)])
def test_a_range_whose_width_overflows_is_still_checked(side: tuple[float, float]) -> None:
    signals = {"x": spec.Signal("x", "number", *side)}
    border = side[0] / 2 + side[1] / 2
    jumping = When(((cond(X, ">", border), Const(1.0)),), Const(-1.0))
    (jump,) = check_predicate(jumping, signals, {}, -1.0, 1.0)
    assert jump.kind == "discontinuous"
    (wrong,) = check_predicate(op("clamp", X, -2, 2), signals, {}, -1.0, 1.0)
    assert wrong.kind == "range_wrong"
    assert math.isfinite(wrong.witness["x"])
    assert check_predicate(op("clamp", op("/", X, 1e308), -1, 1), signals, {}, -1.0, 1.0) == ()
