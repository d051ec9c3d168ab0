"""Dimensions, units and their names in messages."""

from __future__ import annotations

from math import pi
from typing import Final, NamedTuple, cast

from tltlc.resolve.spec import ValueType

Dimension = tuple[float, float, float]
"""The exponents of metre, second and radian: ``(1, -1, 0)`` for a speed."""

PLAIN: Final[Dimension] = (0.0, 0.0, 0.0)
_FREQUENCY: Final[Dimension] = (0.0, -1.0, 0.0)

TYPES: Final[dict[str, Dimension]] = {
    "number": PLAIN,
    "ratio": PLAIN,
    "length": (1.0, 0.0, 0.0),
    "time": (0.0, 1.0, 0.0),
    "speed": (1.0, -1.0, 0.0),
    "angle": (0.0, 0.0, 1.0),
    "int": PLAIN,
    "bool": PLAIN,
}

_UNITS: Final[dict[str, tuple[float, float, Dimension]]] = {
    "m": (1.0, 1.0, TYPES["length"]),
    "km": (1000.0, 1.0, TYPES["length"]),
    "cm": (1.0, 100.0, TYPES["length"]),
    "s": (1.0, 1.0, TYPES["time"]),
    "ms": (1.0, 1000.0, TYPES["time"]),
    "min": (60.0, 1.0, TYPES["time"]),
    "h": (3600.0, 1.0, TYPES["time"]),
    "rad": (1.0, 1.0, TYPES["angle"]),
    "deg": (pi, 180.0, TYPES["angle"]),
    "%": (1.0, 100.0, PLAIN),
    "Hz": (1.0, 1.0, _FREQUENCY),
}

_NAMES: Final[dict[Dimension, str]] = {
    PLAIN: "a number",
    TYPES["length"]: "a length",
    TYPES["time"]: "a time",
    TYPES["speed"]: "a speed",
    TYPES["angle"]: "an angle",
    _FREQUENCY: "a frequency",
}


class SiUnit(NamedTuple):
    """An SI unit: ``m``, or with a denominator ``m/s``."""

    numerator: str
    denominator: str | None = None

    def __str__(self) -> str:
        return self.numerator if self.denominator is None else f"{self.numerator}/{self.denominator}"


_SI: Final[dict[Dimension, SiUnit]] = {
    TYPES["length"]: SiUnit("m"),
    TYPES["time"]: SiUnit("s"),
    TYPES["speed"]: SiUnit("m", "s"),
    TYPES["angle"]: SiUnit("rad"),
    _FREQUENCY: SiUnit("Hz"),
}


def value_type(name: str) -> ValueType | None:
    """Return the type with this name, or None if the language has no such type."""
    return cast(ValueType, name) if name in TYPES else None


def type_of_unit(unit: str) -> str | None:
    """Return the type whose values have this unit, or None if there is no such type."""
    if unit == "%":
        return "ratio"
    dimension = _UNITS[unit][2] if unit in _UNITS else None
    return next((name for name, candidate in TYPES.items() if candidate == dimension), None)


def in_si(value: float, unit: str | None) -> tuple[float, Dimension] | None:
    """Return the value of a literal in SI units, and its dimension: 1000.0 and a length for ``1 km``.

    Returns None for an unknown unit, and for ``steps``, which count samples.
    """
    if unit is None:
        return value, PLAIN
    if unit not in _UNITS:
        return None
    numerator, denominator, dimension = _UNITS[unit]
    # Divide once, so that 29 % is the same number as 0.29.
    return value * numerator / denominator, dimension


def time_units() -> tuple[str, ...]:
    """Return the units of time that may follow the ``/`` of a speed."""
    return tuple(unit for unit, (_, _, dimension) in _UNITS.items() if dimension == TYPES["time"])


def si_unit(dimension: Dimension) -> SiUnit | None:
    """Return the SI unit of a dimension, such as ``m/s``; None for a plain number or an area."""
    return _SI.get(dimension)


def dimension_text(dimension: Dimension) -> str:
    """Return the dimension in words: ``a length``, or ``a quantity in m^2`` if it has no name."""
    if dimension in _NAMES:
        return _NAMES[dimension]
    return "a quantity in " + " ".join(
        unit if exponent == 1 else f"{unit}^{exponent:g}"
        for unit, exponent in zip(("m", "s", "rad"), dimension, strict=True)
        if exponent
    )


def product(left: Dimension | None, right: Dimension | None, sign: float = 1.0) -> Dimension | None:
    """Return the dimension of ``left * right``, or of ``left / right`` if ``sign`` is -1.

    Returns None, which fits any dimension, if one of the two is None.
    """
    if left is None or right is None:
        return None
    return (left[0] + sign * right[0], left[1] + sign * right[1], left[2] + sign * right[2])


def power(base: Dimension | None, exponent: float) -> Dimension | None:
    """Return the dimension of ``base ^ exponent``; None, which fits any dimension, if that of ``base`` is None."""
    return None if base is None else (base[0] * exponent, base[1] * exponent, base[2] * exponent)
