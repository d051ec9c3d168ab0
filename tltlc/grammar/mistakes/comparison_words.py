"""Explain comparisons in words: `coins is more than 3`, `health above 50%`."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.parse_failure import ParseFailure, quote_token
from tltlc.grammar.mistakes.rephrasing import span_of

_COMPARISONS: Final = {
    ("at", "least"): ">=",
    ("at", "most"): "<=",
    **dict.fromkeys((("more", "than"), ("greater", "than"), ("above",), ("over",), ("exceeds",)), ">"),
    **dict.fromkeys((("less", "than"), ("below",), ("under",)), "<"),
}


def comparison_in_words(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a comparison is written in words, else None.

    Examples are ``coins is more than 3`` and ``health above 50%``.
    """
    at = failure.stop.index
    if not failure.wants_operator or failure.token.type != "NAME":
        return None
    words = [token.text for token in failure.tokens[at : at + 3]]
    has_verb = words[0] in ("is", "are")
    for phrase, sign in _COMPARISONS.items():
        length = has_verb + len(phrase)
        if tuple(words[has_verb:length]) != phrase:
            continue
        value = failure.tokens[at + length].type
        if value == "NUMBER" or (value == "NAME" and phrase[0] != "at"):
            title, span = f"{quote_token(failure.token)} is not an operator", span_of(failure.tokens[at : at + length])
            return failure.error("TLT0101", title, f"write `{sign}`", span=span, write=sign)
    return None
