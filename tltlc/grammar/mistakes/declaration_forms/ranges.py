"""Read ranges and lists of values in other forms: ``0..30``, ``from 0 to 100``, ``{calm, alarmed}``, ``a | b``."""

from __future__ import annotations

import re
from typing import Final

from tltlc.grammar.mistakes.declaration_forms.meant import MISSING_ENDS, Cursor

_OPENING: Final = {"[": (")", "]"), "(": (")", "]"), "{": ("}",), "[]": ()}
_SIGNS: Final = ("..", "...", ",", "to", "-", "–", "—", ":", ";", "and", "…")
_PREFIXES: Final = ("in", "from", "between", "range", "ranging", "within")
_BOUNDS: Final = {">=": 0, ">": 0, "≥": 0, "<=": 1, "<": 1, "≤": 1}
"""Maps the sign before one end of a range to the index of this end."""
_UNITS: Final = {
    **dict.fromkeys(("m", "cm", "km"), "length"),
    **dict.fromkeys(("s", "ms", "min", "h"), "time"),
    **dict.fromkeys(("m/s", "km/h"), "speed"),
    **dict.fromkeys(("deg", "rad"), "angle"),
    "%": "ratio",
}
"""Maps each unit to the type of its values."""
UNIT_OF_TYPE: Final = {"length": " m", "time": " s", "speed": " m/s", "angle": " rad", "ratio": ""}
_WORD_UNITS: Final = {"meters": "m", "metres": "m", "seconds": "s", "sec": "s", "degrees": "deg", "percent": "%"}

_TYPE_WORDS: Final = frozenset("int integer uint float double number real bool ratio time length speed angle".split())
"""Words behind a range that are no units."""

Range = tuple[str, str, str]
"""The two ends of a range as they should be written, and the type of values with their unit, or empty."""


def read_range(cursor: Cursor) -> Range | None:
    """Read a range; return None, with the cursor where it was, if there is none.

    A range is two numbers with a sign or word between them, perhaps in brackets, and a unit that may
    stand once after both.
    """
    start = cursor.at
    ends = _two_ends(cursor) or _least_and_greatest(cursor)
    if ends is None:
        cursor.at = start
    return ends


def _two_ends(cursor: Cursor) -> Range | None:
    while cursor.accept(*_PREFIXES):
        pass
    opening = cursor.token.text if cursor.token.text in _OPENING else ""
    cursor.at += bool(opening)
    low = _end(cursor)
    _skip_foreign_unit(cursor, is_inside=bool(opening))
    if low is None or not _separator(cursor):
        return None
    high = _end(cursor)
    _skip_foreign_unit(cursor, is_inside=bool(opening))
    if high is None or (opening and not cursor.accept(*_OPENING[opening])):
        return None
    unit = low[1] or high[1] or (_unit(cursor) if opening else "")
    _skip_foreign_unit(cursor, is_inside=bool(opening))
    ends = tuple(f"{number} {unit}" if unit and number not in ("inf", "-inf") else number for number, _ in (low, high))
    if {low[1], high[1]} - {"", unit}:
        ends = tuple(f"{number} {own}".strip() for number, own in (low, high))
    return _in_order(ends[0], ends[1], low[0], high[0], _UNITS.get(unit, ""))


def _least_and_greatest(cursor: Cursor) -> Range | None:
    """Read ``min 0 max 100`` or ``min=0, max=100``, perhaps in brackets."""
    opening = cursor.accept("(")
    ends: list[tuple[str, str]] = []
    for words in (("min", "minimum", "least"), ("max", "maximum", "most")):
        if not cursor.accept(*words):
            return None
        cursor.accept("=", ":")
        end = _end(cursor)
        if end is None:
            return None
        ends.append(end)
        cursor.accept(",")
    if opening and not cursor.accept(")"):
        return None
    low, high = (f"{number} {unit}".strip() for number, unit in ends)
    return _in_order(low, high, ends[0][0], ends[1][0], _UNITS.get(ends[0][1] or ends[1][1], ""))


def read_bounds(cursor: Cursor, *, is_whole: bool) -> Range | None:
    """Read ``>= 0``, ``< 5 m`` or ``>= 0 and <= 100``; return None, with the cursor where it was, if there is none.

    An end that is not written is LOW or HIGH. Whole numbers ``> 0`` begin at 1.
    """
    start = cursor.at
    ends = list(MISSING_ENDS)
    numbers = ["-inf", "inf"]
    types: list[str] = []
    while (sign := cursor.token.text) in _BOUNDS:
        cursor.at += 1
        end, side = _end(cursor), _BOUNDS[sign]
        if end is None or ends[side] != MISSING_ENDS[side]:
            break
        number, unit = end
        if is_whole and sign in ("<", ">") and number.lstrip("-").isdecimal():
            number = str(int(number) + (1 if sign == ">" else -1))
        ends[side], numbers[side] = f"{number} {unit}".strip(), number
        types.append(_UNITS.get(unit, ""))
        cursor.accept("and", "&", "&&", ",")
    low, high = ends
    is_range = bool(types) and len(set(types)) == 1
    found = _in_order(low, high, numbers[0], numbers[1], types[0]) if is_range else None
    if found is None:
        cursor.at = start
    return found


