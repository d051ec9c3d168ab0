"""Explain comparisons in words: `coins is more than 3`, `health above 50%`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.lexer import END
from tltlc.grammar.mistakes.counts_in_words import COMPARISONS
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_rewrite import clause_keyword
from tltlc.grammar.mistakes.parse_failure import ParseFailure
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    operand_end,
    operand_start,
    phrase_at,
    span_of,
    suggest_rewrite,
    text_of,
)

COMPARISON_WORDS: Final[Mapping[tuple[str, ...], str]] = {
    **COMPARISONS,
    **dict.fromkeys((("greater", "than"), ("above",), ("over",), ("exceeds",)), ">"),
    **dict.fromkeys((("below",), ("under",)), "<"),
}
"""Maps English words between a value and a number to the sign of the comparison."""
_EQUALITIES: Final[Mapping[tuple[str, ...], str]] = {
    **dict.fromkeys((("not", "equal", "to"), ("not", "equals"), ("not", "equal"), ("unequal", "to")), "!="),
    **dict.fromkeys((("equal", "to"), ("equals",), ("equal",)), "=="),
}
"""Maps English words for equality to the signs for integers; an enum takes `is`."""
_NUMBERS: Final = ("number", "int", "ratio")
"""The types of what is counted with a number without a unit."""


def comparison_in_words(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a comparison is written in words, else None.

    Examples are ``coins is more than 3`` and ``health above 50%``.
    """
    at = failure.stop.index
    if not failure.wants_operator or failure.token.type not in ("NAME", "NOT"):
        return None
    number_first = _number_first(failure)
    if number_first is not None:
        return number_first
    words = [token.text for token in failure.tokens[at : at + 4]]
    has_verb = words[0] in ("is", "are")
    for phrase, sign in {**COMPARISON_WORDS, **_EQUALITIES}.items():
        length = has_verb + len(phrase)
        if tuple(words[has_verb:length]) != phrase:
            continue
        value = failure.tokens[at + length].type
        if _type_before(failure, at) == "bool":
            continue  # `finished under 90 s` is about a time
        if phrase in _EQUALITIES:
            kind = _type_before(failure, at)
            if kind not in ("int", "enum"):
                continue
            sign = sign if kind == "int" else "is" if sign == "==" else "is not"
        first = operand_start(failure.tokens, at)
        is_end = at + length + 1 < len(failure.tokens) and failure.tokens[at + length + 1].type == END
        is_goal = clause_keyword(failure) == "reach" and first == formula_start(failure) and is_end
        # `reach health below 20` is a goal; `reach coins at most 50` may be a rule.
        if is_goal and sign == "<=" and value == "NUMBER":
            title, number = failure.misplaced(failure.token), failure.tokens[at + length].text
            return _small_goal(failure, text_of(failure, 1, at), sign, number, title)
        if value == "NUMBER" or (value == "NAME" and phrase[0] not in ("at", "up")):
            title, span = failure.misplaced(failure.token), span_of(failure.tokens[at : at + length])
            return failure.error("TLT0101", title, f"write `{sign}`", span=span, write=sign)
    return None


def _type_before(failure: ParseFailure, stop: int) -> str:
    """Return the declared type of the name before an index, or "" if there is none."""
    start = operand_start(failure.tokens, stop)
    return "" if start is None else declared_names(failure.source).type_of(failure.tokens[start].text)


def _small_goal(failure: ParseFailure, value: str, sign: str, number: str, title: str) -> Diagnostic:
    """Return the error for `reach at most 50 coins`, which the first step may meet."""
    text = f"{value} {sign} {number}"
    help_ = f"write `keep {text}` if it must hold at every step, `reach {text}` if one step with it is enough"
    return failure.error("TLT0101", title, help_, span=span_of(failure.tokens[:-1]))


def _number_first(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a comparison with its number before the name, as in ``at most 3 coins``, else None."""
    tokens, at = failure.tokens, failure.stop.index
    for start in range(max(formula_start(failure), at - 2), at):
        phrase = phrase_at(tokens, start, COMPARISONS)
        number = start + len(phrase)
        if not phrase or tokens[number].type != "NUMBER":
            continue
        sign, title = COMPARISONS[phrase], failure.misplaced(tokens[start])
        stop = operand_end(tokens, number + 1)
        is_compared = stop is not None and declared_names(failure.source).type_of(tokens[number + 1].text) in _NUMBERS
        is_goal = clause_keyword(failure) == "reach" and start == formula_start(failure)
        if stop is not None and is_compared and is_goal and sign in ("<=", "<") and tokens[stop].type == END:
            return _small_goal(failure, text_of(failure, number + 1, stop), sign, tokens[number].text, title)
        if stop is not None and is_compared:
            text = f"{text_of(failure, number + 1, stop)} {sign} {tokens[number].text}"
            return suggest_rewrite(failure, start, stop, text, title)
        if stop is not None and declared_names(failure.source).type_of(tokens[number + 1].text) == "bool":
            text = f"times({text_of(failure, number + 1, stop)}) {sign} {tokens[number].text}"
            return suggest_rewrite(failure, start, stop, text, title, ", which counts how often it has begun")
        help_ = f"write `{sign}` between a value and its limit, as in `coins {sign} {tokens[number].text}`"
        return failure.error("TLT0101", title, help_, span=span_of(tokens[start:number]))
    return None
