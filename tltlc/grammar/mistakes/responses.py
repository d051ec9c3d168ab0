"""Explain answers to events in English: `after alarm, hidden within 5 s`, `hidden within 5 s after alarm`."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CLAUSES
from tltlc.grammar.lexer import END
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_times import time_at
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, TEMPORAL
from tltlc.grammar.mistakes.parse_failure import INFIX, UNTILS, ParseFailure, outer_indices, quote_token
from tltlc.grammar.mistakes.rephrasing import operand_text, suggest_rewrite, text_of

_EVENTS: Final = ("after", "when", "whenever", "if")
_TIMES: Final = ("within", "in")
_RULE: Final = "keep within {t} of {a}, {b}"
_ABSENCE: Final = "keep {a} implies not eventually within {t} {b}"
_FORMS: Final = {
    "keep": _RULE,
    "require": _RULE,
    "": _RULE,
    "reach": "reach {a} then within {t} {b}",
    "avoid": _ABSENCE,
}
"""How to write that ``b`` answers ``a`` within the time ``t``, by the keyword of the clause."""
_LASTING: Final = dict.fromkeys(("keep", "require", ""), "keep {a} implies always for {t} {b}")
"""How to write that ``b`` holds for the time ``t`` from ``a`` on."""
_NO_STATES: Final = TEMPORAL | UNTILS | QUANTIFIERS | {"THEN", "ONCE", "HISTORICALLY", "PREVIOUSLY", "WHEN"}

_Range = tuple[int, int]


def response_in_english(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a clause that asks for an answer within a time, in the words of English, else None."""
    tokens = failure.tokens
    if failure.start != "clause" or tokens[-1].type != END or failure.open_brackets:
        return None
    keyword = tokens[0].text if tokens[0].text in CLAUSES else ""
    start, stop = bool(keyword), len(tokens) - 1
    parts = (
        _event_first(failure, start, stop) or _time_first(failure, start, stop) or _answer_first(failure, start, stop)
    )
    if parts is None:
        return None
    event, time, answer, word = parts
    forms = _LASTING if tokens[answer[1]].text == "for" else _FORMS
    # `reach if a, b` asks for both at one step.
    if keyword not in forms or (keyword == "reach" and tokens[word].text in _EVENTS[1:]):
        return None
    is_state = all(begin < end and _is_state(failure, begin, end) for begin, end in (event, answer))
    if not is_state or tokens[word].text in declared_names(failure.source).names:
        return None
    form = forms[keyword]
    if forms is _FORMS and any(tokens[index].type == "NOT" for index in outer_indices(tokens, *answer)):
        # `not b within 5 s` asks that no step of the 5 s has b, and `within 5 s of a, not b` for a step without b.
        if form != _RULE or not _is_negation(failure, *answer):
            return None
        form, answer = _ABSENCE, (answer[0] + 1, answer[1])
    text = text_of if form == _RULE else operand_text
    clause = form.format(a=text(failure, *event), b=text(failure, *answer), t=time)
    title = f"{quote_token(tokens[word])} is not an operator"
    return suggest_rewrite(failure, 0, stop, clause, title)


def _event_first(failure: ParseFailure, start: int, stop: int) -> tuple[_Range, str, _Range, int] | None:
    """Return the parts of `after a, b within TIME` and `after a, b for TIME`."""
    tokens = failure.tokens
    separator = _separator(failure, start, stop)
    if tokens[start].text not in _EVENTS or separator is None:
        return None
    for within in range(separator + 1, stop):
        time = time_at(tokens, within + 1) if tokens[within].text in (*_TIMES, "for") else None
        if time and time[1] == stop:
            return (start + 1, separator), time[0].text, (separator + 1, within), start
    return None


def _time_first(failure: ParseFailure, start: int, stop: int) -> tuple[_Range, str, _Range, int] | None:
    """Return the parts of `within TIME after a, b`."""
    tokens = failure.tokens
    separator, time = _separator(failure, start, stop), time_at(tokens, start + 1)
    if (
        tokens[start].text not in _TIMES
        or separator is None
        or time is None
        or tokens[time[1]].text not in ("after", "of")
    ):
        return None
    return (time[1] + 1, separator), time[0].text, (separator + 1, stop), start


def _answer_first(failure: ParseFailure, start: int, stop: int) -> tuple[_Range, str, _Range, int] | None:
    """Return the parts of `b within TIME after a`."""
    tokens = failure.tokens
    for within in range(start + 1, stop):
        time = time_at(tokens, within + 1) if tokens[within].text in _TIMES else None
        if time and tokens[time[1]].text in ("after", "of"):
            return (time[1] + 1, stop), time[0].text, (start, within), within
    return None


def _separator(failure: ParseFailure, start: int, stop: int) -> int | None:
    """Return the index of the only comma outside brackets, or else of the only `then`; None if there is not one."""
    outer = tuple(outer_indices(failure.tokens, start, stop))
    commas = [index for index in outer if failure.tokens[index].type == "COMMA"]
    separators = commas or [index for index in outer if failure.tokens[index].type == "THEN"]
    return separators[0] if len(separators) == 1 else None


def _is_negation(failure: ParseFailure, begin: int, end: int) -> bool:
    """Whether the tokens from one index to another are `not` and one operand."""
    rest = [failure.tokens[index].type for index in outer_indices(failure.tokens, begin + 1, end)]
    return failure.tokens[begin].type == "NOT" and bool(rest) and not any(kind in INFIX | {"NOT"} for kind in rest)


def _is_state(failure: ParseFailure, begin: int, end: int) -> bool:
    """Whether the tokens from one index to another speak of one step, without a further comma."""
    return not any(token.type in _NO_STATES for token in failure.tokens[begin:end]) and not any(
        failure.tokens[index].type == "COMMA" for index in outer_indices(failure.tokens, begin, end)
    )
