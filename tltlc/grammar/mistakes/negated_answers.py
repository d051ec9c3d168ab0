"""Explain a negation that must hold within a time after an event: `mode is not alert within 2 s of alarm`.

It may ask for one step of that time without the state, or for no step with it.
"""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK
from tltlc.grammar.mistakes.english_times import time_at
from tltlc.grammar.mistakes.one_reading import has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure, outer_indices
from tltlc.grammar.mistakes.rephrasing import operand_text, text_of

_READINGS: Final = (
    "write `keep {event} implies not eventually within {time} {state}` if `{state}` must hold at no step of that "
    "time, `keep within {time} of {event_text}, {answer}` if one step without it is enough"
)
_READINGS_IN_RULE: Final = (
    "write `not eventually within {time} {state}` if `{state}` must hold at no step of that time, "
    "`eventually within {time} {answer}` if one step without it is enough"
)


def negated_answer_in_rule(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a rule such as ``alarm implies mode is not alert within 2 s``, else None."""
    tokens, stop = failure.tokens, len(failure.tokens) - 1
    if failure.start != "clause" or tokens[0].text not in ("keep", "require") or failure.open_brackets:
        return None
    begin = next((i + 1 for i in outer_indices(tokens, 1, stop) if tokens[i].type == "IMPLIES"), stop)
    within = next((i for i in range(begin, stop) if tokens[i].text in ("within", "in")), stop)
    written = time_at(tokens, within + 1)
    if written is None or written[1] != stop or not is_of_one_step(failure, begin, within):
        return None
    state = _negated_state(failure, begin, within, may_be_bare=True)
    if state is None or has_token(failure, begin, within, {"COMMA"}):
        return None
    title, time, span = failure.misplaced(tokens[within]), written[0].text, tokens[within].span
    if failure.lacks_fixed_clock(time):
        return failure.error("TLT0101", title, FIXED_CLOCK, span=span)
    help_ = _READINGS_IN_RULE.format(time=time, state=state, answer=text_of(failure, begin, within))
    return failure.error("TLT0101", title, help_, span=span)


def negated_answer_error(
    failure: ParseFailure,
    event: tuple[int, int],
    answer: tuple[int, int],
    time: str,
    word: int,
    *,
    may_be_bare: bool = False,
) -> Diagnostic | None:
    """Return the error for an answer that is a negation in brackets, `is not` or `!=`, else None.

    ``event`` and ``answer`` are ranges of token indices, and ``word`` is the index of the English word.
    ``may_be_bare`` is that of :func:`_negated_state`.
    """
    state = _negated_state(failure, *answer, may_be_bare=may_be_bare)
    if state is None:
        return None
    help_ = _READINGS.format(
        event=operand_text(failure, *event),
        event_text=text_of(failure, *event),
        state=state,
        answer=text_of(failure, *answer),
        time=time,
    )
    return failure.error("TLT0101", failure.misplaced(failure.tokens[word]), help_, span=failure.tokens[word].span)


def _negated_state(failure: ParseFailure, begin: int, end: int, *, may_be_bare: bool = False) -> str | None:
    """Return what the tokens from one index to another deny: `mode is alert` of `mode is not alert`; else None.

    Take a bare `not alert` only if ``may_be_bare``: before `of`, it asks that no step of the time has it.
    """
    tokens, is_bracketed = failure.tokens, may_be_bare
    while tokens[begin].type == "LPAR" and [*outer_indices(tokens, begin, end)] == [begin, end - 1]:
        begin, end, is_bracketed = begin + 1, end - 1, True
    outer = [*outer_indices(tokens, begin, end)]
    signs = [index for index in outer if tokens[index].type in ("NOT", "UNEQUAL")]
    if len(signs) != 1 or any(tokens[index].type in INFIX for index in outer):
        return None
    (sign,) = signs
    before, after = text_of(failure, begin, sign), text_of(failure, sign + 1, end)
    if sign > begin:
        return f"{before} == {after}" if tokens[sign].type == "UNEQUAL" else f"{before} {after}"
    return after if is_bracketed else None
