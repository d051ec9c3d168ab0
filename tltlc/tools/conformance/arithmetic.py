"""Cases for operators and functions in predicates, at values where programming languages differ."""

from __future__ import annotations

from functools import partial
from typing import Final, Literal

from tltlc.expression.tree import (
    ArithmeticOp,
    Condition,
    ConditionOp,
    Const,
    Expression,
    Op,
    ParamValue,
    SignalValue,
    When,
)
from tltlc.logic import formula as f
from tltlc.resolve import spec
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase, automaton
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.traces import random_trace, table

_X, _Y, _SEEN, _GAIN = SignalValue("x"), SignalValue("y"), SignalValue("seen"), ParamValue("gain")
_SIGNALS: Final = (spec.Signal("x", "number", None, None), spec.Signal("y", "number", None, None))
_SEEN_SIGNAL: Final = spec.Signal("seen", "bool", 0.0, 1.0)
_GAIN_PARAM: Final = spec.Param("gain", "number", 0.3, 0.1, 2.5)

_NEAR_ZERO: Final = (-3.0, -1.0, -0.5, -0.0, 0.0, 0.1, 0.3, 0.7, 1.0, 2.0, 2.5)
_POSITIVE: Final = (0.0, 0.1, 0.3, 0.7, 1.0, 2.0, 2.5, 16.0)


def _op(op: ArithmeticOp, *args: Expression | float) -> Op:
    return Op(op, tuple(Const(arg) if isinstance(arg, float) else arg for arg in args))


def _condition(op: ConditionOp, *args: Expression | Condition | float) -> Condition:
    return Condition(op, tuple(Const(arg) if isinstance(arg, float) else arg for arg in args))


def _divided(expression: Expression, scale: float) -> Op:
    return _op("/", expression, scale)


def _when(condition: Condition, value: Expression | float, otherwise: Expression | float) -> When:
    return When(
        ((condition, Const(value) if isinstance(value, float) else value),),
        Const(otherwise) if isinstance(otherwise, float) else otherwise,
    )


_SHARE = _op("/", 1.0, _X)
_ROOT = _op("sqrt", _X)
_HUGE = _op("*", 1e308, _X)
_NESTED = When(
    (
        # Where an earlier part decides a condition, its later parts may have no value: `1 / x` has none at 0.
        (_condition("and", _condition(">", _X, 0.0), _condition("<", _SHARE, 0.5)), _op("-", _SHARE, 0.25)),
        (_condition("or", _condition("<=", _X, 0.0), _condition(">=", _op("/", _Y, _X), 2.0)), _divided(_Y, 4.0)),
        (
            _condition("not", _condition("<", _when(_condition(">", _Y, 0.0), _op("sqrt", _Y), 0.0), 1.0)),
            _divided(_op("sqrt", _Y), 2.0),
        ),
    ),
    _when(
        _condition("and", _condition(">=", _X, 0.5), _condition("not", _condition(">", _Y, _X))),
        _divided(_ROOT, 2.0),
        _op("neg", _X),
    ),
)

_EXPRESSIONS: Final[dict[str, tuple[Expression, Expression, tuple[float, ...]]]] = {
    "sums": (
        _divided(_op("+", _op("+", _X, _Y), _op("+", 0.1, _GAIN)), 8.0),
        _divided(_op("-", _op("-", _X, _Y), _op("-", _GAIN, _X)), 9.0),
        _NEAR_ZERO,
    ),
    "products": (_divided(_op("*", _op("*", _X, _Y), _GAIN), 4.0), _op("*", _op("neg", _X), 0.1), _NEAR_ZERO),
    "quotients": (_op("/", _X, _op("*", 30.0, _GAIN)), _op("/", _Y, 3.0), _NEAR_ZERO),
    "squares_and_cubes": (
        _op("-", _divided(_op("^", _X, 2.0), 5.0), 0.5),
        _divided(_op("^", _op("-", _Y, 0.1), 3.0), 30.0),
        _NEAR_ZERO,
    ),
    "powers": (
        _op("-", _divided(_op("^", _X, 0.5), 3.0), 0.4),
        _op("-", _divided(_op("^", _op("+", _X, 0.5), _op("*", _GAIN, _Y)), 9.0), 0.2),
        _POSITIVE,
    ),
    "signs": (
        _divided(_op("neg", _op("neg", _op("neg", _X))), 3.0),
        _op("-", 0.5, _divided(_op("abs", _Y), 2.0)),
        _NEAR_ZERO,
    ),
    "extremes": (
        _divided(_op("min", _X, _Y, _op("neg", _X), 0.5), 3.0),
        _divided(_op("max", _X, _op("min", _Y, 0.7), -2.0), 3.0),
        _NEAR_ZERO,
    ),
    "clamps": (
        _op("clamp", _X, -0.5, 0.7),
        _op("clamp", _op("+", _X, _Y), _op("neg", _GAIN), _GAIN),
        _NEAR_ZERO,
    ),
    "roots": (_op("-", _divided(_op("sqrt", _X), 4.0), 0.2), _op("-", 0.5, _op("sqrt", _divided(_Y, 16.0))), _POSITIVE),
    "exponentials": (
        _op("-", _op("exp", _op("neg", _op("abs", _X))), 0.4),
        _op("tanh", _op("-", _op("exp", _Y), 1.0)),
        _NEAR_ZERO,
    ),
    "hyperbolic": (_op("tanh", _X), _op("neg", _op("tanh", _op("*", _GAIN, _Y))), _NEAR_ZERO),
    "cases": (
        _NESTED,
        _when(
            _condition("not", _condition("or", _condition("<", _SEEN, 0.5), _condition(">", _Y, 1.0))),
            0.75,
            _divided(_X, -4.0),
        ),
        _NEAR_ZERO,
    ),
    "zeros": (
        _op("*", _op("neg", _X), 0.0),
        _op("max", _op("min", _op("*", _op("*", -1.0, _Y), 0.0), 0.0), -0.0),
        _NEAR_ZERO,
    ),
    "clamped_infinities": (
        _op("clamp", _HUGE, -0.5, 0.75),
        # The difference of two infinities is NaN, and no number is less or greater than NaN.
        _op("max", _op("min", 0.25, _op("-", _HUGE, _op("*", _HUGE, 2.0))), -0.75),
        _NEAR_ZERO,
    ),
}


