"""Measure the two sides of a comparison: by how much it holds or fails, in its unit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory_phrases import Speaker
from tltlc.core.names import ComparisonName
from tltlc.core.record import record
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import Const, Expression, Op, ParamValue, SignalValue, nodes
from tltlc.resolve.spec import Register
from tltlc.resolve.units import PLAIN, TYPES, Dimension, power, product, si_unit

_MOST_DIGITS: Final = 17
"""The most significant digits of a number that is shown: with these, two different numbers never look alike."""


@record
class Measure:
    """The sides of a comparison at a sample, in SI units.

    ``quantity`` is the side that varies, such as ``abs(spin)`` or ``times(not seen)``, with conditions in words;
    if both vary, the left one. ``value`` is its value; None if both vary. ``gap`` is the difference between
    the two sides, at least 0. ``unit`` is the unit of both, such as ``m/s``; empty for a plain number.
    """

    quantity: str
    value: float | None
    gap: float
    unit: str

    @property
    def text(self) -> str | None:
        """The side that varies and its value: ``abs(spin) is 3.12 rad/s``; None if both sides vary."""
        return None if self.number is None else f"{self.quantity} is {self.number}"

    @property
    def number(self) -> str | None:
        """The value of the side that varies, with its unit; None if both sides vary.

        If three digits would round the value to the other number or past it, it has more.
        """
        if self.value is None:
            return None
        text, digits = short_number(self.value), 3
        while abs(float(text) - self.value) >= self.gap / 2 > 0 and digits < _MOST_DIGITS:
            digits += 1
            text = f"{self.value:.{digits}g}"
        return f"{text} {self.unit}".rstrip()


def measure(fspa: Fspa, atom: int, sample: Mapping[str, float]) -> Measure | None:
    """Measure an atom that compares two numbers, at a sample.

    ``atom`` is the index of the atom. ``sample`` has the values of the signals and registers at the
    sample, by name. Params have the values that they have in ``fspa``. Return None if the atom is no
    comparison, such as ``near(exit)``, or if its sides cannot be computed from ``sample``.
    """
    sides = _sides(fspa.atoms[atom].expression, fspa.atoms[atom].base)
    if sides is None:
        return None
    base = fspa.atoms[atom].base
    assert isinstance(base, ComparisonName), "only comparisons have sides"
    (left, right), quantity = sides, base.left
    if not _varies(left):
        left, right, quantity = right, left, base.right
    params = {param.name: param.value for param in fspa.params}
    try:
        values = evaluate(left, sample, params), evaluate(right, sample, params)
    except (ArithmeticError, KeyError, ValueError):
        return None
    unit = si_unit(_dimension(left, fspa) or _dimension(right, fspa) or PLAIN)
    quantity = Speaker(fspa).quantity_text(quantity) if fspa.registers else quantity
    return Measure(quantity, None if _varies(right) else values[0], abs(values[0] - values[1]), str(unit or ""))


def short_number(value: float) -> str:
    """Return a number with three significant digits, and with all digits before the point: ``3.12``, ``1235``."""
    return f"{value:.0f}" if 1000.0 <= abs(value) < 1e6 else f"{value + 0.0:.3g}"


def _sides(expression: Expression, name: str) -> tuple[Expression, Expression] | None:
    """Return the left and the right side of the atom called ``name``; None if it is no comparison.

    The expression of a comparison contains the difference of its sides, scaled to [-1, 1]; see
    :mod:`tltlc.resolve.margins`.
    """
    if not isinstance(name, ComparisonName):
        return None
    if name.operator in ("==", "is"):
        return _equal_sides(expression, name) if name.operator == "==" else None
    node = expression
    while isinstance(node, Op) and (node.op in ("min", "max") or (node.op == "/" and isinstance(node.args[1], Const))):
        node = node.args[0]
    if name.right == "0":
        # The difference is the left side alone. Other operators than a sign could belong to the scaling.
        side = node.args[0] if isinstance(node, Op) and node.op == "neg" else node
        return (side, Const(0.0)) if side == SignalValue(name.left) else None
    if not isinstance(node, Op) or node.op != "-":
        return None
    left, right = node.args if name.operator == ">" else node.args[::-1]
    # Where a range is too large for a float, the difference is that of the halves of the sides.
    return None if isinstance(right, Const) and right.value != _number(name.right) else (left, right)


def _equal_sides(expression: Expression, name: ComparisonName) -> tuple[Expression, Expression] | None:
    """Return the sides of an equality, whose expression contains the distance between them."""
    distance = next((node for node in nodes(expression) if isinstance(node, Op) and node.op == "abs"), None)
    if distance is None:
        return None
    (difference,) = distance.args
    if name.right == "0":
        return difference, Const(0.0)
    return (difference.args[0], difference.args[1]) if isinstance(difference, Op) and difference.op == "-" else None


def _varies(side: Expression) -> bool:
    return any(isinstance(node, SignalValue) for node in nodes(side))


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _dimension(expression: Expression, fspa: Fspa) -> Dimension | None:
    """Return the dimension of an expression; None if it fits any dimension, as that of a number does."""
    if isinstance(expression, SignalValue):
        registers = {register.name: register for register in fspa.registers}
        if expression.name in registers:
            return _dimension_of_register(registers[expression.name])
    if isinstance(expression, (SignalValue, ParamValue)):
        named = fspa.signals if isinstance(expression, SignalValue) else fspa.params
        return next((TYPES[item.type] for item in named if item.name == expression.name), None)
    if not isinstance(expression, Op):
        return None
    parts = [_dimension(part, fspa) for part in expression.args]
    if expression.op in ("*", "/"):
        return product(parts[0] or PLAIN, parts[1] or PLAIN, 1.0 if expression.op == "*" else -1.0)
    if expression.op in ("^", "sqrt"):
        exponent = Const(0.5) if expression.op == "sqrt" else expression.args[1]
        return power(parts[0], exponent.value) if isinstance(exponent, Const) else None
    return None if expression.op in ("exp", "tanh") else next(filter(None, parts), None)


def _dimension_of_register(register: Register) -> Dimension:
    # A time counts steps, which a comparison divides by the rate of the clock.
    unit = "s" if register.kind in ("time_since", "time_holding", "total_time", "total_time_since") else register.unit
    return next((dimension for dimension in TYPES.values() if str(si_unit(dimension) or "") == unit), PLAIN)
