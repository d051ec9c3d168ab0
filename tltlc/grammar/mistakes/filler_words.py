"""Explain words that mean nothing in a formula: `the`, `an`, `to be`, `either`, `both`."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.english_rewrite import clause_keyword
from tltlc.grammar.mistakes.one_reading import has_token
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure, quote_token
from tltlc.grammar.mistakes.rephrasing import formula_start, formula_stop, suggest_rewrite

_FILLERS: Final = frozenset(("the", "an", "to", "be", "being", "either", "both", "first"))
_JOINED: Final[dict[str, Collection[str]]] = {"either": {"OR"}, "both": {"AND"}, "first": {"THEN"}, "to": (), "be": ()}
"""Maps fillers that can have a meaning of their own, as in `not either`, to terminals of operators.

Beside these operators, the filler adds nothing: `either` adds nothing to `or`.
"""


def filler_word(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a filler word stands in a formula, else None.

    Examples are ``reach the exit`` and ``avoid being seen``.
    """
    at = failure.stop.index
    for index in (at - 1, at):
        word = failure.tokens[index]
        if failure.wants_operator and index > 0 and word.type == "NAME" and word.text in _FILLERS:
            title, following = f"{quote_token(word)} means nothing here", failure.tokens[index + 1]
            if following.type == "NAME" and _is_clear_filler(failure, index):
                return suggest_rewrite(failure, index, index + 2, following.text, title, " alone") or failure.error(
                    "TLT0101", title, "leave it out", span=word.span
                )
            if following.type == "NAME":
                help_ = "use a predicate, as in `near(a)`"
                if word.text in ("either", "both"):
                    help_ = "put brackets around what it joins, as in `not (a or b)` or `c and (a or b)`"
                return failure.error("TLT0101", failure.misplaced(word), help_, span=word.span)
    return None


def _is_clear_filler(failure: ParseFailure, at: int) -> bool:
    """Whether the filler word at index ``at`` can be left out.

    It can be left out if it has no other meaning, or if it begins the formula and fits all
    operators of the formula.
    """
    word, kind = failure.tokens[at].text, clause_keyword(failure)
    if word not in _JOINED:
        return True
    # `reach both a and b` may mean one after the other, and `avoid both a and b` may forbid each of them.
    if at != formula_start(failure) or (word == "both" and kind not in ("keep", "require")):
        return False
    return not has_token(failure, at, formula_stop(failure), INFIX - {*_JOINED[word]})