def _two_atom_case(name: str, first: Expression, second: Expression) -> ConformanceCase:
    """Return a case without traces, whose spec has two atoms with these expressions."""
    # The formula requires both atoms again and again, so that each row shows the value of one.
    formula = f.always(f.eventually(f.and_(f.atom("first"), f.atom("second"))))
    signals = (*_SIGNALS, _SEEN_SIGNAL) if name == "cases" else _SIGNALS
    fspa = automaton(name, formula, {"first": first, "second": second}, signals, (_GAIN_PARAM,))
    return ConformanceCase(fspa, "", ())


def _function_case(number: int, name: str) -> ConformanceCase:
    first, second, pool = _EXPRESSIONS[name]
    fspa = _two_atom_case(name, first, second).fspa
    draw, pools = Draw(2000 + number), {"x": pool, "y": pool}
    return ConformanceCase(fspa, f"Predicates: {name.replace('_', ' ')}.", (random_trace(fspa, draw, 40, pools),))


_REJECTED: Final[dict[str, tuple[Expression, Expression, tuple[tuple[float, float], ...]]]] = {
    "by_zero": (
        _divided(_SHARE, 8.0),
        _op("tanh", _op("/", _X, _op("-", _Y, 1.0))),
        ((2, 1), (0, 2), (-0.0, 2), (0, 1)),
    ),
    "no_root": (
        _divided(_op("sqrt", _X), 8.0),
        _divided(_op("^", _op("-", _Y, 1.0), 0.5), 8.0),
        ((-0.5, 2), (2, 0.5), (-1e-300, 2)),
    ),
    "power_of_zero": (_divided(_op("^", _X, -1.5), 100.0), _divided(_op("^", _Y, _X), 100.0), ((0, 2), (0.5, -2))),
    "too_large": (
        _divided(_op("exp", _X), 1e4),
        _divided(_op("^", _op("+", _Y, 1.0), _op("*", 100.0, _X)), 1e300),
        ((1000, 0), (5, 1e6), (710, 0)),
    ),
    "beyond_numbers": (
        _op("+", _op("-", _op("*", 1e308, _X), _op("*", 1e308, _X)), 0.5),
        _divided(_op("+", _op("*", _Y, _Y), _op("*", _Y, 1e307)), 1e308),
        ((10, 2), (1, 100), (1, -1e200)),
    ),
}
"""Cases by name: two predicates, and pairs of values of x and y at which one of the predicates has no value."""


def _rejected_case(name: str) -> ConformanceCase:
    first, second, samples = _REJECTED[name]
    fspa = _two_atom_case(name, first, second).fspa
    columns = [signal.name for signal in fspa.signals]
    before = [(1, 2), (1.5, 2.5)]
    after = [(1, 2)]
    traces = [table(columns, [*before, sample, *after]) for sample in samples]
    return ConformanceCase(fspa, f"Predicates without a value: {name.replace('_', ' ')}.", tuple(traces))


def _nested_when(inside: Literal["value", "otherwise", "condition"]) -> Expression:
    """Return nested ``when`` expressions, 96 operators deep.

    ``inside`` is the part of each ``when`` that contains the next one.
    """
    node: Expression = Const(0.5)
    for level in range(48 if inside == "condition" else 96):
        reached, value = _condition(">", _X, level / 100 - 0.5), level / 1000 - 0.5
        if inside == "value":
            node = _when(reached, node, value)
        elif inside == "otherwise":
            node = _when(reached, value, node)
        else:
            node = _when(_condition(">", node, 0.01 * (level % 7)), value, 0.3)
    return node


def _long_when() -> Expression:
    """Return a ``when`` expression with 160 cases.

    In some languages, each of its conditions needs a statement of its own.
    """
    near = ((_condition("<", _op("^", _op("-", _Y, at / 80 - 1.0), 2.0), 1e-4), Const(at / 160)) for at in range(160))
    return When(tuple(near), Const(-0.25))


def _branching_case(name: str) -> ConformanceCase:
    first, second = {
        "deep_values": (_nested_when("value"), _nested_when("otherwise")),
        "deep_conditions": (_nested_when("condition"), _long_when()),
    }[name]
    fspa = _two_atom_case(name, first, second).fspa
    columns = [signal.name for signal in fspa.signals]
    samples = [[-0.6 + step / 20, -1.0 + step / 16][: len(columns)] for step in range(32)]
    traces = tuple(table(columns, samples[at:]) for at in (0, 10, 20))
    return ConformanceCase(fspa, f"Branches inside branches: {name.replace('_', ' ')}.", traces)


CASES: Final[CaseBuilders] = {
    **{name: partial(_function_case, number, name) for number, name in enumerate(_EXPRESSIONS)},
    **{name: partial(_rejected_case, name) for name in _REJECTED},
    **{name: partial(_branching_case, name) for name in ("deep_values", "deep_conditions")},
}
