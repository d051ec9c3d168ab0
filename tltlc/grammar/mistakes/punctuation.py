"""Report commas, brackets, quotes and names in a form that other languages use."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CLAUSES, TEST_ITEMS
from tltlc.grammar.lexer import END, tokenize
from tltlc.grammar.mistakes.fragments import is_first_on_line
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, UNCLEAR, has
from tltlc.grammar.mistakes.place import BEFORE_ONE, INFIX, OPENING, Place, outside, touch
from tltlc.grammar.mistakes.rephrasing import LOOSE, formula_start, formula_stop, operand, reworded, span_of, written

NAME: Final = re.compile("[A-Za-z_][A-Za-z0-9_]*")
_COMMA: Final = {
    "reach": ("then", " for the one after the other; `and` asks for both at one step"),
    "avoid": ("or", ""),
}
"""By clause, the operator that joins formulas, with a reason for the message; in other clauses, it is `and`."""
_NUMBER: Final = re.compile(r"[0-9]+\.[0-9]+(?:[eE][+-]?[0-9]+)?")
_IN_THOUSANDS: Final = re.compile(r"[1-9][0-9]{0,2}(?:,[0-9]{3})+(?:\.[0-9]+)?")


def comma(place: Place) -> Diagnostic | None:
    """Report ``reach a, b``, ``keep a,`` and ``3,5 m``."""
    before, at = place.before, place.stop.index
    if place.found.type != "COMMA" or before is None or not place.wants_operator or place.open_brackets:
        return None
    after = place.tokens[at + 1]
    if before.type == after.type == "NUMBER" and _touch(place, at):
        return _comma_in_number(place)
    if after.type == END:
        return place.error("TLT0104", "`,` means nothing here", left_out(place))
    if place.start == "clause" and after.text in CLAUSES and after.type != "NAME":
        return _comma_before_clause(place)
    word, reason = _COMMA.get(place.tokens[0].text, ("and", ""))
    title = "`,` joins no formulas"
    start, stop = formula_start(place), formula_stop(place)
    if not _is_clear_list(place, start, stop, word):
        help_ = "write `and`, `or` or `then` in its place, with brackets around what belongs together"
        return place.error("TLT0104", title, help_)
    diagnostic = reworded(place, start, stop, _joined(place, start, stop, word), title, reason, "TLT0104")
    return diagnostic or place.error("TLT0104", title, f"in its place, `{word}` is written{reason}")


def _comma_before_clause(place: Place) -> Diagnostic:
    """Report ``avoid a, reach b``, which are two clauses."""
    at, first = place.stop.index, place.tokens[0].text
    word, title, span = place.tokens[at + 1].text, "`,` joins no clauses", span_of(place.tokens[at : at + 2])
    # After a goal, `keep` or `avoid` may apply from there on; and what follows `or` may be an alternative.
    is_clear = first != "reach" and not has(place, 1, at, UNCLEAR | BEFORE_ONE | QUANTIFIERS | {"OR"})
    if not is_clear:
        return place.error("TLT0104", title, f"let `{word}` begin a line of its own: all clauses count", span=span)
    return place.error("TLT0104", title, f"write `{word}` alone: all clauses count", span=span, write=word)


def _is_clear_list(place: Place, start: int, stop: int, word: str) -> bool:
    """Whether all commas can mean this word, judged by the operators beside them.

    In English, the operator before the last part applies to the whole list: `a, b or c` is `a or b or c`.
    """
    tokens, operator = place.tokens, word.upper()
    kinds = [(index, tokens[index].type) for index in outside(tokens, start, stop)]
    commas = [index for index, kind in kinds if kind == "COMMA"]
    if any(token.text in CLAUSES and token.type != "NAME" for token in tokens[start:stop]):
        return False
    if operator == "THEN":
        after_last = [kind for index, kind in kinds if index > commas[-1] and kind in INFIX]
        after_commas = [tokens[index + 1].type for index in commas if tokens[index + 1].type in INFIX]
        # A negated part may be a condition on a goal instead of a goal: `reach a, not b`.
        if any(kind == "NOT" for _, kind in kinds):
            return False
        return (
            set(after_last) <= {"THEN"}
            and set(after_commas) <= {"THEN"}
            and not has(place, start, stop, UNCLEAR - {"THEN"})
        )
    # In `not a, b` and `always a, b`, the operator may apply to both.
    return not has(place, start, stop, INFIX - {operator}) and not has(place, start, commas[-1], BEFORE_ONE)


def _comma_in_number(place: Place) -> Diagnostic:
    """Report ``2,5``, and ``1,000``, which some countries read as a thousand and others as one."""
    at = place.stop.index
    stop = at + 2
    while place.tokens[stop].type == "COMMA" and place.tokens[stop + 1].type == "NUMBER" and _touch(place, stop):
        stop += 2
    text = place.source.slice(span_of(place.tokens[at - 1 : stop]))
    span, title = span_of(place.tokens[at - 1 : stop]), "a number has a point, no comma"
    thousands, fraction = text.replace(",", ""), text.replace(",", ".")
    is_fraction, in_thousands = _NUMBER.fullmatch(fraction), _IN_THOUSANDS.fullmatch(text)
    if in_thousands:
        help_ = f"write `{thousands}` where a comma parts the thousands"
        help_ += f", `{fraction}` where it stands for a point" if is_fraction else ""
        return place.error("TLT0104", title, help_, span=span)
    if is_fraction:
        return place.error("TLT0104", title, f"write `{fraction}`", span=span, write=fraction)
    return place.error("TLT0104", title, "write it without commas", span=span)


def _touch(place: Place, at: int) -> bool:
    """Whether a token touches both the token before it and the token after it."""
    before, token, after = place.tokens[at - 1 : at + 2]
    return touch(before, token) and touch(token, after)


def _joined(place: Place, start: int, stop: int, word: str) -> str:
    """Return tokens with a word in place of each comma outside brackets; a comma before an operator is dropped."""
    text = ""
    for end in [*(index for index in outside(place.tokens, start, stop) if place.tokens[index].type == "COMMA"), stop]:
        part = _goal(place, start, end) if word == "then" else operand(place, start, end)
        if start == end:
            continue
        if text and place.tokens[start].type in INFIX:
            text += f" {written(place, start, end)}"
        else:
            text += f" {word} {part}" if text else part
        start = end + 1
    return text


def _goal(place: Place, start: int, stop: int) -> str:
    """Return tokens before `then`, with a quantifier in brackets, since it would extend over the `then`."""
    quantifiers = (index for index in outside(place.tokens, start, stop) if place.tokens[index].type in QUANTIFIERS)
    at = next(quantifiers, None)
    if at is None:
        return written(place, start, stop)
    return f"{written(place, start, at)} ({written(place, at, stop)})".strip()


def missing_comma(place: Place) -> Diagnostic | None:
    """Report ``entity a b``, ``in [0 50]``, ``near(s1 close = 3 m)``."""
    before, token = place.before, place.found
    if before is None or "COMMA" not in place.allowed or token.type not in ("NAME", "NUMBER"):
        return None
    if is_first_on_line(place.source, place.tokens, place.stop.index):
        return None
    if before.text in TEST_ITEMS and place.tokens[place.stop.index - 2].type == "COMMA":
        span = place.tokens[place.stop.index - 2].span
        return place.error("TLT0104", "`,` means nothing here", left_out(place), span=span)
    if before.type not in ("NAME", "NUMBER", "UNIT", "RPAR") or before.text in TEST_ITEMS:
        return None
    has_unit = before.type == "UNIT"
    text = f"{written(place, place.stop.index - 1 - has_unit, place.stop.index)}, {token.text}"
    span = span_of(place.tokens[place.stop.index - 1 - has_unit : place.stop.index + 1])
    return place.error("TLT0101", place.expectation(), f"write `{text}`", span=span, write=text)


def argument(place: Place) -> Diagnostic | None:
    """Report ``near(s1, close: 3 m)`` and ``near(s1, close 3 m)``."""
    before = place.before
    if before is None or before.type != "NAME" or "EQUAL" not in place.allowed or not place.open_brackets:
        return None
    title = "an argument by name has `=` before its value"
    if place.found.type == "COLON":
        text = f"{before.text} ="
    elif place.found.type == "NUMBER":
        text = f"{before.text} = {place.found.text}"
    else:
        return None
    return place.error("TLT0101", title, f"write `{text}`", span=span_of([before, place.found]), write=text)


def no_arguments(place: Place) -> Diagnostic | None:
    """Report ``alive()``."""
    at = place.stop.index
    kinds = [token.type for token in place.tokens[max(0, at - 2) : at + 1]]
    if kinds != ["NAME", "LPAR", "RPAR"]:
        return None
    name = place.tokens[at - 2].text
    title = "there is nothing in these brackets"
    help_ = f"write `{name}` alone, or what it is said of between them"
    return place.error("TLT0101", title, help_, span=span_of(place.tokens[at - 2 : at + 1]), write=name)


def brackets(place: Place) -> Diagnostic | None:
    """Report brackets of the wrong kind: ``near[s1]``, ``keep {seen}`` and ``in (0, 50)``."""
    at, token = place.stop.index, place.found
    is_call = place.wants_operator and place.before is not None and touch(place.before, token)
    kind = "arguments" if is_call else "formulas" if place.wants_operand else "ranges"
    opening, closing = "[]" if kind == "ranges" else "()"
    end = next((index for index in outside(place.tokens, at, len(place.tokens)) if index > at), None)
    if token.type not in OPENING or end is None or (kind == "ranges" and "LSQB" not in place.allowed):
        return None
    text = f"{place.tokens[at - 1].text if is_call else ''}{opening}{written(place, at + 1, end)}{closing}"
    title = f"{kind} stand in `{opening} {closing}`, not in `{token.text} {place.tokens[end].text}`"
    return reworded(place, at - is_call, end + 1, text, title)


def quoted(place: Place) -> Diagnostic | None:
    """Report ``near("door")`` and ``reach "near(door)"``."""
    text, at = place.found.text.strip('"'), place.stop.index
    if place.found.type != "STRING" or not ("NAME" in place.allowed or place.wants_operand):
        return None
    name = text if NAME.fullmatch(text) else re.sub("[^A-Za-z0-9_]+", "_", text)
    if not name.strip("_"):
        help_ = "names are ASCII letters, digits and `_`, without quotes"
        return place.error("TLT0101", place.expectation(), help_)
    for replacement in dict.fromkeys((unquoted(place, at, at + 1, text), name)):
        diagnostic = reworded(
            place, at, at + 1, replacement, place.expectation(), ": no quotes around names and formulas"
        )
        if diagnostic:
            return diagnostic
    return place.error("TLT0101", place.expectation(), f"write `{name}`: no quotes around names and formulas")


def unquoted(place: Place, start: int, stop: int, text: str) -> str:
    """Return the text between quotes, in brackets if it is several operands and not the whole formula."""
    is_whole = (start, stop) == (formula_start(place), formula_stop(place))
    is_compound = any(token.type in LOOSE or token.type == "NOT" for token in tokenize(text).tokens)
    return f"({text})" if is_compound and not is_whole else text


def no_name(place: Place) -> Diagnostic | None:
    """Report ``my-door``, where no difference can stand, and ``2nd_door``."""
    before, token, after = place.before, place.found, place.tokens[place.stop.index + 1 :][:1]
    if before is None or not after:
        return None
    joined = touch(token, after[0]) and (NAME.fullmatch(after[0].text) or after[0].type == "NUMBER")
    rule = "names are ASCII letters, digits and `_`"
    if token.type == "NUMBER" and "NUMBER" not in place.allowed and "NAME" in place.allowed:
        text = f"_{token.text}{after[0].text}" if joined else f"{before.text}_{token.text}"
        span, rule = span_of([token, after[0]] if joined else [token]), "a name begins with a letter or `_`"
    elif token.text == "-" and before.type == "NAME" and touch(before, token) and joined:
        span, text = span_of([before, after[0]]), f"{before.text}_{after[0].text}"
    else:
        return None
    title = f"`{place.source.slice(span)}` is no name"
    return place.error("TLT0104", title, f"{rule}: write `{text}`", span=span, write=text)


def value_of_signal(place: Place) -> Diagnostic | None:
    """Report ``signal seen: bool = false``."""
    if place.tokens[0].type != "SIGNAL" or place.found.type != "EQUAL" or place.open_brackets or place.stop.index < 3:
        return None
    return place.error("TLT0101", "a signal has no value here", "leave it out: the game supplies it at each step")


def type_alone(place: Place) -> Diagnostic | None:
    """Report ``signal at(entity): bool``."""
    if place.found.type != "ENTITY" or "NAME" not in place.allowed or not place.open_brackets:
        return None
    return place.error("TLT0101", "a parameter has a name", "write `x: entity`", write="x: entity")


def several(place: Place) -> Diagnostic | None:
    """Report ``signal a, b: bool``."""
    word = place.tokens[0].text
    if place.found.type != "COMMA" or place.start != "declaration" or place.stop.index != 2:
        return None
    return place.error("TLT0101", place.expectation(), f"each one has a `{word}` of its own; {place.form()}")


def range_word(place: Place) -> Diagnostic | None:
    """Report ``signal coins [0, 50]``."""
    if place.found.type != "LSQB" or "IN" not in place.allowed or place.before is None or place.before.text == "in":
        return None
    return place.error("TLT0101", place.expectation(), "write `in [`", write="in [")


def left_out(place: Place) -> str:
    """Return the help for a character that ends statements in other languages."""
    between = {"clause": "clauses", "declaration": "declarations"}.get(place.start)
    return "leave it out" + (f": nothing is needed between {between}" if between else "")


PUNCTUATION: Final[tuple[Callable[[Place], Diagnostic | None], ...]] = (
    comma,
    argument,
    no_arguments,
    quoted,
    no_name,
    value_of_signal,
    type_alone,
    several,
    range_word,
    brackets,
)
