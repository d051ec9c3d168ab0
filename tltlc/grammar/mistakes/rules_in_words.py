"""Explain rules in English: `jump only if grounded`, `opens requires key`, `health never below 30`, `falls by 30`."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CONDITIONS
from tltlc.grammar.mistakes.comparison_words import COMPARISON_WORDS
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK, clause_keyword
from tltlc.grammar.mistakes.english_times import time_at
from tltlc.grammar.mistakes.one_reading import has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure
from tltlc.grammar.mistakes.repeats import begun_again, quantified_body
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    operand_start,
    operand_text,
    phrase_at,
    suggest_rewrite,
    text_of,
)

_NEEDS: Final = ("requires", "needs")
_CHANGES: Final = {
    **dict.fromkeys(("falls", "drops", "decreases", "shrinks"), ("previous({x}) - {x}", "highest({x}) - {x}")),
    **dict.fromkeys(("rises", "increases", "grows"), ("{x} - previous({x})", "{x} - lowest({x})")),
}
"""How to write how far a value has changed in one step, and since its extreme, by the verb."""
_LIMITS: Final = ("below", "under", "above", "over")
"""Words after a verb such as `falls` that compare the value itself, not its change."""


def rule_in_words(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a rule in the words of English, else None."""
    if not failure.wants_operator or failure.previous_token is None or failure.tokens[0].type == "PREDICATE":
        return None
    return (
        _only(failure)
        or _needs(failure)
        or _again(failure)
        or _for_the_next(failure)
        or _never_compared(failure)
        or _changed(failure)
    )


def _only(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for `a only if b` and `a only after b`, else None."""
    tokens, at = failure.tokens, failure.stop.index
    word = tokens[at + 1].text if at + 1 < len(tokens) else ""
    if tokens[at].text != "only" or word not in (*CONDITIONS, "after"):
        return None
    form = "{a} implies once {b}" if word == "after" else "{a} implies {b}"
    title, sides = failure.misplaced(tokens[at]), _sides(failure, at, at + 2)
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
    if second.startswith("once "):
        help_ = f"write `keep {first} implies {second}`"
        return failure.error("TLT0101", failure.misplaced(failure.token), help_)
    help_ = (
        f"write `keep {first} implies {second}` if both must hold at the same step, "
        f"`keep {first} implies once {second}` if `{second}` may have held before"
    )
    return failure.error("TLT0101", failure.misplaced(failure.token), help_)


def _again(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for `avoid a again within 5 s`, else None."""
    tokens, at = failure.tokens, failure.stop.index
    start, time = operand_start(tokens, at), time_at(tokens, at + 2)
    if tokens[at].text != "again" or tokens[at + 1].text not in ("within", "in") or start is None or time is None:
        return None
    body, head = quantified_body(failure, tokens[0].text)
    title, length = failure.misplaced(tokens[at]), time[0].text
    if failure.lacks_fixed_clock(length):
        return failure.error("TLT0101", title, FIXED_CLOCK)
    is_whole = clause_keyword(failure) == "avoid" and start == body and time[1] == len(tokens) - 1
    operand, head = (text_of(failure, start, at), head) if is_whole else ("a", "")
    return failure.error("TLT0101", title, f"write `{begun_again(operand, length, head)}`")


def _for_the_next(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for `a for the next 5 s`, else None."""
    tokens, at = failure.tokens, failure.stop.index
    words, start, time = (
        [token.text for token in tokens[at : at + 3]],
        operand_start(tokens, at),
        time_at(tokens, at + 3),
    )
    if words != ["for", "the", "next"] or start is None or time is None:
        return None
    title, length = failure.misplaced(tokens[at]), time[0].text
    operand = text_of(failure, start, at)
    help_ = f"write `always for {length} {operand}`, whose time begins at this step"
    return failure.error("TLT0101", title, FIXED_CLOCK if failure.lacks_fixed_clock(length) else help_)


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
    verb = tokens[at + 1].text if at + 1 < stop else ""
    second = at + 1 + (verb in (*_CHANGES, "goes", "is"))
    phrase = phrase_at(tokens, second, COMPARISON_WORDS)
    value = second + len(phrase)
    is_whole = operand_start(tokens, at) == 1 and clause_keyword(failure) in ("keep", "require")
    if tokens[at].text != "never" or not is_whole or not (phrase or verb in _CHANGES):
        return None
    if verb in _CHANGES and (not phrase or phrase[0] not in _LIMITS):
        return _change_error(failure, 1, at, at + 1)
    if tokens[value].type != "NUMBER":
        return None
    text = f"avoid {operand_text(failure, 1, at)} {COMPARISON_WORDS[phrase]} {operand_text(failure, value, stop)}"
    return suggest_rewrite(failure, 0, stop, text, failure.misplaced(tokens[at]))


def _changed(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for `health falls by more than 30`, else None."""
    tokens, at = failure.tokens, failure.stop.index
    start, after = operand_start(tokens, at), tokens[at + 1 : at + 2]
    is_change = tokens[at].text in _CHANGES and bool(after)
    if not is_change or start is None or not (after[0].text == "by" or phrase_at(tokens, at + 1, COMPARISON_WORDS)):
        return None
    if after[0].text in _LIMITS:
        value = text_of(failure, start, at)
        help_ = f"compare the value itself: `{value} {COMPARISON_WORDS[after[0].text,]} {tokens[at + 2].text}`"
        return failure.error("TLT0101", failure.misplaced(tokens[at]), help_)
    return _change_error(failure, start, at, at)


def _change_error(failure: ParseFailure, start: int, stop: int, verb: int) -> Diagnostic | None:
    """Return the error for a verb such as `falls`, and how far the value from ``start`` to ``stop`` changes.

    None if no number ends the clause.
    """
    tokens, operand = failure.tokens, operand_text(failure, start, stop)
    title = failure.misplaced(tokens[verb])
    if any(token.text in ("within", "in") for token in tokens[verb:]):
        help_ = f"let the game supply how much `{operand}` has changed in that time"
        return failure.error("TLT0101", title, help_, span=tokens[verb].span)
    at = verb + 1 + (tokens[verb + 1].text == "by")
    phrase = phrase_at(tokens, at, COMPARISON_WORDS)
    number = tokens[at + len(phrase)]
    if number.type != "NUMBER" or at + len(phrase) + 2 < len(tokens):
        return None
    compared = f" {COMPARISON_WORDS.get(phrase, '>=')} {number.text}"
    clause = "avoid " if tokens[verb - 1].text == "never" else ""
    step, extreme = (f"{clause}{form.format(x=operand)}" for form in _CHANGES[tokens[verb].text])
    word = "highest" if "highest" in extreme else "lowest"
    help_ = (
        f"write `{step}{compared}` for a change from one step to the next, "
        f"`{extreme}{compared}` for one since its {word} value"
    )
    return failure.error("TLT0101", title, help_, span=tokens[verb].span)
