"""Evaluate an expression for the signal values of one moment, in IEEE double precision.

The order of operations is fixed, since all programs that evaluate it must agree to the last bit.
Operands are computed from left to right. ``x ^ 2`` is ``x * x``, ``x ^ 3`` is ``x * x * x``, and
any other power is the C library's ``pow``. ``clamp(x, low, high)`` is ``min(max(x, low), high)``.
If operands are equal, ``min`` and ``max`` return the first one. The value of a case of a ``when``
is computed only if its condition is true.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import reduce
from operator import add, ge, gt, le, lt, mul, neg, sub, truediv
from typing import Any, Final

from tltlc.expression.tree import (
    AtomValue,
    Before,
    Condition,
    Const,
    Expression,
    ParamValue,
    SignalValue,
    StepLength,
    When,
    variable_key,
)

MULTIPLIED_EXPONENTS: Final = {2.0: 2, 3.0: 3}
"""Maps each constant exponent whose power is computed as a product to the number of factors."""


def evaluate(expression: Expression, signals: Mapping[Any, float], params: Mapping[str, float]) -> float:
    """Return the value of an expression, given the values of signals and params.

    ``signals`` and ``params`` map full names, such as ``distance(s1)``, to finite numbers in SI units.
    For the update of a register, ``signals`` also maps the nodes that read atoms, registers before the
    sample, and the length of the step (:data:`tltlc.expression.tree.VariableKey`).
    The result is infinite or NaN if a product, quotient or sum is too large for a float.

    Raises:
        ZeroDivisionError: a divisor is 0.
        OverflowError: ``exp`` or a power is too large.
        ValueError: a root or a power is not a real number.
        KeyError: a signal or param is missing.
    """
    if isinstance(expression, Const):
        return expression.value
    if isinstance(expression, (SignalValue, AtomValue, Before, StepLength)):
        return float(signals[variable_key(expression)])
    if isinstance(expression, ParamValue):
        return float(params[expression.name])
    if isinstance(expression, When):
        for condition, value in expression.cases:
            if _holds(condition, signals, params):
                return evaluate(value, signals, params)
        return evaluate(expression.otherwise, signals, params)
    if expression.op == "^" and isinstance(exponent := expression.args[1], Const):
        factors = MULTIPLIED_EXPONENTS.get(exponent.value)
        if factors is not None:
            base = evaluate(expression.args[0], signals, params)
            return math.prod([base] * (factors - 1), start=base)
    return _FUNCTIONS[expression.op](*[evaluate(argument, signals, params) for argument in expression.args])


def _holds(condition: Condition, signals: Mapping[Any, float], params: Mapping[str, float]) -> bool:
    if condition.op == "not":
        return not _part_holds(condition.args[0], signals, params)
    if condition.op == "and":
        return all(_part_holds(part, signals, params) for part in condition.args)
    if condition.op == "or":
        return any(_part_holds(part, signals, params) for part in condition.args)
    left, right = (_part_value(part, signals, params) for part in condition.args)
    return _COMPARISONS[condition.op](left, right)


def _part_holds(part: Expression | Condition, signals: Mapping[Any, float], params: Mapping[str, float]) -> bool:
    assert isinstance(part, Condition), "and, or, not take conditions"
    return _holds(part, signals, params)


def _part_value(part: Expression | Condition, signals: Mapping[Any, float], params: Mapping[str, float]) -> float:
    assert not isinstance(part, Condition), "comparisons take expressions"
    return evaluate(part, signals, params)


def _sum(*terms: float) -> float:
    return reduce(add, terms)


def _product(*factors: float) -> float:
    return reduce(mul, factors)


def _clamp(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


_FUNCTIONS: Final[dict[str, Callable[..., float]]] = {
    "+": _sum,
    "-": sub,
    "*": _product,
    "/": truediv,
    "^": math.pow,
    "neg": neg,
    "min": min,
    "max": max,
    "abs": abs,
    "clamp": _clamp,
    "sqrt": math.sqrt,
    "exp": math.exp,
    "tanh": math.tanh,
}

_COMPARISONS: Final[dict[str, Callable[[float, float], bool]]] = {"<": lt, "<=": le, ">": gt, ">=": ge}
