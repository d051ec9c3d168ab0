"""Explain answers to events in English: `after alarm, hidden within 5 s`, `hidden within 5 s after alarm`."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CLAUSES, OPERATORS
from tltlc.grammar.lexer import END
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK, Time
from tltlc.grammar.mistakes.english_times import time_at
from tltlc.grammar.mistakes.negated_answers import negated_answer_error
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, TEMPORAL
from tltlc.grammar.mistakes.parse_failure import INFIX, UNTILS, ParseFailure, outer_indices
from tltlc.grammar.mistakes.repeats import TokenRange, quantified_body, repeat_error
from tltlc.grammar.mistakes.rephrasing import operand_text, suggest_rewrite, text_of

_EVENTS: Final = ("after", "when", "whenever", "if")
_TIMES: Final = ("within", "in")
_RULE: Final = "keep {head}within {t} of {a}, {b}"
_ABSENCE: Final = "keep {head}{a} implies not eventually within {t} {b}"
_FORMS: Final = {
    "keep": _RULE,
    "require": _RULE,
    "": _RULE,
    "reach": "reach {a} then within {t} {b}",
    "avoid": _ABSENCE,
}
"""How to write that ``b`` answers ``a`` within the time ``t``, by the keyword of the clause."""
_LASTING: Final = {
    **dict.fromkeys(("keep", "require", ""), "keep {head}{a} implies always for {t} {b}"),
    "avoid": "keep {head}{a} implies always for {t} not {b}",
}
"""How to write that ``b`` holds for the time ``t`` from ``a`` on."""
_NO_STATES: Final = (
    TEMPORAL | UNTILS | QUANTIFIERS | {"THEN", "ONCE", "HISTORICALLY", "PREVIOUSLY", "WHEN", "IMPLIES", "IFF"}
)


@record
class _Response:
    """An event, and what follows it within a time, or for a time if ``lasting``.

    ``word`` is the index of the English word.
    """

    event: TokenRange
    time: Time
    answer: TokenRange
    word: int
    lasting: bool = False


def response_in_english(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a clause that asks for an answer within a time, in the words of English, else None."""
    tokens = failure.tokens
    if failure.start != "clause" or tokens[-1].type != END or failure.open_brackets:
        return None
    keyword = tokens[0].text if tokens[0].text in CLAUSES else ""
    start, head = quantified_body(failure, keyword)
    stop = len(tokens) - 1
    response = (
        _event_first(failure, start, stop)
        or _time_first(failure, start, stop)
        or _answer_first(failure, start, stop)
        or _lasting_first(failure, start, stop)
    )
    if response is None:
        response = _implication(failure, start, stop)
        return None if response is None else _repeat_error(failure, keyword, head, response)
    names = declared_names(failure.source).names
    first = tokens[response.answer[0]].text
    # `no a` has its own error.
    if tokens[response.word].text in names or (first == "no" and first not in names):
        return None
    diagnostic = _repeat_error(failure, keyword, head, response)
    is_rule = _FORMS.get(keyword) == _RULE and not (head or response.lasting)
    if diagnostic is None and is_rule and _are_states(failure, response):
        time = response.time.text
        # `not b within 5 s of a` asks that no step of the time has b; before its time, `not b` may end b.
        is_first = response.event < response.answer and tokens[response.word].text in _EVENTS
        parts = (response.event, response.answer)
        diagnostic = negated_answer_error(failure, *parts, time, response.word, may_be_bare=is_first)
    clause = _clause(failure, keyword, head, response)
    if diagnostic is None and clause is not None:
        title = failure.misplaced(tokens[response.word])
        diagnostic = suggest_rewrite(failure, 0, stop, clause, title)
    return diagnostic or _unclear_error(failure, keyword, response)