def _in_order(low: str, high: str, least: str, greatest: str, type_: str) -> Range | None:
    """Return a range, or None if its first end is not below its second one."""
    return (low, high, type_) if float(least) < float(greatest) or least == "-inf" else None


def _end(cursor: Cursor) -> tuple[str, str] | None:
    """Read one end of a range, and return its number and its unit."""
    sign = "-" if cursor.accept("-", "−") else ""
    if not sign:
        cursor.accept("+")
    if cursor.accept("inf", "infinity", "∞"):
        return f"{sign}inf", ""
    if cursor.token.type != "NUMBER":
        return None
    number = cursor.token.text
    cursor.at += 1
    return f"{sign}{number}", _unit(cursor)


def _unit(cursor: Cursor) -> str:
    """Read a unit, and return it as it is written in the language; empty if there is none."""
    for length in (3, 1):
        text = "".join(cursor.peek(distance).text for distance in range(length)).lower()
        text = _WORD_UNITS.get(text, text)
        if text in _UNITS:
            cursor.at += length
            return text
    return ""


def _skip_foreign_unit(cursor: Cursor, *, is_inside: bool) -> None:
    """Skip a unit that the language does not know, as in ``[0 kg, 5 kg]`` and ``[0, 5] coins``."""
    token = cursor.token
    if is_inside and token.type == "NAME" and token.text not in (*_SIGNS, *_TYPE_WORDS):
        cursor.at += 1


def read_unit_as_type(cursor: Cursor) -> tuple[str, str]:
    """Read the unit that stands where a type should, as in ``signal speed: m/s``; return its type and the unit.

    Both are empty if there is none; a list of values may begin with a name such as ``m``.
    """
    start, unit = cursor.at, _unit(cursor)
    if cursor.token.text in ("|", ",", "/", "or"):
        cursor.at, unit = start, ""
    return _UNITS.get(unit, ""), unit


def _separator(cursor: Cursor) -> bool:
    """Read what stands between the ends of a range; return whether it is there."""
    dots = 0
    while cursor.accept("."):
        dots += 1
    if dots:
        cursor.accept("<", "=")
        return dots > 1
    return cursor.accept(*_SIGNS)


def read_values(cursor: Cursor) -> tuple[str, ...] | None:
    """Read the values of an enum; return None, with the cursor where it was, if there is no list of names.

    Examples are ``{calm, alarmed}``, ``enum(a, b)``, ``one of a, b``, ``in [a, b, c]`` and ``"a" | "b"``.
    """
    start = cursor.at
    is_named = cursor.accept("enum", "enumeration", "choice", "choices") or cursor.accept_words("one", "of")
    cursor.accept("in", "of", ":", "=")
    values = _values(cursor)
    if values is None or (len(values) < 2 and not is_named) or len(set(values)) < len(values):
        cursor.at = start
        return None
    return values


def _values(cursor: Cursor) -> tuple[str, ...] | None:
    opening = cursor.token.text if cursor.token.text in ("[", "(", "{") else ""
    cursor.at += bool(opening)
    values: list[str] = []
    while True:
        name = _value(cursor)
        if name is None:
            return None
        values.append(name)
        if cursor.accept("=", ":") and not cursor.accept(str(len(values) - 1)):
            return None
        is_separated = cursor.accept(",", "|", "/", ";", "or")
        cursor.accept("or", "and")
        if opening and cursor.accept(*_OPENING[opening]):
            return tuple(values)
        if not is_separated or cursor.is_done:
            return None if opening else tuple(values)


def _value(cursor: Cursor) -> str | None:
    """Read one value, and return its name."""
    token = cursor.token
    quotes = token.text if token.text in ("'", "`") else ""
    if quotes:
        cursor.at += 1
        token = cursor.token
    if token.type not in ("NAME", "STRING"):
        return None
    cursor.at += 1
    if quotes and not cursor.accept(quotes):
        return None
    return name_for(token.text)


def name_for(text: str) -> str | None:
    """Return a text, perhaps in quotes, as a name of the language; None if it has no letter."""
    name = re.sub("[^A-Za-z0-9_]+", "_", text.strip('"')).strip("_")
    return (f"_{name}" if name[:1].isdigit() else name) or None


def whole_values(cursor: Cursor) -> Range | None:
    """Read a list of consecutive whole numbers such as ``{0, 1, 2}``; return the range that it covers."""
    start = cursor.at
    cursor.accept("in")
    opening = cursor.token.text if cursor.token.text in ("[", "(", "{") else ""
    cursor.at += 1
    numbers: list[int] = []
    while opening and cursor.token.type == "NUMBER" and cursor.token.text.isdecimal():
        numbers.append(int(cursor.token.text))
        cursor.at += 1
        if not cursor.accept(","):
            break
    is_run = len(numbers) > 2 and numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    if is_run and cursor.accept(*_OPENING[opening]):
        return str(numbers[0]), str(numbers[-1]), "int"
    cursor.at = start
    return None
