"""Explain commas, brackets, quotes and names that are written as in other languages.

Each function of ``PUNCTUATION`` recognises one mistake. It returns the error, or None if parsing failed
for another reason.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CLAUSES, TEST_ITEMS, UNITS_ELSEWHERE
from tltlc.grammar.lexer import END, Token, tokenize
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.fragments import is_first_on_line
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, UNCLEAR, has_token
from tltlc.grammar.mistakes.parse_failure import BEFORE_ONE, INFIX, OPENING, ParseFailure, are_adjacent, outer_indices
from tltlc.grammar.mistakes.rephrasing import (
    LOOSE,
    formula_start,
    formula_stop,
    operand_text,
    span_of,
    suggest_rewrite,
    text_of,
)
from tltlc.grammar.mistakes.sentences.vocabulary import CHANGING
from tltlc.grammar.past_words import OF_EVENTS

NAME: Final = re.compile("[A-Za-z_][A-Za-z0-9_]*")
_COMMA: Final = {
    "reach": ("then", " for one after the other; write `and` for both at the same step"),
    "avoid": ("or", ""),
}
"""Maps a clause keyword to the operator that replaces a comma, and to the end of the help text.

In clauses that are not listed, the operator is `and`.
"""
_NUMBER: Final = re.compile(r"[0-9]+\.[0-9]+(?:[eE][+-]?[0-9]+)?")
_IN_THOUSANDS: Final = re.compile(r"[1-9][0-9]{0,2}(?:,[0-9]{3})+(?:\.[0-9]+)?")

_LAST: Final = ("last", "previous")
"""Words before an event: `times_since(hit, last checkpoint)`."""


def comma(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a comma outside brackets that does not fit, else None.

    Examples are ``reach a, b``, ``keep a,`` and ``3,5 m``.
    """
    before, at = failure.previous_token, failure.stop.index
    if failure.token.type != "COMMA" or before is None or not failure.wants_operator or failure.open_brackets:
        return None
    after = failure.tokens[at + 1]
    if before.type == after.type == "NUMBER" and _touches_both(failure, at):
        return _comma_in_number(failure)
    if after.type == END:
        return failure.error("TLT0104", "`,` means nothing here", leave_out_help(failure))
    if failure.start == "clause" and after.text in CLAUSES and after.type != "NAME":
        return _comma_before_clause(failure)
    word, reason = _COMMA.get(failure.tokens[0].text, ("and", ""))
    title = "`,` cannot join formulas"
    start, stop = formula_start(failure), formula_stop(failure)
    if not _is_clear_list(failure, start, stop, word):
        help_ = "write `and`, `or` or `then` instead, and put brackets around what belongs together"
        return failure.error("TLT0104", title, help_)
    diagnostic = suggest_rewrite(
        failure, start, stop, _joined_text(failure, start, stop, word), title, reason, "TLT0104"
    )
    return diagnostic or failure.error("TLT0104", title, f"write `{word}` instead{reason}")


def _comma_before_clause(failure: ParseFailure) -> Diagnostic:
    """Return the error for a comma between two clauses: ``avoid a, reach b``."""
    at, first = failure.stop.index, failure.tokens[0].text
    word, title, span = failure.tokens[at + 1].text, "`,` cannot join clauses", span_of(failure.tokens[at : at + 2])
    # After a goal, `keep` may apply from there on; and what follows `or` may be an alternative.
    is_clear = first != "reach" or word == "avoid"
    is_clear = is_clear and not has_token(failure, 1, at, UNCLEAR | BEFORE_ONE | QUANTIFIERS | {"OR"})
    if not is_clear:
        help_ = f"leave out the comma, and begin a new line with `{word}`: all clauses count"
        return failure.error("TLT0104", title, help_, span=span)
    return failure.error("TLT0104", title, f"write `{word}` alone: all clauses count", span=span, write=word)


