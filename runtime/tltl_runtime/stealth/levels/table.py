"""Typed reading of a table of a level file: what is missing, of another kind or out of range becomes a diagnostic."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from difflib import get_close_matches
from typing import Any, Final, TypeVar

from tltl_runtime.stealth.level import Point
from tltl_runtime.stealth.levels.toml_tree import Entry, Tree
from tltlc.core.record import EMPTY
from tltlc.diagnostics.diagnostic import Diagnostic, Label

T = TypeVar("T")

REQUIRED: Final[Any] = object()
"""In place of a default: the key must be there."""

MOST_SUGGESTIONS: Final = 100
"""At most this many diagnostics of a file look for names that are alike, which takes long for thousands."""

_LONGEST: Final = 100
"""Longer names, in characters, are like no other."""

FARTHEST: Final = 1000.0
"""No coordinate is further from the origin, in metres."""


class Table:
    """One table, read key by key; ``log`` takes what is wrong, and a stand-in is returned for it.

    ``what`` is what messages call the table.  Call :meth:`done` at the end: it reports keys that nobody asked for.
    """

    def __init__(self, entry: Entry, what: str, log: list[Diagnostic]) -> None:
        self.entries: Tree = entry.value if isinstance(entry.value, dict) else {}
        self.label = entry.label
        self.what = what
        self.log = log
        self._asked: list[str] = []

    def number(
        self, key: str, default: float = REQUIRED, *, low: float = -FARTHEST, high: float = FARTHEST, unit: str = "m"
    ) -> float:
        """A finite number in [low, high]; ``unit`` is for the message."""
        expected = f"a number from {low:g} to {high:g} {unit}".rstrip()
        return self._read(key, default, expected, lambda value: _is_number(value) and low <= value <= high, low, float)

    def whole(self, key: str, default: int = REQUIRED, *, low: int, high: int) -> int:
        """A whole number in [low, high]."""
        expected = f"a whole number from {low} to {high}"
        return self._read(key, default, expected, lambda v: type(v) is int and low <= v <= high, low, int)

    def text(self, key: str, default: str = REQUIRED, one_of: tuple[str, ...] = ()) -> str:
        """A text that is not empty, where ``one_of`` is given one of those."""
        expected = "one of " + ", ".join(f'"{word}"' for word in one_of) if one_of else "a text"
        good = lambda value: isinstance(value, str) and bool(value) and (not one_of or value in one_of)  # noqa: E731
        return self._read(key, default, expected, good, "", str)

    def flag(self, key: str) -> bool:
        """True or false, false where it is missing."""
        return self._read(key, False, "true or false", lambda value: isinstance(value, bool), False, bool)

    def names(self, key: str, default: tuple[str, ...] = REQUIRED) -> tuple[str, ...]:
        """A list of texts."""
        good = lambda value: isinstance(value, list) and all(isinstance(item, str) for item in value)  # noqa: E731
        return self._read(key, default, 'a list of names, e.g. ["s1", "s2"]', good, (), tuple)

    def point(self, key: str, default: Point = REQUIRED) -> Point:
        """Three finite coordinates in metres: [x, y, z]."""
        return self._read(key, default, "a point [x, y, z] in metres", _is_point, (0.0, 0.0, 0.0), _point)

    def size(self) -> Point:
        """The key ``size``: three lengths in metres, each at least a centimetre."""
        good = lambda value: _is_point(value) and min(value) >= 0.01  # noqa: E731
        return self._read("size", REQUIRED, "three lengths [x, y, z] of at least 0.01 m", good, (1.0, 1.0, 1.0), _point)

    def points(self, key: str, least: int) -> tuple[Point, ...]:
        """A list of ``least`` points or more."""
        good = lambda value: isinstance(value, list) and len(value) >= least and all(map(_is_point, value))  # noqa: E731
        convert = lambda value: tuple(map(_point, value))  # noqa: E731
        return self._read(key, REQUIRED, f"a list of {least} or more points [x, y, z] in metres", good, (), convert)

    def table(self, key: str, *, needed: bool = True) -> Table | None:
        """A table of this one; None where it is missing or is none."""
        entry = self.entries.get(key)
        found = self._read(key, REQUIRED if needed else {}, "a table", lambda v: isinstance(v, dict), None, lambda v: v)
        return Table(entry, f"`[{key}]`", self.log) if entry is not None and found is not None else None

    def tables(self, key: str) -> list[Table]:
        """A list of tables, empty where it is missing."""
        self._asked.append(key)
        entry = self.entries.get(key)
        if entry is None:
            return []
        if not isinstance(entry.value, list) or not all(isinstance(item, Entry) for item in entry.value):
            self.log.append(wrong(entry, key, f"tables, each under a line `[[{key}]]`"))
            return []
        return [Table(item, f"`[[{key}]]`", self.log) for item in entry.value]

    def place(self, key: str) -> Label:
        """Where a key stands; the table's header where it is missing."""
        return self.entries[key].label if key in self.entries else self.label

    def done(self, elsewhere: Mapping[str, str] = EMPTY) -> None:
        """Report the keys that nobody asked for (TLT0802); ``elsewhere`` says of what else some of them are keys."""
        asked = dict.fromkeys(self._asked)
        for key, entry in self.entries.items():
            if key not in asked:
                way_out = suggestion(key, asked) if len(self.log) < MOST_SUGGESTIONS else None
                help_ = f"it is a key of `{elsewhere[key]}`" if key in elsewhere else way_out
                self.log.append(Diagnostic("TLT0802", f"{self.what} has no key `{key}`", (entry.label,), help_))

    def _read(
        self, key: str, default: Any, expected: str, good: Callable[[Any], bool], stand_in: T, made: Callable[[Any], T]
    ) -> T:
        self._asked.append(key)
        entry = self.entries.get(key)
        if entry is None:
            if default is REQUIRED:
                title = f"{self.what} lacks `{key}`"
                self.log.append(Diagnostic("TLT0803", title, (self.label,), f"give `{key}`: {expected}"))
                return stand_in
            return default  # type: ignore[no-any-return]
        if not good(entry.value):
            self.log.append(wrong(entry, key, expected))
            return stand_in
        return made(entry.value)


