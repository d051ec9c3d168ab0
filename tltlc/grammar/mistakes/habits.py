"""Forms that people know from other languages or a word processor, and their form in this language."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, replacement_fix
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
_EQUAL_FORM, _UNEQUAL_FORM = "{a} >= {b} and {a} <= {b}", "{a} < {b} or {a} > {b}"
_EQUAL: Final = {"==": _EQUAL_FORM, "=": _EQUAL_FORM, "!=": _UNEQUAL_FORM, "<>": _UNEQUAL_FORM}


def equality(place: Place) -> Diagnostic | None:
    """Report ``a == b``, ``a != true``, ``a <> 3``, and ``a = b`` where a comparison was meant."""
    sign, at = place.found.text, place.stop.index
    is_expectation = place.tokens[0].text == "expect"
    if sign not in _EQUAL or not (place.found.type != "EQUAL" or place.wants_operator or is_expectation):
        return None
    title = f"`{sign}` does not compare here" if place.found.type != "EQUAL" else "`=` does not compare"
    if is_expectation:
        return place.error("TLT0110", title, "compare with `<`, `<=`, `>` or `>=`")
    start, stop = side(place.tokens, at, -1), side(place.tokens, at, 1)
    a, b = written(place, start, at), written(place, at + 1, stop)
    is_unequal, boolean_text = _EQUAL[sign] == _UNEQUAL_FORM, ""
    if b.lower() in ("true", "false"):
        text, reason = (
            a if (b.lower() == "true") != is_unequal else f"not {a}",
            ": a `bool` signal is an atom by itself",
        )
    else:
        text, reason = _EQUAL[sign].format(a=a, b=b), ""
        is_part = (start, stop) != (formula_start(place), formula_stop(place))
        text = f"({text})" if is_part else text
        if b in ("0", "1"):
            boolean_text = a if (b == "1") != is_unequal else f"not {a}"
            reason = f", or `{boolean_text}` where it is true or false"
        elif _is_atom(place, start, at) and _is_atom(place, at + 1, stop):
            boolean_text = f"({a} iff {b})" if is_part or is_unequal else f"{a} iff {b}"
            boolean_text = f"{'not ' * is_unequal}{boolean_text}"
            reason = f", or `{boolean_text}` where both are true or false"
    general = f"write `{_EQUAL[sign].format(a='a', b='b')}`; a `bool` signal is an atom by itself"
    diagnostic = reworded(place, start, stop, text, title, reason, "TLT0110") if a and b else None
    if diagnostic and diagnostic.fixes and boolean_text:
        # A predicate can be compared as a number or as a truth value.
        diagnostic = replace(
            diagnostic,
            fixes=(*diagnostic.fixes, replacement_fix(place.source, span_of(place.tokens[start:stop]), boolean_text)),
        )
    return diagnostic or place.error("TLT0110", title, general)


def _is_atom(place: Place, start: int, stop: int) -> bool:
    """Whether some tokens are a name, with or without arguments."""
    kinds = [token.type for token in place.tokens[start:stop]]
    rest = outside(place.tokens, start + 1, stop)
    return kinds[:1] == ["NAME"] and all(place.tokens[index].type in ("LPAR", "RPAR") for index in rest)


def chained(place: Place) -> Diagnostic | None:
    """Report ``a < b < c``, with any number of comparisons."""
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
    diagnostic = reworded(place, start, stop, text, title, code="TLT0110")
    return diagnostic or place.error("TLT0110", title, "write `a < b and b < c`")


def arrow(place: Place) -> Diagnostic | None:
    """Report ``a => b`` and ``a =< b``."""
    at = place.stop.index
    after = place.tokens[at + 1 :][:2]
    if place.found.type != "EQUAL" or not place.wants_operator or not after or not touch(place.found, after[0]):
        return None
    sign = "=" + after[0].text
    if sign not in ("=>", "=<"):
        return None
    is_before_number = len(after) > 1 and after[1].type == "NUMBER"
    operator = "<=" if sign == "=<" else ">=" if is_before_number else "implies"
    help_ = f"write `{operator}`" + (" or `->`" if operator == "implies" else "")
    span = span_of(place.tokens[at : at + 2])
    # Between goals, an arrow may mean their order.
    write = None if operator == "implies" and place.tokens[0].type == "REACH" else operator
    help_ = help_ if write else "write `then` for an order, `implies` for a condition"
    return place.error("TLT0104", f"`{sign}` means nothing here", help_, span=span, write=write)


def comment(place: Place) -> Diagnostic | None:
    """Report ``-- a comment``; the parser may have read its first words as part of a formula."""
    tokens, at = place.tokens, place.stop.index
    for index in range(min(at, len(tokens) - 2), -1, -1):
        first, second, after = tokens[index], tokens[index + 1], tokens[index + 2 : index + 3]
        if first.text == second.text == "-" and touch(first, second):
            # `--3` is a number with two signs.
            if index < at and after and touch(second, after[0]):
                return None
            span = span_of([first, second])
            return place.error(
                "TLT0104", "`--` means nothing here", "write `//` before a comment", span=span, write="//"
            )
        if is_first_on_line(place.source, tokens, index):
            return None
    return None


def unit(place: Place) -> Diagnostic | None:
    """Report ``20 seconds`` and ``3 feet``."""
    number, token = place.before, place.found
    if number is None or number.type != "NUMBER" or token.type != "NAME" or "UNIT" not in place.allowed:
        return None
    title = f"there is no unit {shown(token)}"
    known = UNITS_ELSEWHERE.get(token.text.lower())
    if known == "%":
        # For a value from 0 to 100, it is the number alone.
        help_ = (
            f"of a ratio, write `{number.text} %`, which is a hundredth of {number.text}; else `{number.text}` alone"
        )
        return place.error("TLT0111", title, help_)
    if known:
        text = f"{number.text} {known}"
        return place.error("TLT0111", title, None, f"write `{text}`", span_of([number, token]), write=text)
    is_call = place.tokens[place.stop.index + 1].type == "LPAR"
    if is_call or place.allowed == {"UNIT"} or is_first_on_line(place.source, place.tokens, place.stop.index):
        return None
    listed = ", ".join(f"`{name}`" for name in sorted(load().units))
    help_ = f"the units are {listed}; a signal is compared, as in `{token.text} >= {number.text}`"
    return place.error("TLT0111", title, help_)


def doubled(place: Place) -> Diagnostic | None:
    """Report ``a and then b``, ``a then then b``."""
    before, token = place.before, place.found
    if before is None or before.type not in INFIX or token.type not in INFIX or not place.wants_operand:
        return None
    title = f"{shown(before)} and {shown(token)} stand side by side"
    word = token.text if (before.type, token.type) == ("AND", "THEN") else before.text
    # `keep a then b` requires `b` after the last step, and `a or then b` may mean an order or a choice.
    is_order = token.type == "THEN" and before.type in ("AND", "IMPLIES")
    is_order = is_order and clause_asked(place, place.stop.index) != "keep"
    write = word if token.type == before.type or is_order else None
    help_ = f"write `{write}` alone" if write else "leave one of the two out"
    return place.error("TLT0101", title, help_, span=span_of([before, token]), write=write)


def prefix_between(place: Place) -> Diagnostic | None:
    """Report ``reach a next b`` and ``keep a not b``."""
    token, keyword, following = place.found, place.tokens[0].text, place.stop.index + 1
    is_last = following + 1 >= len(place.tokens) or is_first_on_line(place.source, place.tokens, following)
    if is_last and (keyword, token.type) in (("keep", "ALWAYS"), ("reach", "EVENTUALLY")):
        help_ = f"leave it out: `{keyword}` says so already"
        return place.error("TLT0101", f"{shown(token)} stands before a formula", help_)
    if is_last or token.type not in {*BEFORE_ONE, "ALL", "ANY"} or not place.wants_operator:
        return None
    is_goal = keyword == "reach" and token.type in ("NEXT", "EVENTUALLY")
    replacement = "then" if is_goal else f"and {token.text}"
    title = f"{shown(token)} stands before one formula, not between two"
    # Beside another operator, `and` may bind too tightly; `next` and `always` may follow `and`, `implies` or `then`.
    indices = outside(place.tokens, formula_start(place), formula_stop(place))
    is_clear = token.type == "NOT" and all(place.tokens[index].type not in INFIX - {"AND"} for index in indices)
    return place.error("TLT0101", title, f"write `{replacement}`", write=replacement if is_clear else None)


def side(tokens: Sequence[Token], at: int, step: int) -> int:
    """Return where the value before (``step`` -1) or after (``step`` 1) the operator at ``at`` begins or ends."""
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
