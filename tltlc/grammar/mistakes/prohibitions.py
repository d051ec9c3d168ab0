"""Explain `never` before states, alone or joined: `never alarm`, `never alarm and seen`, `never alarm or seen`."""

from __future__ import annotations

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure, outer_indices
from tltlc.grammar.mistakes.rephrasing import operand_text, suggest_rewrite, text_of


def never_states(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for `never` before a state, or states that are joined by `and`, or by `or`, else None."""
    tokens, stop = failure.tokens, len(failure.tokens) - 1
    if failure.start != "clause" or failure.stop.index or tokens[0].text.lower() != "never":
        return None
    joints = [index for index in outer_indices(tokens, 1, stop) if tokens[index].type in INFIX]
    kinds = {tokens[index].type for index in joints}
    are_states = is_of_one_step(failure, 1, stop) and not has_token(failure, 1, stop, QUANTIFIERS)
    if kinds not in (set(), {"AND"}, {"OR"}) or not are_states:
        return None
    title, text = "a clause cannot begin with `never`", f"avoid {text_of(failure, 1, stop)}"
    if not suggest_rewrite(failure, 0, stop, text, title):
        return None
    if not kinds:
        message = "did you mean `avoid`?"
        return failure.error("TLT0107", title, f"write `{text}`", message, tokens[0].span, write="avoid")
    if kinds == {"OR"}:
        # It might also be meant as `(not a) or b`.
        return failure.error("TLT0107", title, f"write `{text}` if none of them may ever hold", span=tokens[0].span)
    starts, stops = [1, *(index + 1 for index in joints)], [*joints, stop]
    either = " or ".join(operand_text(failure, *part) for part in zip(starts, stops, strict=True))
    help_ = f"write `{text}` if they must not hold at the same step, `avoid {either}` if none of them may ever hold"
    return failure.error("TLT0107", title, help_, span=tokens[0].span)
