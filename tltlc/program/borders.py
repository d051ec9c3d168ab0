"""Find the number above which an expression is above 0, so that a test compares a variable instead.

``(waiting - 300.5) / 300.5 > 0`` becomes ``waiting > 300.5``. The test is the same for every value of the
variable, since rounding keeps the order of numbers: the border is the last double at which the rounded
expression is not above 0.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from typing import Final

from tltlc.program.bounds import ValueRange
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

_MAGNITUDE: Final = 2**63 - 1


def border_test(node: ProgramExpression, ranges: Mapping[str, ValueRange]) -> ProgramExpression | None:
    """Return a comparison of a variable with a constant that is true where ``node`` is above 0.

    Return None unless ``node`` is a variable in ``ranges`` to which operations with constants are applied that
    keep or reverse the order of numbers. ``ranges`` has the ranges of variables, whose values are finite.
    """
    path = _path(node)
    if path is None or isinstance(node, ProgramVariable) or path[0] not in ranges:
        return None
    name, increasing = path
    range_ = ranges[name]
    # From the end at which the expression is least.
    first, last = (range_.low, range_.high) if increasing else (range_.high, range_.low)
    if _value(node, first) > 0.0:
        return Bool(True)
    if not _value(node, last) > 0.0:
        return Bool(False)
    before, after = _border(first, last, lambda number: _value(node, number) > 0.0)
    strict = len(repr(before)) <= len(repr(after))
    limit = Real(before if strict else after)
    if increasing:
        return Compare(">" if strict else ">=", ProgramVariable(name), limit)
    return Compare("<" if strict else "<=", ProgramVariable(name), limit)


def _path(node: ProgramExpression) -> tuple[str, bool] | None:
    """Return the variable of an expression with one variable, and whether the expression grows with it.

    Return None for expressions that need not grow or fall with their variable, or are not numbers for all its values.
    """
    match node:
        case ProgramVariable(name):
            return name, True
        case Negate(operand):
            return _turned(_path(operand), True)
        case BinaryNumber("+", operand, Real()) | BinaryNumber("+" | "-", Real(), operand):
            return _turned(_path(operand), node.op == "-")
        case BinaryNumber("-", operand, Real()):
            return _path(operand)
        case BinaryNumber("*" | "/", operand, Real(factor)) | BinaryNumber("*", Real(factor), operand) if factor:
            return _turned(_path(operand), factor < 0.0)
        case NumericCall("min" | "max", (Real(), operand) | (operand, Real())):
            return _path(operand)
    return None


def _turned(path: tuple[str, bool] | None, turns: bool) -> tuple[str, bool] | None:
    return path and (path[0], path[1] != turns)


def _value(node: ProgramExpression, number: float) -> float:
    """Return the value of an expression of :func:`_path` if its variable is ``number``; it may be infinite."""
    match node:
        case ProgramVariable():
            return number
        case Real(value):
            return value
        case Negate(operand):
            return -_value(operand, number)
        case NumericCall(function, (left, right)):
            first, second = _value(left, number), _value(right, number)
            return min(first, second) if function == "min" else max(first, second)
        case BinaryNumber(op, left, right):
            first, second = _value(left, number), _value(right, number)
            return _OPERATIONS[op](first, second)
    raise TypeError(f"not an operation with constants: {node!r}")


_OPERATIONS: Final[Mapping[str, Callable[[float, float], float]]] = {
    "+": lambda left, right: left + right,
    "-": lambda left, right: left - right,
    "*": lambda left, right: left * right,
    "/": lambda left, right: left / right,
}


def _border(first: float, last: float, is_true: Callable[[float], bool]) -> tuple[float, float]:
    """Return two doubles next to each other between ``first``, for which a test is false, and ``last``, for which not.

    The test is false for the first one of the two, and true for the second one.
    """
    false, true = _place(first), _place(last)
    while abs(true - false) > 1:
        middle = (false + true) // 2
        if is_true(_at(middle)):
            true = middle
        else:
            false = middle
    return _at(false), _at(true)


def _place(number: float) -> int:
    """Return the place of a finite double among all doubles in ascending order; that of 0 is 0."""
    (bits,) = struct.unpack("<q", struct.pack("<d", number))
    return int(bits) if bits >= 0 else -int(bits & _MAGNITUDE)


def _at(place: int) -> float:
    """Return the double at a place."""
    (magnitude,) = struct.unpack("<d", struct.pack("<q", abs(place)))
    return float(magnitude) if place >= 0 else -float(magnitude)