def colon_after_event(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a colon in place of the comma, as in ``within 5 s of a: b``, else None."""
    tokens, at = failure.tokens, failure.stop.index
    is_after_event = any(time_at(tokens, i - 2) and tokens[i].text == "of" for i in range(3, at))
    if failure.token.type != "COLON" or "COMMA" not in failure.allowed_terminals or not is_after_event:
        return None
    return failure.error("TLT0101", "a comma stands between an event and what answers it", "write `,`", write=",")


def _repeat_error(failure: ParseFailure, keyword: str, head: str, response: _Response) -> Diagnostic | None:
    """Return an error if the answer is the event itself, else None."""
    if not _are_states(failure, response):
        return None
    parts = (response.event, response.answer)
    return repeat_error(
        failure,
        keyword,
        head,
        parts,
        response.time.text,
        word=response.word,
        lasting=response.lasting,
        may_end=response.event < response.answer,
    )


def _clause(failure: ParseFailure, keyword: str, head: str, response: _Response) -> str | None:
    """Return the clause that says the same in the language, or None if it is unclear."""
    tokens, event, answer = failure.tokens, response.event, response.answer
    forms = _LASTING if response.lasting else _FORMS
    # `reach if a, b` asks for both at one step.
    if not _are_states(failure, response) or keyword not in forms:
        return None
    if keyword == "reach" and (head or tokens[response.word].text in _EVENTS[1:]):
        return None
    form = forms[keyword]
    if any(tokens[index].type == "NOT" for index in outer_indices(tokens, *answer)):
        # `not b within 5 s` asks that no step of the 5 s has b, and `within 5 s of a, not b` for a step without b.
        is_rule = keyword in ("keep", "require", "")
        if not is_rule or not _is_negation(failure, *answer):
            return None
        if not response.lasting:
            form, answer = _ABSENCE, (answer[0] + 1, answer[1])
    text = text_of if form == _RULE else operand_text
    return form.format(
        a=text(failure, *event), b=text(failure, *answer), t=response.time.text, head=f"all {head} " if head else ""
    )


def _unclear_error(failure: ParseFailure, keyword: str, response: _Response) -> Diagnostic | None:
    """Return the error for an answer after its time that has several readings; None if the time comes last."""
    word, time = failure.tokens[response.word], response.time.text
    before = failure.tokens[response.word - 1].type
    if word.text in _EVENTS:
        return None
    if not response.lasting and before in ("EVENTUALLY", "IMPLIES"):
        help_ = (
            f"write `eventually within {time} a`: only an event stands after `of`, and what answers it after a comma"
        )
        return failure.error("TLT0101", f"`within {time} of` begins a clause", help_, span=word.span)
    if not response.lasting and before in TEMPORAL:
        return failure.error(
            "TLT0101", f"`within {time} of` begins a clause", f"write `keep within {time} of a, b`", span=word.span
        )
    if failure.lacks_fixed_clock(time):
        help_ = FIXED_CLOCK
    elif response.lasting:
        help_ = f"write `keep b implies always for {time} a` for `a for {time} after b`"
        if keyword == "reach":
            help_ = f"write `reach time_holding(a and once b) >= {time if response.time.is_real else '3 s'}`"
    elif keyword == "reach":
        help_ = f"write `reach b then within {time} a` for `reach a within {time} of b`"
    else:
        help_ = (
            f"write `keep within {time} of b, a` if `a` must come within {time} of `b`, "
            f"`keep b implies not eventually within {time} a` if it must not"
        )
    return failure.error("TLT0101", failure.misplaced(word), help_, span=word.span)


def _event_first(failure: ParseFailure, start: int, stop: int) -> _Response | None:
    """Return the parts of `after a, b within TIME` and `after a, b for TIME`."""
    tokens = failure.tokens
    separator = _separator(failure, start, stop)
    # `after a, reach b within 5 s` is read as a sentence.
    if tokens[start].text not in _EVENTS or separator is None or tokens[separator + 1].text in OPERATORS:
        return None
    for at in range(separator + 1, stop):
        time = time_at(tokens, at + 1) if tokens[at].text in (*_TIMES, "for") else None
        if time and time[1] == stop:
            lasting = tokens[at].text == "for"
            return _Response((start + 1, separator), time[0], (separator + 1, at), start, lasting)
    return None


def _time_first(failure: ParseFailure, start: int, stop: int) -> _Response | None:
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
    return _Response((time[1] + 1, separator), time[0], (separator + 1, stop), start)


def _answer_first(failure: ParseFailure, start: int, stop: int) -> _Response | None:
    """Return the parts of `b within TIME after a` and `b for TIME after a`."""
    tokens = failure.tokens
    for at in range(start + 1, stop):
        lasting = tokens[at].text == "for"
        time = time_at(tokens, at + 1) if lasting or tokens[at].text in _TIMES else None
        if time and tokens[time[1]].text in (("after",) if lasting else ("after", "of")):
            return _Response((time[1] + 1, stop), time[0], (start, at), at, lasting)
    return None


def _lasting_first(failure: ParseFailure, start: int, stop: int) -> _Response | None:
    """Return the parts of `always for TIME b after a`."""
    tokens, time = failure.tokens, time_at(failure.tokens, start + 2)
    if tokens[start].type != "ALWAYS" or tokens[start + 1].text != "for" or time is None:
        return None
    at = next((index for index in outer_indices(tokens, time[1], stop) if tokens[index].text == "after"), stop)
    if at == stop or tokens[at + 1].type == "NUMBER":
        return None
    return _Response((at + 1, stop), time[0], (time[1], at), at, lasting=True)


def _implication(failure: ParseFailure, start: int, stop: int) -> _Response | None:
    """Return the parts of `a implies b within TIME` and `a implies b for TIME`."""
    tokens = failure.tokens
    at = next((index for index in outer_indices(tokens, start, stop) if tokens[index].type == "IMPLIES"), stop)
    for last in range(at + 1, stop):
        time = time_at(tokens, last + 1) if tokens[last].text in (*_TIMES, "for") else None
        if time and time[1] == stop:
            return _Response((start, at), time[0], (at + 1, last), last, tokens[last].text == "for")
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


def _are_states(failure: ParseFailure, response: _Response) -> bool:
    """Whether the event and its answer each speak of one step."""
    return all(begin < end and _is_state(failure, begin, end) for begin, end in (response.event, response.answer))


def _is_state(failure: ParseFailure, begin: int, end: int) -> bool:
    """Whether the tokens from one index to another speak of one step, without a further comma."""
    return not any(token.type in _NO_STATES for token in failure.tokens[begin:end]) and not any(
        failure.tokens[index].type == "COMMA" for index in outer_indices(failure.tokens, begin, end)
    )
