"""Explain a condition behind a rule: `keep a implies b unless c`, `keep a implies eventually within 5 s b when c`."""

from __future__ import annotations

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CONDITIONS
from tltlc.grammar.mistakes.english_rewrite import clause_keyword
from tltlc.grammar.mistakes.english_times import time_at
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, has_always_before, has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    last_index_of,
    operand_text,
    suggest_rewrite,
    text_of,
)


def condition_behind_rule(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for an English condition behind a rule about each step, else None.

    If the answer may come later, the condition may be about the step of the event or about that of the answer:
    then the help names both.
    """
    tokens, at = failure.tokens, failure.stop.index
    start, stop, word = formula_start(failure), formula_stop(failure), tokens[at].text
    implies = last_index_of(failure, {"IMPLIES"}, start)
    is_kept = clause_keyword(failure) == "keep" or has_always_before(failure)
    if not is_kept or implies is None or word not in ("unless", *CONDITIONS) or at + 1 >= stop:
        return None
    answer, timed = implies + 1, ""
    if tokens[answer].type in ("EVENTUALLY", "NEXT"):
        time = time_at(tokens, answer + 2) if tokens[answer + 1].text in ("within", "after") else None
        answer = time[1] if time else answer + 1
        timed = f"{text_of(failure, implies + 1, answer)} "
    parts = ((start, implies), (answer, at), (at + 1, stop))
    if not all(first < end and is_of_one_step(failure, first, end) for first, end in parts):
        return None
    if has_token(failure, start, implies, INFIX - {"AND"}) or has_token(failure, answer, stop, {*INFIX, *QUANTIFIERS}):
        return None
    event, state = text_of(failure, start, implies), text_of(failure, answer, at)
    condition, negated = text_of(failure, at + 1, stop), f"not {operand_text(failure, at + 1, stop)}"
    if tokens[at + 1].type == "NOT":
        negated = text_of(failure, at + 2, stop)
    elif not (tokens[at + 1].type == "NAME" and stop == at + 2):
        negated = f"not ({condition})"
    title, is_exception = failure.misplaced(tokens[at]), word == "unless"
    first = f"{event} and {negated if is_exception else condition} implies {timed}{state}"
    second = f"{event} implies {timed}({state} {'or' if is_exception else 'and'} {condition})"
    readings = [first, second] if timed else [f"{event} implies {state} or {condition}" if is_exception else first]
    if not all(suggest_rewrite(failure, start, stop, text, title) for text in readings):
        return None
    before, behind = text_of(failure, 0, start), text_of(failure, stop, len(tokens) - 1)
    before += " " * (tokens[start - 1].type != "LPAR")
    readings = [f"{before}{text}{behind}" for text in readings]
    if not timed:
        return failure.error("TLT0101", title, f"write `{readings[0]}`")
    first, second = readings
    if is_exception and event == f"begins {negated}":
        return failure.error("TLT0101", title, f"write `{second}`")  # the event excludes the exception
    help_ = (
        f"write `{first}` if `{condition}` is about the step with `{event}`, `{second}` if it is about that of "
        f"`{state}`"
    )
    return failure.error("TLT0101", title, help_)
