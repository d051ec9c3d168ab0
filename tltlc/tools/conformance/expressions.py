"""Random predicates with every operator and function."""

from __future__ import annotations

from typing import Final

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
from tltlc.resolve import spec
from tltlc.tools.conformance.draw import Draw

SIGNALS: Final = (
    spec.Signal("x", "number", -2.0, 3.0),
    spec.Signal("distance(s1, s2)", "length", 0.0, None),
    spec.Signal("speed", "speed", None, None),
    spec.Signal("seen", "bool", 0.0, 1.0),
)
PARAMS: Final = (
    spec.Param("size", "length", 20.0, 2.0, 10_000.0),
    spec.Param("gain", "number", -0.75, None, None),
)

_BINARY: Final[tuple[ArithmeticOp, ...]] = ("+", "-", "*", "/", "min", "max")
_UNARY: Final[tuple[ArithmeticOp, ...]] = ("neg", "abs", "sqrt", "exp", "tanh")
_COMPARISONS: Final[tuple[ConditionOp, ...]] = ("<", "<=", ">", ">=")
_CONNECTIVES: Final[tuple[ConditionOp, ...]] = ("and", "or", "not")
_NUMBERS: Final = (-2.5, -1.0, -0.5, 0.0, 0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 10.0)
_EXPONENTS: Final = (2.0, 3.0, 0.5, -1.0, 1.5)


def predicate(draw: Draw) -> Expression:
    """Return a random expression over ``SIGNALS`` and ``PARAMS``.

    Most of its values are in [-1, 1], some positive and some negative.
    """
    inner = _expression(draw, 3)
    choice = draw.below(4)
    if choice == 0:
        return Op("clamp", (inner, Const(-1.0), Const(1.0)))
    if choice == 1:
        return Op("tanh", (inner,))
    if choice == 2:
        return Op("/", (inner, Op("+", (Const(1.0), Op("abs", (inner,))))))
    return Op("*", (Const(0.25), inner))


def _expression(draw: Draw, depth: int) -> Expression:
    if not depth or draw.chance(0.15):
        return _leaf(draw)
    choice = draw.below(8)
    if choice == 0:
        return Op(draw.choice(_UNARY), (_expression(draw, depth - 1),))
    if choice == 1:
        return Op("^", (_expression(draw, depth - 1), Const(draw.choice(_EXPONENTS))))
    if choice == 2:
        parts = tuple(_expression(draw, depth - 1) for _ in range(3))
        return Op(draw.choice(("clamp", "min", "max")), parts)
    if choice <= 4:
        cases = tuple((_condition(draw, depth - 1), _expression(draw, depth - 1)) for _ in range(1 + draw.below(2)))
        return When(cases, _expression(draw, depth - 1))
    return Op(draw.choice(_BINARY), (_expression(draw, depth - 1), _expression(draw, depth - 1)))


def _condition(draw: Draw, depth: int) -> Condition:
    if depth and draw.chance(0.5):
        op = draw.choice(_CONNECTIVES)
        count = 1 if op == "not" else 2 + draw.below(2)
        return Condition(op, tuple(_condition(draw, depth - 1) for _ in range(count)))
    return Condition(draw.choice(_COMPARISONS), (_expression(draw, max(0, depth - 1)), _leaf(draw)))


def _leaf(draw: Draw) -> Expression:
    if draw.chance(0.25):
        return Const(draw.choice(_NUMBERS))
    if draw.chance(0.2):
        return ParamValue(draw.choice(PARAMS).name)
    return SignalValue(draw.choice(SIGNALS).name)
