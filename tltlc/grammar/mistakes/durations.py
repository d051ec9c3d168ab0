"""Explain how long something holds, in English: `hidden for at least 3 s`, `mode is chase for at most 10 s`."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.counts_in_words import COMPARISONS
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_rewrite import Time
from tltlc.grammar.mistakes.english_times import time_at
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure
from tltlc.grammar.mistakes.repeats import quantified_body
from tltlc.grammar.mistakes.rephrasing import (
    last_index_of,
    operand_text,
    phrase_at,
    suggest_rewrite,
    text_of,
    without_brackets,
)

_COMPARISONS: Final = {**COMPARISONS, ("longer", "than"): ">", ("no", "longer", "than"): "<=", ("over",): ">"}
_FORMS: Final = {
    **{("reach", sign): "reach time_holding({p}) {sign} {t}" for sign in (">=", ">")},
    **{
        (keyword, sign): "keep {all}time_holding({p}) {sign} {t}"
        for keyword in ("keep", "require")
        for sign in ("<=", "<")
    },
    **{
        (keyword, sign): "avoid {any}time_holding({p}) {sign} {t}"
        for keyword in ("avoid", "never")
        for sign in (">=", ">")
    },
}
"""Clauses for a time for which a formula holds, by the keyword of the clause and the comparison."""
_LONG_ENOUGH: Final = (
    "write `require always for {written} {p}` if it must hold from the first step on, "
    "`keep begins {p} implies always for {written} {p}` each time that it begins, "
    "`reach time_holding({p}) >= {t}` at some time"
)
_AFTER_CONDITION: Final = (
    "write `always for {written} {p}` if it must hold from then on, "
    "`time_holding({p}) {sign} {t}` if it must have held so far"
)


def duration_in_words(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a formula with a time for which it holds, as in ``hidden for at least 3 s``, else None."""
    tokens, stop = failure.tokens, len(failure.tokens) - 1
    at = next((index for index in range(1, stop) if tokens[index].text == "for"), 0)
    phrase = phrase_at(tokens, at + 1, _COMPARISONS)
    written = time_at(tokens, at + 1 + len(phrase))
    if not at or not phrase or written is None or written[1] != stop or failure.start != "clause":
        return None
    keyword = tokens[0].text.lower()
    begin, head = quantified_body(failure, tokens[0].text)
    time, title = _in_seconds(failure, written[0]), failure.misplaced(tokens[at])
    sign, condition = _COMPARISONS[phrase], last_index_of(failure, {"IMPLIES"}, begin)
    second = begin if condition is None else condition + 1
    is_one = second < at and is_of_one_step(failure, begin, at)
    is_one = is_one and not has_token(failure, second, at, {*INFIX, *QUANTIFIERS})
    if not is_one or time is None:
        help_ = "`time_holding(p)` is how long `p` has held, in seconds: compare it, as in `time_holding(p) >= 3 s`"
        return failure.error("TLT0101", title, help_, span=tokens[at].span)
    operand = text_of(failure, *without_brackets(failure, second, at))
    if condition is not None and sign in (">=", ">"):
        help_ = _AFTER_CONDITION.format(p=operand, t=time, sign=sign, written=written[0].text)
        return failure.error("TLT0101", title, help_, span=tokens[at].span)
    quantifiers = {word: f"{word} {head} " if head else "" for word in ("all", "any")}
    form = _FORMS.get((keyword, sign)) if condition is None else None
    if form is not None:
        text = form.format(p=operand, sign=sign, t=time, **quantifiers)
        return suggest_rewrite(failure, 0, stop, text, title)
    help_ = (
        f"`time_holding({operand})` is how long it has held: compare it, as in `time_holding({operand}) {sign} {time}`"
    )
    if keyword in ("keep", "require") and condition is None and not head:
        help_ = _LONG_ENOUGH.format(p=operand_text(failure, begin, at), t=time, written=written[0].text)
    return failure.error("TLT0101", title, help_, span=tokens[at].span)


def _in_seconds(failure: ParseFailure, time: Time) -> str | None:
    """Return the time for which a timer counts, or None if it is no round number of seconds.

    A timer counts from one sample to another: what holds for 10 steps has held for the time of 9.
    """
    if time.is_real:
        return time.text
    length = (float(time.number) - 1) * declared_names(failure.source).step_s
    seconds = f"{length:.6g}"
    return f"{seconds} s" if length > 0 and abs(float(seconds) - length) < 1e-12 else None
