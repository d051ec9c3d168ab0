"""What people write out of habit, from other languages or from plain English, and how it is written here."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.lexer import Token
from tltlc.grammar.place import Place, shown
from tltlc.grammar.words import CLAUSES
from tltlc.source import Span

SYNONYMS: Final[dict[str, dict[str, str]]] = {
    "declaration": {
        "include": "import",
        "use": "import",
        "input": "signal",
        "var": "signal",
        "variable": "signal",
        "object": "entity",
        "objects": "entity",
        "const": "param",
        "constant": "param",
        "function": "predicate",
        "def": "let",
        "define": "let",
        "goal": "spec",
        "plan": "spec",
    },
    "clause": {
        "goal": "reach",
        "get": "reach",
        "maintain": "keep",
        "stay": "keep",
        "never": "avoid",
        "forbid": "avoid",
        "must": "require",
        "ensure": "require",
    },
    "test_item": {"assert": "expect"},
}
"""What keywords are called elsewhere, by kind of piece."""

_ENGLISH: Final = {
    "if": "if a, then b, is written `a implies b`",
    "before": "a before b is written `a then b`",
    "after": "b after a is written `a then b`",
    "unless": "a unless b is written `a weak_until b`",
    "xor": "either a or b is written `not (a iff b)`",
}
_UNITS: Final = {
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("mins", "minute", "minutes"), "min"),
    **dict.fromkeys(("hour", "hours"), "h"),
    **dict.fromkeys(("degree", "degrees"), "deg"),
    **dict.fromkeys(("frame", "frames", "tick", "ticks", "turn", "turns"), "steps"),
    **dict.fromkeys(("percent", "pct"), "%"),
    "hz": "Hz",
}
_NAME: Final = re.compile("[A-Za-z_][A-Za-z0-9_]*")
_ARROWS: Final = {"=>": "write `a implies b` or `a -> b`", "=<": "write `<=`"}


def _arrow(place: Place) -> Diagnostic | None:
    """``a => b`` and ``a =< b``."""
    after = place.tokens[place.stop.index + 1 :][:1]
    if place.found.type != "EQUAL" or not place.wants_operator or not after or not _touch(place.found, after[0]):
        return None
    sign = "=" + after[0].text
    if sign not in _ARROWS:
        return None
    span = Span(place.found.span.start, after[0].span.end)
    return place.error("TLT0104", f"`{sign}` means nothing here", _ARROWS[sign], span=span)


def _long_unit(place: Place) -> Diagnostic | None:
    """``20 seconds``."""
    unit = _UNITS.get(place.found.text.lower())
    if unit is None or not place.before or place.before.type != "NUMBER":
        return None
    title = f"there is no unit {shown(place.found)}"
    return place.error("TLT0111", title, None, f"write `{place.before.text} {unit}`")


def _joined_clauses(place: Place) -> Diagnostic | None:
    """``keep a and keep b``."""
    if place.start != "clause" or place.found.text not in CLAUSES or not place.before or place.before.type != "AND":
        return None
    title = f"clauses are not joined by {shown(place.before)}"
    return place.error("TLT0101", title, "leave it out: all clauses count", span=place.before.span)


def _quoted_name(place: Place) -> Diagnostic | None:
    """``near("door")``."""
    name = place.found.text.strip('"')
    if place.found.type != "STRING" or "NAME" not in place.allowed or not _NAME.fullmatch(name):
        return None
    return place.error("TLT0101", place.expectation(), f"names stand without quotes: `{name}`")


def _hyphen(place: Place) -> Diagnostic | None:
    """``my-door``, where no difference can stand."""
    before, after = place.before, place.tokens[place.stop.index + 1 :][:1]
    if (
        place.found.text != "-"
        or before is None
        or not after
        or before.type != "NAME"
        or not _NAME.fullmatch(after[0].text)
    ):
        return None
    if not _touch(before, place.found) or not _touch(place.found, after[0]):
        return None
    help_ = f"names are ASCII letters, digits and `_`: write `{before.text}_{after[0].text}`"
    span = Span(before.span.start, after[0].span.end)
    return place.error("TLT0104", f"`{before.text}-{after[0].text}` is no name", help_, span=span)


def _plain_english(place: Place) -> Diagnostic | None:
    """``if a then b`` and ``a before b``."""
    token = place.before if place.before and place.before.text == "if" else place.found
    if token.type != "NAME" or token.text not in _ENGLISH or not place.wants_operator:
        return None
    help_ = _ENGLISH[token.text]
    if token.text == "if" and place.tokens[0].type == "PREDICATE":
        help_ = "cases are written `when x > 3: 1 otherwise: -1`"
    return place.error("TLT0101", f"{shown(token)} is no operator", help_, span=token.span)


def _touch(left: Token, right: Token) -> bool:
    """Whether two tokens stand side by side, without a blank."""
    return left.span.end == right.span.start


HABITS: Final[tuple[Callable[[Place], Diagnostic | None], ...]] = (
    _arrow,
    _long_unit,
    _joined_clauses,
    _quoted_name,
    _hyphen,
    _plain_english,
)
