"""Number literals that every version of Godot reads as exactly the same double."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Final

_EXACT: Final = 2**53
_LARGEST_POWER: Final = 22
"""10 to this power is the largest power of ten that a double represents exactly."""
_MOST_DIGITS: Final = 18
"""The engine reads at most this many digits of a literal, leading zeros included."""
_LARGEST_DIVISOR: Final = 10_000


def number(value: float) -> str:
    """Return an expression whose value in Godot is exactly the given nonnegative number.

    Godot computes a literal from an integer and a power of ten. The result is exact only if doubles
    represent both exactly, which is usual up to 15 digits. For other numbers, the expression is a
    quotient, such as ``(10.0 / 11.0)``, or an integer times a power of two.
    """
    literal = repr(value)
    _, digits, exponent = Decimal(literal).as_tuple()
    assert isinstance(exponent, int), "a finite number"
    whole = int("".join(map(str, digits)))
    written = sum(character.isdigit() for character in literal.partition("e")[0])
    if whole < _EXACT and abs(exponent) <= _LARGEST_POWER and written <= _MOST_DIGITS:
        return literal
    approximation = Fraction(value).limit_denominator(_LARGEST_DIVISOR)
    if approximation.numerator < _EXACT and approximation.numerator / approximation.denominator == value:
        return f"({approximation.numerator}.0 / {approximation.denominator}.0)"
    factor, power = _split(value)
    return f"({factor} * pow(2.0, {power}.0))"


def signed_number(value: float) -> str:
    """Return an expression whose value in Godot is exactly the given number, which may be negative."""
    return f"-{number(-value)}" if repr(value)[0] == "-" else number(float(value))


def _split(value: float) -> tuple[int, int]:
    """Return the odd integer f and the exponent n with ``value == f * 2**n``."""
    factor, divisor = value.as_integer_ratio()
    power = 1 - divisor.bit_length()
    while factor % 2 == 0:
        factor, power = factor // 2, power + 1
    return factor, power
