"""Explain rules in English: `jump only if grounded`, `opens requires key`, `health never below 30`, `falls by 30`."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CONDITIONS
from tltlc.grammar.mistakes.comparison_words import COMPARISON_WORDS
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_rewrite import clause_keyword
from tltlc.grammar.mistakes.one_reading import has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure, quote_token
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    operand_start,
    operand_text,
    phrase_at,
    suggest_rewrite,
)

_NEEDS: Final = ("requires", "needs")
_CHANGES: Final = {
    **dict.fromkeys(("falls", "drops", "decreases", "shrinks"), ("previous({x}) - {x}", "highest({x}) - {x}")),
    **dict.fromkeys(("rises", "increases", "grows"), ("{x} - previous({x})", "{x} - lowest({x})")),
}
"""How to write how far a value has changed in one step, and since its extreme, by the verb."""


def rule_in_words(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a rule in the words of English, else None."""
    if not failure.wants_operator or failure.previous_token is None or failure.tokens[0].type == "PREDICATE":
        return None
    return _only(failure) or _needs(failure) or _never_compared(failure) or _changed(failure)


def _only(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for `a only if b` and `a only after b`, else None."""
    tokens, at = failure.tokens, failure.stop.index
    word = tokens[at + 1].text if at + 1 < len(tokens) else ""
    if tokens[at].text != "only" or word not in (*CONDITIONS, "after"):
        return None
    form = "{a} implies once {b}" if word == "after" else "{a} implies {b}"
    title, sides = f"`only {word}` is not an operator", _sides(failure, at, at + 2)
    if sides is not None and clause_keyword(failure) == "keep":
        text = form.format(a=sides[0], b=sides[1])
        return suggest_rewrite(failure, formula_start(failure), formula_stop(failure), text, title)
    help_ = f"write a clause `keep {form.format(a='a', b='b')}` for `a only {word} b`"
    return failure.error("TLT0101", title, help_)


def _needs(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for `a requires b`, else None."""
    at = failure.stop.index
    if failure.token.text not in _NEEDS or failure.token.text in declared_names(failure.source).names:
        return None
    first, second = _sides(failure, at, at + 1) or ("a", "b")
    help_ = (
        f"write `keep {first} implies {second}` if both must hold at the same step, "
        f"`keep {first} implies once {second}` if `{second}` may have held before"
    )
    return failure.error("TLT0101", f"{quote_token(failure.token)} is not an operator", help_)


def _sides(failure: ParseFailure, at: int, second: int) -> tuple[str, str] | None:
    """Return the texts of two formulas, before ``at`` and from ``second`` on; None if they are not of one step."""
    begin, stop = formula_start(failure), formula_stop(failure)
    if begin >= at or second >= stop or has_token(failure, begin, at, INFIX) or failure.open_brackets:
        return None
    if has_token(failure, second, stop, INFIX - {"AND", "OR"}) or not is_of_one_step(failure, begin, stop):
        return None
    return operand_text(failure, begin, at), operand_text(failure, second, stop)


def _never_compared(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for `keep health never below 30`, else None."""
    tokens, at, stop = failure.tokens, failure.stop.index, len(failure.tokens) - 1
    second = at + 1 + (tokens[at + 1 : at + 2] != [] and tokens[at + 1].text in (*_CHANGES, "goes", "is"))
    phrase = phrase_at(tokens, second, COMPARISON_WORDS)
    value = second + len(phrase)
    is_whole = operand_start(tokens, at) == 1 and clause_keyword(failure) in ("keep", "require")
    if tokens[at].text != "never" or not phrase or not is_whole or tokens[value].type != "NUMBER":
        return None
    text = f"avoid {operand_text(failure, 1, at)} {COMPARISON_WORDS[phrase]} {operand_text(failure, value, stop)}"
    return suggest_rewrite(failure, 0, stop, text, "`never` is not an operator")


def _changed(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for `health falls by more than 30`, else None."""
    tokens, at = failure.tokens, failure.stop.index
    start = operand_start(tokens, at)
    if tokens[at].text not in _CHANGES or tokens[at + 1].text != "by" or start is None:
        return None
    operand = operand_text(failure, start, at)
    one, all_ = (form.format(x=operand) for form in _CHANGES[tokens[at].text])
    phrase = phrase_at(tokens, at + 2, COMPARISON_WORDS)
    value = tokens[at + 2 + len(phrase)]
    compared = f" {COMPARISON_WORDS.get(phrase, '>=')} {value.text if value.type == 'NUMBER' else '10'}"
    help_ = (
        f"write `{one}{compared}` for a change from one step to the next, "
        f"`{all_}{compared}` for one since its {'highest' if 'highest' in all_ else 'lowest'} value"
    )
    return failure.error("TLT0101", f"{quote_token(tokens[at])} is not an operator", help_)