def _is_clear_list(failure: ParseFailure, start: int, stop: int, word: str) -> bool:
    """Whether all commas of a formula can only mean the operator ``word``, judged by the other operators.

    In English, the operator before the last part applies to the whole list: `a, b or c` is `a or b
    or c`.
    """
    tokens, operator = failure.tokens, word.upper()
    kinds = [(index, tokens[index].type) for index in outer_indices(tokens, start, stop)]
    commas = [index for index, kind in kinds if kind == "COMMA"]
    if any(token.text in CLAUSES and token.type != "NAME" for token in tokens[start:stop]):
        return False
    if operator == "THEN":
        after_last = [kind for index, kind in kinds if index > commas[-1] and kind in INFIX]
        after_commas = [tokens[index + 1].type for index in commas if tokens[index + 1].type in INFIX]
        # In `reach a, not b`, the negated part may be a condition on the goal `a`, and no goal itself.
        if any(kind == "NOT" for _, kind in kinds):
            return False
        return (
            set(after_last) <= {"THEN"}
            and set(after_commas) <= {"THEN"}
            and not has_token(failure, start, stop, UNCLEAR - {"THEN"})
        )
    # In `not a, b` and `always a, b`, the operator may apply to both.
    return not has_token(failure, start, stop, INFIX - {operator}) and not has_token(
        failure, start, commas[-1], BEFORE_ONE
    )


def _comma_in_number(failure: ParseFailure) -> Diagnostic:
    """Return the error for a comma in a number: ``2,5`` means 2.5, but ``1,000`` may be a thousand or 1."""
    at = failure.stop.index
    stop = at + 2
    while (
        failure.tokens[stop].type == "COMMA"
        and failure.tokens[stop + 1].type == "NUMBER"
        and _touches_both(failure, stop)
    ):
        stop += 2
    text = failure.source.slice(span_of(failure.tokens[at - 1 : stop]))
    span, title = span_of(failure.tokens[at - 1 : stop]), "a number cannot contain a comma"
    thousands, fraction = text.replace(",", ""), text.replace(",", ".")
    is_fraction, in_thousands = _NUMBER.fullmatch(fraction), _IN_THOUSANDS.fullmatch(text)
    if in_thousands:
        help_ = f"write `{thousands}` if a comma separates thousands"
        help_ += f", or `{fraction}` if it stands for a decimal point" if is_fraction else ""
        return failure.error("TLT0104", title, help_, span=span)
    if is_fraction:
        return failure.error("TLT0104", title, f"write `{fraction}`", span=span, write=fraction)
    return failure.error("TLT0104", title, "write it without commas", span=span)


def _touches_both(failure: ParseFailure, at: int) -> bool:
    """Whether a token touches both the token before it and the token after it."""
    before, token, after = failure.tokens[at - 1 : at + 2]
    return are_adjacent(before, token) and are_adjacent(token, after)


def _joined_text(failure: ParseFailure, start: int, stop: int, word: str) -> str:
    """Return the text of the tokens from ``start`` up to ``stop``, with ``word`` in place of commas.

    A comma inside brackets stays. A comma before an operator is left out.
    """
    text = ""
    for end in [
        *(index for index in outer_indices(failure.tokens, start, stop) if failure.tokens[index].type == "COMMA"),
        stop,
    ]:
        part = _goal_text(failure, start, end) if word == "then" else operand_text(failure, start, end)
        if start == end:
            continue
        if text and failure.tokens[start].type in INFIX:
            text += f" {text_of(failure, start, end)}"
        else:
            text += f" {word} {part}" if text else part
        start = end + 1
    return text


def _goal_text(failure: ParseFailure, start: int, stop: int) -> str:
    """Return the text of the tokens from ``start`` up to ``stop``, written so that `then` can follow.

    A quantifier gets brackets. Without brackets, it would extend over what follows `then`.
    """
    quantifiers = (
        index for index in outer_indices(failure.tokens, start, stop) if failure.tokens[index].type in QUANTIFIERS
    )
    at = next(quantifiers, None)
    if at is None:
        return text_of(failure, start, stop)
    return f"{text_of(failure, start, at)} ({text_of(failure, at, stop)})".strip()


