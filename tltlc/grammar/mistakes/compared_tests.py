"""Explain a comparison of a test with a number: `mode is chase <= 3`, `times(p) since mode is chase <= 3`."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.parse_failure import COMPARISONS, ParseFailure, quote_token
from tltlc.grammar.mistakes.rephrasing import operand_end, operand_start, text_of
from tltlc.grammar.past_words import SINCE

COUNT_SINCE: Final = (
    "`{function}({counted})` is about all steps so far, "
    "`{function}_since({counted}, {event})` about those from the last step with `{event}` on"
)


def compared_test(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a comparison of what is true or false, else None.

    Examples are ``mode is chase <= 3`` and ``times(p) since x > 3 <= 2``.
    """
    tokens, at = failure.tokens, failure.stop.index
    if failure.token.type not in COMPARISONS or at < 3:
        return None
    start = _test_start(failure)
    test, sign = text_of(failure, start or 0, at), failure.token.text
    title = f"{quote_token(failure.token)} compares numbers, and `{test}` is true or false"
    since = next((index for index in range(at - 1, 0, -1) if tokens[index].text == "since"), 0)
    counted = operand_start(tokens, since) if since else None
    if counted is not None and tokens[counted].text in SINCE and operand_end(tokens, counted) == since:
        if start is None:
            title = "comparisons cannot be chained"
        comma = next((index for index in range(counted + 2, since) if tokens[index].text == ","), since - 1)
        texts = text_of(failure, counted + 2, comma), text_of(failure, since + 1, at)
        help_ = COUNT_SINCE.format(function=tokens[counted].text, counted=texts[0], event=texts[1])
    elif start is None:
        return None
    elif tokens[at + 1].type == "NUMBER":
        is_time = tokens[at + 2].type == "UNIT"
        number, call = text_of(failure, at + 1, at + 2 + is_time), f"times({test})"
        does = "count how often it begins"
        if is_time:
            call, does = f"time_holding({test})", "say how long it has held"
        help_ = f"write `{test}` alone, or {does}, as in `{call} {sign} {number}`"
    else:
        help_ = f"write `{test}` alone"
    return failure.error("TLT0110", title, help_)


def _test_start(failure: ParseFailure) -> int | None:
    """Return the index where the test of an enum begins that ends where parsing failed, else None."""
    tokens, at = failure.tokens, failure.stop.index
    verb = at - 2 - (tokens[at - 2].type == "NOT")
    start = operand_start(tokens, verb) if verb > 0 and tokens[verb].text == "is" else None
    known = None if start is None else declared_names(failure.source).names.get(tokens[start].text)
    return start if known is not None and tokens[at - 1].text in known.values else None
