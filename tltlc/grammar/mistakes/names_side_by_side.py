"""Explain two names without an operator between them, as in ``near s1``."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.fragments import is_first_on_line
from tltlc.grammar.mistakes.parse_failure import BEFORE_ONE, OPERAND, ParseFailure, quote_token
from tltlc.grammar.mistakes.rephrasing import span_of

_AFTER: Final = (
    "write `keep a implies b` for a rule about each step with `a`, `keep a implies always b` for one from then on, "
    "`reach a then b` for an order"
)


def names_side_by_side(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if two names have no operator between them, as in ``near s1``, else None."""
    before, token = failure.previous_token, failure.token
    if before is None or token.type != "NAME" or not failure.wants_operator or before.type not in ("NAME", "RPAR"):
        return None
    if is_first_on_line(failure.source, failure.tokens, failure.stop.index):
        return None
    if before.type == "RPAR" or failure.tokens[failure.stop.index + 1].type == "LPAR":
        title = f"expected an operator between {quote_token(before)} and {quote_token(token)}"
        return failure.error("TLT0101", title, "join formulas with `and`, `or` or `then`")
    if is_before_operand(failure):
        return failure.error("TLT0101", failure.misplaced(token), "join formulas with `and`, `or` or `then`")
    text = f"{before.text}({token.text})"
    known = declared_names(failure.source)
    declared = known.names.get(before.text)
    is_unknown = declared is None and not (known.names and not known.has_imports)
    takes_arguments = is_unknown or (declared is not None and bool(declared.parameters))
    if before.text == "after" and before.text not in declared_names(failure.source).names:
        return failure.error("TLT0101", failure.misplaced(before), _AFTER, span=before.span)
    help_ = f"write `{text}` if `{before.text}` applies to `{token.text}`; otherwise join them with `and` or `then`"
    title = f"a word is missing between {quote_token(before)} and {quote_token(token)}"
    if not takes_arguments:
        help_ = "join them with `and` or `then`"
    write = text if takes_arguments else None
    return failure.error("TLT0101", title, help_, span=span_of([before, token]), write=write)


def is_before_operand(failure: ParseFailure) -> bool:
    """Whether an operand, or an operator before its operand, follows the token that does not fit."""
    after = failure.tokens[failure.stop.index + 1]
    return after.type in OPERAND | BEFORE_ONE
