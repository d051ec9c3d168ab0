"""Explain rules about an event that repeats: `avoid hit within 1 s of hit`, `keep dash implies not dash for 2 s`.

The event itself is within that time, so a rule about each step of the time would forbid it altogether.
"""

from __future__ import annotations

from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK
from tltlc.grammar.mistakes.parse_failure import ParseFailure, outer_indices
from tltlc.grammar.mistakes.rephrasing import operand_text, suggest_rewrite, text_of, without_brackets

TokenRange = tuple[int, int]
"""The indices of the first token, and after the last token."""
_QUANTIFIED: Final = {"keep": "ALL", "require": "ALL", "": "ALL", "avoid": "ANY"}
"""The quantifier with which a clause speaks of each entity by itself, by the keyword of the clause."""


@record
class Happening:
    """What a rule says of a formula: that it holds, begins to hold if ``begins``, or not if ``is_negated``."""

    text: str
    begins: bool
    is_negated: bool


def happening(failure: ParseFailure, part: TokenRange) -> Happening:
    """Return what the tokens of a part say, such as `not hit`, `begins hit` and `(hit)`."""
    tokens = failure.tokens
    begin, end = without_brackets(failure, *part)
    is_negated = tokens[begin].type == "NOT"
    begin, end = without_brackets(failure, begin + is_negated, end)
    begins = tokens[begin].type == "BEGINS"
    begin, end = without_brackets(failure, begin + begins, end)
    return Happening(operand_text(failure, begin, end), begins, is_negated)


def begun_again(operand: str, time: str, head: str = "") -> str:
    """Return the clause that forbids an operand to begin again within a time.

    ``head`` is that of a quantifier over the clause, without the quantifier, such as ``p in pits:``.
    """
    event = operand if operand.startswith("begins ") else f"begins {operand}"
    return f"avoid {f'any {head} ' if head else ''}({event}) then within {time} ({event})"


def repeat_error(
    failure: ParseFailure,
    keyword: str,
    head: str,
    parts: tuple[TokenRange, TokenRange],
    time: str,
    *,
    word: int,
    lasting: bool,
    may_end: bool = False,
) -> Diagnostic | None:
    """Return an error if what follows an event within a time, or for a time, is the event itself, else None.

    ``parts`` are the event and what follows it. ``keyword`` is that of the clause, and ``head`` that of a
    quantifier over it, without the quantifier. ``word`` is the index of the English word. ``may_end``
    says that `not hit` within the time may ask that the event ends.
    """
    event, again = (happening(failure, part) for part in parts)
    if event.text != again.text or event.is_negated or (keyword == "avoid" and again.is_negated):
        return None
    title, span = failure.misplaced(failure.tokens[word]), failure.tokens[word].span
    if failure.lacks_fixed_clock(time):
        return failure.error("TLT0101", title, FIXED_CLOCK, span=span)
    operand, is_absent = event.text, keyword == "avoid" or again.is_negated
    one_by_one = f"all {head} " if head else ""
    text, reason = "", ""
    if is_absent and keyword != "reach":
        text = begun_again(operand, time, head)
        if may_end and not lasting and keyword != "avoid" and not again.begins:
            ends = f"keep {one_by_one}{operand} implies eventually within {time} not {operand}"
            help_ = f"write `{ends}` if it must end in that time, `{text}` if it must not begin again"
            return failure.error("TLT0101", title, help_, span=span)
        # Where frames differ, a time behind `weak_next` does not count from the event.
        if lasting and not again.begins and not failure.clock_varies:
            steps = f"keep {one_by_one}begins {operand} implies weak_next always for {time} not {operand}"
            reason = f" if it must not begin again, `{steps}` if it must also end at the next step"
    elif keyword == "reach" and not (is_absent or lasting or head):
        text = f"reach begins {operand} then within {time} begins {operand}"
    elif lasting and keyword != "reach":
        text = f"keep {one_by_one}begins {operand} implies always for {time} {operand}"
    if text and event.begins and again.begins:
        return suggest_rewrite(failure, 0, len(failure.tokens) - 1, text, title)
    help_ = f"write `{text}`{reason}" if text else f"`{operand}` holds at that step itself: say what must follow it"
    return failure.error("TLT0101", title, help_, span=span)


def quantified_body(failure: ParseFailure, keyword: str) -> tuple[int, str]:
    """Return the index after the keyword of a clause and its quantifier, and the head, such as ``p in pits:``.

    The quantifier must speak of each entity by itself; else the head is empty.
    """
    tokens, start = failure.tokens, bool(keyword)
    if tokens[start].type == _QUANTIFIED.get(keyword):
        for index in outer_indices(tokens, start, len(tokens) - 1):
            if tokens[index].type == "COLON":
                return index + 1, text_of(failure, start + 1, index + 1)
    return int(start), ""