def wrong(entry: Entry, key: str, expected: str) -> Diagnostic:
    """TLT0803: a value of the wrong kind, or out of its range."""
    help_ = f"expected {expected}"
    if "[x, y, z]" in expected and _has_decimal_commas(entry.value):
        help_ += "; these are six numbers: decimals have a point, as in 6.5"
    return Diagnostic("TLT0803", f"wrong value for `{key}`: {_shown(entry.value)}", (entry.label,), help_)


def suggestion(name: str, known: Iterable[str], listed: str | None = None) -> str:
    """A way out for a name that is none of ``known``; ``listed`` stands for the list of them where that is long."""
    names = list(known)
    close = get_close_matches(name, names, n=1) if len(name) <= _LONGEST else []
    close = close or [known for known in names if known.lower() == name.lower()]
    if close:
        return f"did you mean `{close[0]}`?"
    if listed is not None:
        return f"there are: {listed}"
    return "there are: " + ", ".join(f"`{known}`" for known in names) if names else "there are none"


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _is_point(value: object) -> bool:
    return (
        isinstance(value, list)
        and len(value) == 3
        and all(_is_number(item) and abs(item) <= FARTHEST for item in value)
    )


def _has_decimal_commas(value: object) -> bool:
    """Whether it looks like a point whose three numbers have a comma for a point: whole numbers, twice as many."""
    return isinstance(value, list) and len(value) == 6 and all(type(item) is int for item in value)


def _point(value: list[float]) -> Point:
    x, y, z = (float(item) for item in value)
    return (x, y, z)


def _shown(value: object) -> str:
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
