"""Explain a time beside an operator, which may belong to both sides: `within 1 s a until b`, `a within 1 s or b`."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.english_forms import FOR_TIME, IN_TIME, Forms
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK, Time, clause_keyword
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure, outer_indices
from tltlc.grammar.mistakes.repeats import TokenRange
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    last_index_of,
    operand_text,
    suggest_rewrite,
    text_of,
)

_UNTILS: Final = ("UNTIL", "WEAK_UNTIL")
_STATES: Final = ("AND", "OR")
_WHOLE: Final = ("KEEP", "REQUIRE")


def time_before_joint(failure: ParseFailure, at: int, second: int, time: Time, forms: Forms) -> Diagnostic | None:
    """Return an error for a time before a formula with an operator, such as ``within 1 s a until b``, else None.

    ``at`` is the index of the English word, and ``second`` that of the formula. ``forms`` are the ways to write
    a time with this word.
    """
    joint = _joint(failure, second)
    if joint is None or failure.tokens[second].type == "COMMA":
        return None
    return _error(failure, at, (second, joint), joint, time, forms)


def time_before_operator(failure: ParseFailure, at: int, end: int, time: Time, forms: Forms) -> Diagnostic | None:
    """Return an error for a time between a formula and an operator, such as ``a within 1 s until b``, else None.

    ``at`` is the index of the English word, and ``end`` that after the time.
    """
    start = formula_start(failure)
    last = last_index_of(failure, INFIX, start)
    operand = (start if last is None else last + 1, at)
    return _error(failure, at, operand, end, time, forms) if _joint(failure, end) == end else None


def _joint(failure: ParseFailure, start: int) -> int | None:
    """Return the index of the first operator from an index on; None if there is none, or if others follow."""
    outer = outer_indices(failure.tokens, start, formula_stop(failure))
    joints = [index for index in outer if failure.tokens[index].type in INFIX]
    kinds = {failure.tokens[index].type for index in joints}
    return joints[0] if len(kinds) == 1 and kinds <= {*_UNTILS, *_STATES} else None


def _error(
    failure: ParseFailure, at: int, operand: TokenRange, joint: int, time: Time, forms: Forms
) -> Diagnostic | None:
    """Return the error for a time with the word at an index, an operand, and an operator behind both."""
    tokens, stop, begin = failure.tokens, formula_stop(failure), min(at, operand[0])
    word, kind = tokens[joint].text, tokens[joint].type
    if clause_keyword(failure) in ("reach", "avoid") or (kind in _STATES and forms is not IN_TIME):
        return None
    if not operand[0] < operand[1] or joint + 1 >= stop or not is_of_one_step(failure, *operand):
        return None
    if has_token(failure, begin, stop, QUANTIFIERS):
        return None
    first, second, t = operand_text(failure, *operand), text_of(failure, joint + 1, stop), time.text
    timed = f"{'eventually within' if forms is IN_TIME else 'always for' if forms is FOR_TIME else 'next after'} {t}"
    both, alone = f"{timed} ({first} {word} {second})", f"({timed} {first}) {word} {second}"
    if kind in _UNTILS and forms is IN_TIME:
        readings = [
            (both, f"if a stretch of `{first} {word} {second}` must begin within {t}"),
            (alone, f"if `{first}` must come within {t} of each step before `{second}`"),
        ]
        if at == begin and kind == "UNTIL":
            ended = f"({first} until {second}) and eventually within {t} {operand_text(failure, joint + 1, stop)}"
            readings = [(ended, f"if `{second}` must come within {t}"), *readings]
    else:
        readings = [
            (both, f"if `{word} {second}` belongs to what the time is for"),
            (alone, f"if the time is for `{first}` alone"),
        ]
    return _with_readings(failure, at, (begin, stop), readings)


def _with_readings(
    failure: ParseFailure, at: int, part: TokenRange, readings: list[tuple[str, str]]
) -> Diagnostic | None:
    """Return the error for the word at an index that names the readings of a part; None if one cannot be parsed."""
    tokens, (begin, stop), title = failure.tokens, part, failure.misplaced(failure.tokens[at])
    before, clause = tokens[begin - 1].type, failure.start == "clause" and begin == 1
    if clause and (before not in _WHOLE or (before == "KEEP" and " until " not in readings[0][0])):
        return None
    if failure.lacks_fixed_clock(readings[0][0]):
        return failure.error("TLT0101", title, FIXED_CLOCK, span=tokens[at].span)
    if before in _STATES:
        readings = [(f"({text})", condition) for text, condition in readings]
    elif before not in ("IMPLIES", "LPAR", "EQUAL", *_WHOLE):
        return None
    if clause:
        # A time at the beginning of a clause counts from the first step on.
        begin, readings = 0, [(f"require {text}", condition) for text, condition in readings]
    described = []
    for text, condition in readings:
        if suggest_rewrite(failure, begin, stop, text, title) is None:
            return None
        whole = f"{text_of(failure, 0, begin)} {text} {text_of(failure, stop, len(tokens) - 1)}".strip()
        whole = whole.replace("( ", "(").replace(" )", ")")
        described.append(f"`{whole if failure.start == 'clause' else text}` {condition}")
    return failure.error("TLT0101", title, f"write {', '.join(described)}", span=tokens[at].span)
