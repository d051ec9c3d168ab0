"""Read typed values from the tables of TOML files; a wrong value becomes a diagnostic."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, Final, TypeVar

from tltl_runtime.support.suggestion import MOST_SUGGESTIONS, similar_name, suggestion
from tltl_runtime.support.toml_tree import Entry, Tree
from tltlc.api import EMPTY, Diagnostic, Label

T = TypeVar("T")

Point = tuple[float, float, float]

REQUIRED: Final[Any] = object()
"""Sentinel in place of a default value. It means that the key is required."""

FARTHEST: Final = 1000.0
"""The greatest absolute value of a coordinate, in metres."""


class CheckedTable:
    """A TOML table whose keys are read one by one, each with a method for its type.

    If a required key is missing or a value is wrong, the method adds a diagnostic (TLT0803) to
    ``log`` and returns a stand-in, such as the least valid number, so that reading can go on. If an
    optional key is missing, the method returns ``default``. ``description`` is the name of the
    table in messages. After reading the last key, call :meth:`report_unknown_keys`.
    """

    def __init__(self, entry: Entry, description: str, log: list[Diagnostic]) -> None:
        self.entries: Tree = entry.value if isinstance(entry.value, dict) else {}
        self.label = entry.label
        self.description = description
        self.log = log
        self._read_keys: list[str] = []

    def number(
        self, key: str, default: float = REQUIRED, *, low: float = -FARTHEST, high: float = FARTHEST, unit: str = "m"
    ) -> float:
        """Read a finite number in [low, high]; ``unit`` is the name of its unit in messages."""
        expected = f"a number from {low:g} to {high:g} {unit}".rstrip()
        return self._read(key, default, expected, lambda value: _is_number(value) and low <= value <= high, low, float)

    def whole(self, key: str, default: int = REQUIRED, *, low: int, high: int) -> int:
        """Read a whole number in [low, high]."""
        expected = f"a whole number from {low} to {high}"
        return self._read(key, default, expected, lambda v: type(v) is int and low <= v <= high, low, int)

    def text(self, key: str, default: str = REQUIRED, one_of: tuple[str, ...] = ()) -> str:
        """Read a text that is not empty; if ``one_of`` is given, only its texts are valid."""
        entry = self.entries.get(key)
        expected = "a text" if entry is None or entry.value != "" else "a text that is not empty"
        if one_of:
            expected = "one of " + ", ".join(f'"{word}"' for word in one_of)
        is_valid = lambda value: isinstance(value, str) and bool(value) and (not one_of or value in one_of)  # noqa: E731
        return self._read(key, default, expected, is_valid, "", str)

    def flag(self, key: str) -> bool:
        """Read true or false; false if the key is missing."""
        return self._read(key, False, "true or false", lambda value: isinstance(value, bool), False, bool)

    def names(self, key: str, default: tuple[str, ...] = REQUIRED) -> tuple[str, ...]:
        """Read a list of texts."""
        is_valid = lambda value: isinstance(value, list) and all(isinstance(item, str) for item in value)  # noqa: E731
        return self._read(key, default, 'a list of names, e.g. ["s1", "s2"]', is_valid, (), tuple)

    def point(self, key: str, default: Point = REQUIRED) -> Point:
        """Read three finite coordinates in metres: [x, y, z]."""
        return self._read(key, default, "a point [x, y, z] in metres", _is_point, (0.0, 0.0, 0.0), _point)

    def size(self) -> Point:
        """Read the key ``size``: three lengths in metres, each at least a centimetre."""
        is_valid = lambda value: _is_point(value) and min(value) >= 0.01  # noqa: E731
        return self._read(
            "size", REQUIRED, "three lengths [x, y, z] of at least 0.01 m", is_valid, (1.0, 1.0, 1.0), _point
        )

    def points(self, key: str, least: int) -> tuple[Point, ...]:
        """Read a list of at least ``least`` points, each three finite coordinates in metres."""
        is_valid = lambda value: isinstance(value, list) and len(value) >= least and all(map(_is_point, value))  # noqa: E731
        convert = lambda value: tuple(map(_point, value))  # noqa: E731
        return self._read(key, REQUIRED, f"a list of {least} or more points [x, y, z] in metres", is_valid, (), convert)

    def table(self, key: str, *, needed: bool = True) -> CheckedTable | None:
        """Read a table; return None if the key is missing or its value is not a table.

        A missing key is an error only if ``needed``.
        """
        entry = self.entries.get(key)
        value = self._read(key, REQUIRED if needed else {}, "a table", lambda v: isinstance(v, dict), None, lambda v: v)
        return CheckedTable(entry, f"`[{key}]`", self.log) if entry is not None and value is not None else None

    def tables(self, key: str) -> list[CheckedTable]:
        """Read a list of tables; return an empty list if the key is missing or its value is wrong."""
        self._read_keys.append(key)
        entry = self.entries.get(key)
        if entry is None:
            return []
        if not isinstance(entry.value, list) or not all(isinstance(item, Entry) for item in entry.value):
            self.log.append(wrong_value(entry, key, f"tables, each under a line `[[{key}]]`"))
            return []
        return [CheckedTable(item, f"`[[{key}]]`", self.log) for item in entry.value]

    def label_of(self, key: str) -> Label:
        """Return the label (the place in the file) of a key, or of the table if the key is missing."""
        return self.entries[key].label if key in self.entries else self.label

    def report_unknown_keys(self, elsewhere: Mapping[str, str] = EMPTY) -> None:
        """Add a diagnostic (TLT0802) to ``log`` for each key that no method has read.

        ``elsewhere`` maps keys of other tables to the names of those tables. If this table has such
        a key, or a more similar one than this table, the help says to which table the key belongs.
        """
        known = dict.fromkeys(self._read_keys)
        for key, entry in self.entries.items():
            if key not in known:
                help_ = f"it is a key of `{elsewhere[key]}`" if key in elsewhere else self._hint(key, known, elsewhere)
                self.log.append(Diagnostic("TLT0802", f"{self.description} has no key `{key}`", (entry.label,), help_))

    def _hint(self, key: str, known: Mapping[str, Any], elsewhere: Mapping[str, str]) -> str | None:
        if len(self.log) >= MOST_SUGGESTIONS:
            return None
        close = similar_name(key, [*known, *elsewhere])
        if close is None or close in known:
            return suggestion(key, known)
        return f"did you mean `{close}`, a key of `{elsewhere[close]}`?"

    def _read(
        self,
        key: str,
        default: Any,
        expected: str,
        is_valid: Callable[[Any], bool],
        stand_in: T,
        convert: Callable[[Any], T],
    ) -> T:
        self._read_keys.append(key)
        entry = self.entries.get(key)
        if entry is None:
            if default is REQUIRED:
                title = f"{self.description} lacks `{key}`"
                self.log.append(Diagnostic("TLT0803", title, (self.label,), f"give `{key}`: {expected}"))
                return stand_in
            return default  # type: ignore[no-any-return]
        if not is_valid(entry.value):
            self.log.append(wrong_value(entry, key, expected))
            return stand_in
        return convert(entry.value)


def wrong_value(entry: Entry, key: str, expected: str) -> Diagnostic:
    """Return the diagnostic TLT0803 for a value that has a wrong type or is out of range.

    ``expected`` describes the valid values, such as ``a whole number from 1 to 9``.
    """
    help_ = f"expected {expected}"
    if "[x, y, z]" in expected and _has_decimal_commas(entry.value):
        help_ += "; these are six numbers: write decimals with a point, as in 6.5"
    return Diagnostic("TLT0803", f"wrong value for `{key}`: {_value_text(entry.value)}", (entry.label,), help_)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _is_point(value: object) -> bool:
    return (
        isinstance(value, list)
        and len(value) == 3
        and all(_is_number(item) and abs(item) <= FARTHEST for item in value)
    )


def _has_decimal_commas(value: object) -> bool:
    """Whether a list looks like a point written with decimal commas: ``[6,5, 2,0, 0,0]`` has six whole numbers."""
    return isinstance(value, list) and len(value) == 6 and all(type(item) is int for item in value)


def _point(value: list[float]) -> Point:
    x, y, z = (float(item) for item in value)
    return (x, y, z)


def _value_text(value: object) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return f"{value}"
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list):
        if value and isinstance(value[0], Entry):
            return "tables"
        if len(value) <= 6 and all(_is_number(item) for item in value):
            return f"[{', '.join(str(item) for item in value)}]"
        return "a list"
    return "a date or a time"
