"""Explain a time after an event inside a rule: `dash implies hidden within 2 s of alarm`.

`within 2 s of alarm, dash implies hidden` would be met by any step without a dash.
"""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK
from tltlc.grammar.mistakes.english_times import time_at
from tltlc.grammar.mistakes.one_reading import TEMPORAL, has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure, outer_indices
from tltlc.grammar.mistakes.rephrasing import operand_text, text_of
from tltlc.grammar.mistakes.sentences.validity import is_valid

_RULES: Final = ("IMPLIES", "IFF")
_GENERAL: Final = (
    "inside a rule, write `b and once within {t} a` for `b within {t} of a`: `b` holds, and `a` at most {t} before it"
)
_FORMS: Final = {
    "IMPLIES": "write `{k} {c} and {a} implies eventually within {t} {b}` if `{b}` must come within {t} of a step with "
    "both, `{k} {c} implies {b} and once within {t} {a}` if it must hold at each step with `{c}`, and `{a}` at most "
    "{t} before it",
    "IFF": "write `{k} {c} iff {b} and once within {t} {a}`: `{b}` holds, and `{a}` at most {t} before it",
}
"""How to write a rule that ends with an answer within a time, by the operator before it."""
_CONDITION: Final = "write `{k} {b} and once within {t} {a} {op} {c}`: `{b}` holds, and `{a}` at most {t} before it"


def answer_in_rule(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for an answer within a time beside `implies` or `iff`, in the words of English, else None."""
    tokens, stop, keyword = failure.tokens, len(failure.tokens) - 1, failure.tokens[0].text
    if failure.start != "clause" or keyword not in ("keep", "require") or failure.open_brackets:
        return None
    outer = [*outer_indices(tokens, 1, stop)]
    within = next((i for i in outer if tokens[i].text in ("within", "in") and time_at(tokens, i + 1)), 0)
    written = time_at(tokens, within + 1)
    operators = [index for index in outer if tokens[index].type in _RULES]
    if within < 2 or written is None or tokens[written[1]].text not in ("of", "after") or not operators:
        return None
    if tokens[within - 1].type in TEMPORAL | INFIX:
        return None  # `eventually within 2 s of b`
    time, event = written[0].text, written[1] + 1
    title, span = failure.misplaced(tokens[within]), tokens[within].span
    if failure.lacks_fixed_clock(time):
        return failure.error("TLT0101", title, FIXED_CLOCK, span=span)
    at, op = operators[0], tokens[operators[0]].text
    is_last = at < within
    rest, answer = ((1, at), (at + 1, within)) if is_last else ((at + 1, stop), (1, within))
    parts = (rest, answer, (event, stop if is_last else at))
    are_clear = len(operators) == 1 and all(
        begin < end and is_of_one_step(failure, begin, end) and not has_token(failure, begin, end, {"COMMA"})
        for begin, end in parts
    )
    if not are_clear or has_token(failure, *answer, {"NOT", *INFIX}):
        return failure.error("TLT0101", title, _GENERAL.format(t=time), span=span)
    form = _FORMS[tokens[at].type] if is_last else _CONDITION
    # At the end of a rule, what stands there alone needs no brackets.
    c, b, a = (operand_text(failure, *part) for part in parts)
    if not is_last:
        c = text_of(failure, *rest)
    help_ = form.format(k=keyword, a=a, b=b, c=c, t=time, op=op)
    if not is_valid([text for text in help_.split("`")[1::2] if text.startswith(keyword)]):
        help_ = _GENERAL.format(t=time)  # a word in it is not read
    return failure.error("TLT0101", title, help_, span=span)