def missing_comma(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a comma is missing, else None.

    Examples are ``entity a b``, ``in [0 50]`` and ``near(s1 close = 3 m)``.
    """
    before, token = failure.previous_token, failure.token
    if before is None or "COMMA" not in failure.allowed_terminals or token.type not in ("NAME", "NUMBER"):
        return None
    if is_first_on_line(failure.source, failure.tokens, failure.stop.index):
        return None
    if before.text in TEST_ITEMS and failure.tokens[failure.stop.index - 2].type == "COMMA":
        span = failure.tokens[failure.stop.index - 2].span
        return failure.error("TLT0104", "`,` means nothing here", leave_out_help(failure), span=span)
    if before.type not in ("NAME", "NUMBER", "UNIT", "RPAR") or before.text in TEST_ITEMS:
        return None
    if token.text == "ago" and before.type == "UNIT":
        tokens = failure.tokens[failure.stop.index - 2 : failure.stop.index + 1]
        text = f"{tokens[0].text} {tokens[1].text}"
        return failure.error(
            "TLT0101", "the language has no word `ago`", f"write `{text}`", span=span_of(tokens), write=text
        )
    if _is_english(failure, token):
        return None
    if before.text in _LAST and before.text not in declared_names(failure.source).names:
        return failure.error("TLT0101", f"the language has no word `{before.text}`", f"leave out `{before.text}`")
    if word := next((text for text in (before.text, token.text) if text in CHANGING), ""):
        help_ = "that `x` changes is `x != previous(x)` for whole numbers, `begins x or ends x` for true and false"
        return failure.error("TLT0101", f"the language has no word `{word}`", help_)
    has_unit = before.type == "UNIT"
    text = f"{text_of(failure, failure.stop.index - 1 - has_unit, failure.stop.index)}, {token.text}"
    span = span_of(failure.tokens[failure.stop.index - 1 - has_unit : failure.stop.index + 1])
    return failure.error("TLT0101", failure.expectation(), f"write `{text}`", span=span, write=text)


def _is_english(failure: ParseFailure, token: Token) -> bool:
    """Whether a word in the brackets of a function of the past is no name of the file, as in `lap increases`."""
    opening = failure.open_brackets[-1].start if failure.open_brackets else 0
    called = next((before for before in failure.tokens if before.end == opening), None)
    names = declared_names(failure.source)
    is_function = called is not None and called.text in OF_EVENTS and called.text not in names.names
    return is_function and token.type == "NAME" and token.text not in names.names and not names.has_imports


def argument_by_name(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a named argument has no `=`, as in ``near(s1, close: 3 m)``, else None."""
    before = failure.previous_token
    if before is None or before.type != "NAME" or "EQUAL" not in failure.allowed_terminals or not failure.open_brackets:
        return None
    title = "a named argument needs `=` before its value"
    if failure.token.type == "COLON":
        text = f"{before.text} ="
    elif failure.token.type == "NUMBER":
        text = f"{before.text} = {failure.token.text}"
    else:
        return None
    return failure.error("TLT0101", title, f"write `{text}`", span=span_of([before, failure.token]), write=text)


def empty_group(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a group without members, as in ``entity guards =`` and ``all x in (): p``, else None."""
    at = failure.stop.index
    if failure.tokens[0].type == "ENTITY" and at == 3 and failure.tokens[2].type == "EQUAL":
        name = failure.tokens[1].text
        help_ = f"name its members: `entity {name} = a, b`"
        return failure.error("TLT0101", f"the group `{name}` has no members", help_, span=failure.tokens[1].span)
    before = failure.tokens[max(0, at - 4) : at]
    if [token.type for token in before[:2]] not in (["ALL", "NAME"], ["ANY", "NAME"]) or failure.token.type != "RPAR":
        return None
    if [token.text for token in before[2:]] != ["in", "("]:
        return None
    brackets = span_of([before[3], failure.token])
    return failure.error("TLT0101", "these brackets are empty", "name the entities in them: `(a, b)`", span=brackets)


def empty_brackets(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a call has no arguments, as in ``alive()``, else None."""
    at = failure.stop.index
    kinds = [token.type for token in failure.tokens[max(0, at - 2) : at + 1]]
    if kinds != ["NAME", "LPAR", "RPAR"]:
        return None
    name = failure.tokens[at - 2].text
    title = "these brackets are empty"
    help_ = f"write `{name}` alone, or put its arguments in the brackets"
    return failure.error("TLT0101", title, help_, span=span_of(failure.tokens[at - 2 : at + 1]), write=name)


def wrong_brackets(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if brackets are of the wrong kind, else None.

    Examples are ``near[s1]``, ``keep {seen}`` and ``in (0, 50)``.
    """
    at, token = failure.stop.index, failure.token
    is_call = (
        failure.wants_operator and failure.previous_token is not None and are_adjacent(failure.previous_token, token)
    )
    kind = "arguments" if is_call else "formulas" if failure.wants_operand else "ranges"
    opening, closing = "[]" if kind == "ranges" else "()"
    end = next((index for index in outer_indices(failure.tokens, at, len(failure.tokens)) if index > at), None)
    if token.type not in OPENING or end is None or (kind == "ranges" and "LSQB" not in failure.allowed_terminals):
        return None
    text = f"{failure.tokens[at - 1].text if is_call else ''}{opening}{text_of(failure, at + 1, end)}{closing}"
    title = f"{kind} belong in `{opening} {closing}`, not in `{token.text} {failure.tokens[end].text}`"
    return suggest_rewrite(failure, at - is_call, end + 1, text, title)


def quoted_name(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a name or formula is in quotes, else None.

    Examples are ``near("door")`` and ``reach "near(door)"``.
    """
    text, at = failure.token.text.strip('"'), failure.stop.index
    if failure.token.type != "STRING" or not ("NAME" in failure.allowed_terminals or failure.wants_operand):
        return None
    name = text if NAME.fullmatch(text) else re.sub("[^A-Za-z0-9_]+", "_", text)
    if not name.strip("_"):
        help_ = "names consist of ASCII letters, digits and `_`, without quotes"
        return failure.error("TLT0101", failure.expectation(), help_)
    for replacement in dict.fromkeys((text_without_quotes(failure, at, at + 1, text), name)):
        diagnostic = suggest_rewrite(
            failure, at, at + 1, replacement, failure.expectation(), ": no quotes around names and formulas"
        )
        if diagnostic:
            return diagnostic
    return failure.error("TLT0101", failure.expectation(), f"write `{name}`: no quotes around names and formulas")


def text_without_quotes(failure: ParseFailure, start: int, stop: int, text: str) -> str:
    """Return ``text``, which stood in quotes, as a replacement for the tokens from ``start`` up to ``stop``.

    The text gets brackets if it contains an operator and the tokens are only a part of the formula.
    """
    is_whole = (start, stop) == (formula_start(failure), formula_stop(failure))
    is_compound = any(token.type in LOOSE or token.type == "NOT" for token in tokenize(text).tokens)
    return f"({text})" if is_compound and not is_whole else text


def invalid_name(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a name contains `-` or begins with a digit, as ``my-door`` and ``2nd_door`` do, else None."""
    before, token, after = failure.previous_token, failure.token, failure.tokens[failure.stop.index + 1 :][:1]
    if before is None or not after:
        return None
    joined = are_adjacent(token, after[0]) and (NAME.fullmatch(after[0].text) or after[0].type == "NUMBER")
    rule, title = "names consist of ASCII letters, digits and `_`", "a name cannot contain `-`"
    if token.type == "NUMBER" and "NUMBER" not in failure.allowed_terminals and "NAME" in failure.allowed_terminals:
        text = f"_{token.text}{after[0].text}" if joined else f"{before.text}_{token.text}"
        span, rule = span_of([token, after[0]] if joined else [token]), "a name begins with a letter or `_`"
        title = "a name cannot begin with a digit"
    elif token.text == "-" and before.type == "NAME" and are_adjacent(before, token) and joined:
        span, text = span_of([before, after[0]]), f"{before.text}_{after[0].text}"
    else:
        return None
    return failure.error("TLT0104", title, f"{rule}: write `{text}`", span=span, write=text)


def value_of_signal(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a signal is given a value, as in ``signal seen: bool = false``, else None."""
    if (
        failure.tokens[0].type != "SIGNAL"
        or failure.token.type != "EQUAL"
        or failure.open_brackets
        or failure.stop.index < 3
    ):
        return None
    return failure.error(
        "TLT0101", "a signal cannot be given a value here", "leave out the value: the game supplies it at each step"
    )


def type_without_name(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a parameter has no name, as in ``signal at(entity): bool``, else None."""
    if failure.token.type != "ENTITY" or "NAME" not in failure.allowed_terminals or not failure.open_brackets:
        return None
    return failure.error("TLT0101", "a parameter needs a name", "write `x: entity`", write="x: entity")


def several_names(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a declaration that takes one name has several, as in ``signal a, b: bool``, else None."""
    word = failure.tokens[0].text
    if failure.token.type != "COMMA" or failure.start != "declaration" or failure.stop.index != 2:
        return None
    return failure.error("TLT0101", failure.expectation(), f"write a separate `{word}` for each one; {failure.form()}")


def missing_in(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a range lacks `in`, as in ``signal coins [0, 50]``, else None."""
    if (
        failure.token.type != "LSQB"
        or "IN" not in failure.allowed_terminals
        or failure.previous_token is None
        or failure.previous_token.text == "in"
    ):
        return None
    return failure.error("TLT0101", failure.expectation(), "write `in [`", write="in [")


def unit_behind_range(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a unit behind a range, as in ``speed in [0, 10] m/s``, else None."""
    tokens, at = failure.tokens, failure.stop.index
    before = failure.previous_token
    if tokens[0].type not in ("SIGNAL", "PARAM") or before is None or before.type != "RSQB":
        return None
    stop = next((i for i in range(at, len(tokens)) if tokens[i].type in (END, "EQUAL")), at)
    opening = next((i for i in range(at - 1, 0, -1) if tokens[i].type == "LSQB"), at)
    ends = [index for index in range(opening, at) if tokens[index].type == "NUMBER"]
    has_units = any(tokens[index].type == "UNIT" for index in range(opening, at))
    if stop == at or not ends or has_units:
        return None
    unit = "".join(token.text for token in tokens[at:stop])
    unit = UNITS_ELSEWHERE.get(unit.lower(), unit)
    pieces = [f"{token.text} {unit}" if token.type == "NUMBER" else token.text for token in tokens[opening:at]]
    text = "".join(f"{piece} " if piece == "," else piece for piece in pieces)
    title = f"`{unit}` cannot stand behind a range"
    return suggest_rewrite(failure, opening, stop, text, title, ": each end has its unit")


def leave_out_help(failure: ParseFailure) -> str:
    """Return a help text that says to leave out a character, such as the ``;`` after a clause."""
    between = {"clause": "clauses", "declaration": "declarations"}.get(failure.start)
    return "leave it out" + (f": nothing is needed between {between}" if between else "")


PUNCTUATION: Final[tuple[Callable[[ParseFailure], Diagnostic | None], ...]] = (
    comma,
    argument_by_name,
    empty_group,
    empty_brackets,
    quoted_name,
    invalid_name,
    value_of_signal,
    type_without_name,
    several_names,
    missing_in,
    unit_behind_range,
    wrong_brackets,
)
