"""What people write out of habit, from other languages or a word processor, and how it is written here."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, instead
from tltlc.grammar.keywords import UNITS_ELSEWHERE
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.fragments import is_first_on_line
from tltlc.grammar.mistakes.one_reading import clause_asked
from tltlc.grammar.mistakes.place import (
    ARITHMETIC,
    BEFORE_ONE,
    CLOSING,
    COMPARISONS,
    INFIX,
    OPENING,
    Place,
    outside,
    shown,
    touch,
)
from tltlc.grammar.mistakes.rephrasing import formula_start, formula_stop, reworded, span_of, written
from tltlc.grammar.tables import load

_VALUE: Final = {"NAME", "NUMBER", "UNIT", "TRUE", "FALSE", *ARITHMETIC} - COMPARISONS
_SAME, _OTHER = "{a} >= {b} and {a} <= {b}", "{a} < {b} or {a} > {b}"
_EQUAL: Final = {"==": _SAME, "=": _SAME, "!=": _OTHER, "<>": _OTHER}


def equality(place: Place) -> Diagnostic | None:
    """``a == b``, ``a != true``, ``a <> 3``, and ``a = b`` where a comparison was meant."""
    sign, at = place.found.text, place.stop.index
    expectation = place.tokens[0].text == "expect"
    if sign not in _EQUAL or not (place.found.type != "EQUAL" or place.wants_operator or expectation):
        return None
    title = f"`{sign}` does not compare here" if place.found.type != "EQUAL" else "`=` does not compare"
    if expectation:
        return place.error("TLT0110", title, "compare with `<`, `<=`, `>` or `>=`")
    start, stop = side(place.tokens, at, -1), side(place.tokens, at, 1)
    a, b = written(place, start, at), written(place, at + 1, stop)
    unequal, alike = _EQUAL[sign] == _OTHER, ""
    if b.lower() in ("true", "false"):
        text, reason = a if (b.lower() == "true") != unequal else f"not {a}", ": a `bool` signal is an atom by itself"
    else:
        text, reason = _EQUAL[sign].format(a=a, b=b), ""
        is_part = (start, stop) != (formula_start(place), formula_stop(place))
        text = f"({text})" if is_part else text
        if b in ("0", "1"):
            alike = a if (b == "1") != unequal else f"not {a}"
            reason = f", or `{alike}` where it is true or false"
        elif _is_atom(place, start, at) and _is_atom(place, at + 1, stop):
            alike = f"({a} iff {b})" if is_part or unequal else f"{a} iff {b}"
            alike = f"{'not ' * unequal}{alike}"
            reason = f", or `{alike}` where both are true or false"
    general = f"write `{_EQUAL[sign].format(a='a', b='b')}`; a `bool` signal is an atom by itself"
    found = reworded(place, start, stop, text, title, reason, "TLT0110") if a and b else None
    if found and found.fixes and alike:
        # A predicate can be compared as a number and as what holds or does not.
        found = replace(found, fixes=(*found.fixes, instead(place.source, span_of(place.tokens[start:stop]), alike)))
    return found or place.error("TLT0110", title, general)


def _is_atom(place: Place, start: int, stop: int) -> bool:
    """Whether some tokens are a name, with or without arguments."""
    kinds = [token.type for token in place.tokens[start:stop]]
    behind = outside(place.tokens, start + 1, stop)
    return kinds[:1] == ["NAME"] and all(place.tokens[index].type in ("LPAR", "RPAR") for index in behind)


def chained(place: Place) -> Diagnostic | None:
    """``a < b < c``, with as many comparisons as there are."""
    at = place.stop.index
    if place.found.type not in COMPARISONS or not place.wants_operator:
        return None
    middle, title = side(place.tokens, at, -1), "comparisons cannot be chained"
    start, stop = side(place.tokens, middle - 1, -1), side(place.tokens, at, 1)
    comparisons = [written(place, start, at), written(place, middle, stop)]
    while place.tokens[stop].type in COMPARISONS:
        middle, at, stop = at + 1, stop, side(place.tokens, stop, 1)
        comparisons.append(written(place, middle, stop))
    text = " and ".join(comparisons)
    if (start, stop) != (formula_start(place), formula_stop(place)):
        text = f"({text})"
    found = reworded(place, start, stop, text, title, code="TLT0110")
    return found or place.error("TLT0110", title, "write `a < b and b < c`")


def arrow(place: Place) -> Diagnostic | None:
    """``a => b`` and ``a =< b``."""
    at = place.stop.index
    after = place.tokens[at + 1 :][:2]
    if place.found.type != "EQUAL" or not place.wants_operator or not after or not touch(place.found, after[0]):
        return None
    sign = "=" + after[0].text
    if sign not in ("=>", "=<"):
        return None
    number = len(after) > 1 and after[1].type == "NUMBER"
    meant = "<=" if sign == "=<" else ">=" if number else "implies"
    help_ = f"write `{meant}`" + (" or `->`" if meant == "implies" else "")
    span = span_of(place.tokens[at : at + 2])
    # Between goals, an arrow may be one of their order.
    write = None if meant == "implies" and place.tokens[0].type == "REACH" else meant
    help_ = help_ if write else "write `then` for an order, `implies` for a condition"
    return place.error("TLT0104", f"`{sign}` means nothing here", help_, span=span, write=write)


def comment(place: Place) -> Diagnostic | None:
    """``-- a comment``, whose words may be read as far as they make a formula."""
    tokens, at = place.tokens, place.stop.index
    for index in range(min(at, len(tokens) - 2), -1, -1):
        first, second, behind = tokens[index], tokens[index + 1], tokens[index + 2 : index + 3]
        if first.text == second.text == "-" and touch(first, second):
            # `--3` is a number.
            if index < at and behind and touch(second, behind[0]):
                return None
            span = span_of([first, second])
            return place.error(
                "TLT0104", "`--` means nothing here", "write `//` before a comment", span=span, write="//"
            )
        if is_first_on_line(place.source, tokens, index):
            return None
    return None


def unit(place: Place) -> Diagnostic | None:
    """``20 seconds`` and ``3 feet``."""
    number, found = place.before, place.found
    if number is None or number.type != "NUMBER" or found.type != "NAME" or "UNIT" not in place.allowed:
        return None
    title = f"there is no unit {shown(found)}"
    known = UNITS_ELSEWHERE.get(found.text.lower())
    if known == "%":
        # Of something from 0 to 100 it is the number alone.
        help_ = (
            f"of a ratio, write `{number.text} %`, which is a hundredth of {number.text}; else `{number.text}` alone"
        )
        return place.error("TLT0111", title, help_)
    if known:
        text = f"{number.text} {known}"
        return place.error("TLT0111", title, None, f"write `{text}`", span_of([number, found]), write=text)
    is_call = place.tokens[place.stop.index + 1].type == "LPAR"
    if is_call or place.allowed == {"UNIT"} or is_first_on_line(place.source, place.tokens, place.stop.index):
        return None
    listed = ", ".join(f"`{each}`" for each in sorted(load().units))
    help_ = f"the units are {listed}; a signal is compared, as in `{found.text} >= {number.text}`"
    return place.error("TLT0111", title, help_)


def doubled(place: Place) -> Diagnostic | None:
    """``a and then b``, ``a then then b``."""
    before, found = place.before, place.found
    if before is None or before.type not in INFIX or found.type not in INFIX or not place.wants_operand:
        return None
    title = f"{shown(before)} and {shown(found)} stand side by side"
    word = found.text if (before.type, found.type) == ("AND", "THEN") else before.text
    # `keep a then b` asks for `b` after the last step, and `a or then b` may be about an order or a choice.
    is_order = found.type == "THEN" and before.type in ("AND", "IMPLIES")
    is_order = is_order and clause_asked(place, place.stop.index) != "keep"
    write = word if found.type == before.type or is_order else None
    help_ = f"write `{write}` alone" if write else "leave one of the two out"
    return place.error("TLT0101", title, help_, span=span_of([before, found]), write=write)


def prefix_between(place: Place) -> Diagnostic | None:
    """``reach a next b`` and ``keep a not b``."""
    found, keyword, behind = place.found, place.tokens[0].text, place.stop.index + 1
    last = behind + 1 >= len(place.tokens) or is_first_on_line(place.source, place.tokens, behind)
    if last and (keyword, found.type) in (("keep", "ALWAYS"), ("reach", "EVENTUALLY")):
        help_ = f"leave it out: `{keyword}` says so already"
        return place.error("TLT0101", f"{shown(found)} stands before a formula", help_)
    if last or found.type not in {*BEFORE_ONE, "ALL", "ANY"} or not place.wants_operator:
        return None
    goal = keyword == "reach" and found.type in ("NEXT", "EVENTUALLY")
    meant = "then" if goal else f"and {found.text}"
    title = f"{shown(found)} stands before one formula, not between two"
    # Beside another operator, `and` may take too little; `next` and `always` may follow `and`, `implies` or `then`.
    stops = outside(place.tokens, formula_start(place), formula_stop(place))
    is_clear = found.type == "NOT" and all(place.tokens[index].type not in INFIX - {"AND"} for index in stops)
    return place.error("TLT0101", title, f"write `{meant}`", write=meant if is_clear else None)


def side(tokens: Sequence[Token], at: int, step: int) -> int:
    """Where the value before (``step`` -1) or behind (1) the sign at ``at`` begins or ends."""
    index, depth = at + step, 0
    while 0 <= index < len(tokens):
        kind = tokens[index].type
        depth += step * ((kind in OPENING) - (kind in CLOSING))
        if depth < 0 or (depth == 0 and kind not in _VALUE and kind not in OPENING and kind not in CLOSING):
            break
        index += step
    return index + 1 if step < 0 else index


HABITS: Final[tuple[Callable[[Place], Diagnostic | None], ...]] = (
    arrow,
    equality,
    chained,
    unit,
    doubled,
    prefix_between,
)
