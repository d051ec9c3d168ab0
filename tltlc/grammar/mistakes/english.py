"""Explain English words that are no operators: `if`, `while`, `before`, or a time after its formula."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CASES, OPERATORS
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.english_forms import (
    FORMS,
    KEPT_BEFORE,
    PREFIXES,
    REVERSED_SEQUENCE,
    SEQUENCE,
    TIMES,
    Form,
    Forms,
)
from tltlc.grammar.mistakes.english_rewrite import (
    Parts,
    clause_keyword,
    goal_starts,
    kept_before_help,
    reached_before_help,
    rewrite_error,
)
from tltlc.grammar.mistakes.english_times import prefix_time_error, time_error
from tltlc.grammar.mistakes.one_reading import TEMPORAL, UNCLEAR, has_token, is_clear_here, is_clear_word
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure, outer_indices, quote_token
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    operand_text,
    span_of,
    suggest_rewrite,
    text_of,
)
from tltlc.grammar.mistakes.rule_conditions import condition_behind_rule
from tltlc.grammar.mistakes.sentences.validity import is_valid

_FROM_THEN_ON: Final = {
    "keep": "write `keep b implies a` to require `a` at every step where `b` holds, or `keep b implies always a` to "
    "require it from then on, too",
    "avoid": "write `avoid a and b` to forbid `a` at every step where `b` holds, or `keep b implies always not a` to "
    "forbid it from then on, too",
}
"""Help texts with the two possible meanings of `if b, keep a` and of `if b, avoid a`."""
_BEFORE_CONDITIONS: Final[Mapping[str, tuple[str | None, ...]]] = {
    "reach": (None, "AND", "OR", "THEN"),
    "avoid": (None, "AND", "OR"),
}
"""Maps a clause keyword to the terminals that may stand before `if`.

None stands for the beginning of the formula.
"""
_OF_THE_REST: Final = ("after", "unless", "but")
"""Words that may apply to all the goals after them, or only to the next goal."""
_SEPARATORS: Final = ("then", ",", ":")


def plain_english(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a formula has an English word that is no operator, else None.

    Examples are ``keep a while b`` and ``reach a within 20 steps``.
    """
    if not failure.wants_operator or failure.previous_token is None:
        return None
    for at, untimed_forms in ((failure.stop.index - 1, PREFIXES), (failure.stop.index, FORMS)):
        word, following = failure.tokens[at], failure.tokens[at + 1 : at + 2]
        is_timed = word.text in TIMES and bool(following) and following[0].type == "NUMBER"
        forms = (TIMES if is_timed else untimed_forms).get(word.text)
        if forms is None or word.type not in ("NAME", "WHEN"):
            continue
        if failure.tokens[0].type == "PREDICATE":
            return failure.error("TLT0101", failure.misplaced(word), CASES, span=word.span)
        if word.text == "without" and clause_keyword(failure) in ("reach", "keep"):
            return _without_error(failure)
        if at == failure.stop.index and not is_timed and (diagnostic := condition_behind_rule(failure)):
            return diagnostic
        report = time_error if is_timed else _infix_word_error
        return (
            _prefix_word_error(failure, at, forms, timed=is_timed)
            if at < failure.stop.index
            else report(failure, forms)
        )
    return None


def condition_line(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a line of a spec begins with ``if``, ``when``, ``whenever`` or ``while``, else None."""
    forms = {"": Form("{b} implies {a}", "keep")}
    return _prefix_word_error(failure, 0, forms, timed=False) if failure.tokens[0].text in PREFIXES else None


def _without_error(failure: ParseFailure) -> Diagnostic:
    """Return the error for `without` between two formulas, as in ``reach a without b``.

    If the clause can have only one meaning, a fix writes `avoid` in place of `without`.
    """
    at = failure.stop.index
    goals = goal_starts(failure, at)
    sides = ((goals[-1], at), (at + 1, formula_stop(failure)))
    is_clear = len(goals) == 1 and is_clear_word(failure, "without", *sides, clause_keyword(failure))
    help_ = "use `avoid`, which begins a separate clause and applies to every step"
    clauses = text_of(failure, 0, at), f"avoid {text_of(failure, at + 1, formula_stop(failure))}"
    is_clear = is_clear and is_valid(clauses[1:])
    if is_clear:
        help_ = f"write `{clauses[0]}` and `{clauses[1]}`, which applies to every step"
    return failure.error("TLT0101", failure.misplaced(failure.token), help_, write="avoid" if is_clear else None)


def _infix_word_error(failure: ParseFailure, forms: Forms) -> Diagnostic:
    """Return the error for an English word between two formulas, such as ``keep a while b``.

    ``forms`` are the ways to write the phrase in the language. The error has a fix if the phrase has
    only one possible meaning.
    """
    at, kind = failure.stop.index, clause_keyword(failure)
    begin, stop = goal_starts(failure, at)[-1], formula_stop(failure)
    second = at + 1 + (failure.tokens[at + 1].text == "by")
    end = next(
        (index for index in outer_indices(failure.tokens, second, stop) if failure.tokens[index].type == "THEN"), stop
    )
    form = forms.get(kind, forms[""])
    parts = Parts(operand_text(failure, begin, at), operand_text(failure, second, end))
    word, first = failure.token.text, failure.tokens[begin].type
    if form == KEPT_BEFORE and first == "ONCE":
        form = Form("{b} implies {a}", "keep")
    is_clear = (
        (end == stop or (kind == "reach" and word not in _OF_THE_REST))
        and (begin == formula_start(failure) or word != "unless")
        and not (form in (SEQUENCE[""], REVERSED_SEQUENCE[""]) and kind == "keep")
        and is_clear_word(failure, word, (begin, at), (second, end), kind)
        and is_clear_here(failure, word)
    )
    if is_clear and form == KEPT_BEFORE and first != "NOT":
        # It may ask that a comes first, or that a holds all the time before.
        return failure.error("TLT0101", failure.misplaced(failure.token), kept_before_help(parts.a, parts.b))
    if word == "before" and kind == "reach" and end == stop and begin == formula_start(failure):
        title, help_ = failure.misplaced(failure.token), reached_before_help(parts.a, parts.b)
        text = f"require (not {parts.b}) until {parts.a}"
        if is_clear and suggest_rewrite(failure, 0, stop, text, title):
            return failure.error("TLT0101", title, help_, span=span_of(failure.tokens[:-1]))
    return rewrite_error(failure, at, (begin, end), form, parts if is_clear else None)


def _prefix_word_error(failure: ParseFailure, at: int, forms: Forms, *, timed: bool) -> Diagnostic:
    """Return the error for an English word or a time before its formula, such as ``reach if b then a``.

    ``at`` is the index of the word. ``timed`` is true for a time, such as ``within 20 steps a``.
    """
    if timed:
        return prefix_time_error(failure, at, forms)
    stop, form = formula_stop(failure), forms.get(clause_keyword(failure), forms[""])
    split = _condition_end(failure, at + 1, stop)
    second = split + (failure.tokens[split].text in _SEPARATORS)
    if clause_keyword(failure) == "reach":
        # Stop before the next goal.
        stop = next(
            (index for index in outer_indices(failure.tokens, second, stop) if failure.tokens[index].type == "THEN"),
            stop,
        )
    parts = Parts(operand_text(failure, second, stop), operand_text(failure, at + 1, split))
    previous = failure.tokens[at - 1].type if at > formula_start(failure) else None
    is_clear = previous in _BEFORE_CONDITIONS.get(clause_keyword(failure), (None, "AND", "OR", "IMPLIES"))
    is_clear = is_clear and is_clear_here(failure, failure.tokens[at].text)
    is_clear = is_clear and not has_token(failure, formula_start(failure), split, TEMPORAL)
    is_clear = is_clear and not (
        clause_keyword(failure) in ("reach", "avoid") and has_token(failure, second, stop, TEMPORAL)
    )
    # `if a then b until c` may mean a rule that ends at `c`; a keyword would also apply to `until` or `or` after it.
    is_clear = is_clear and not has_token(failure, second, stop, UNCLEAR)
    keyword = failure.tokens[second].text
    if keyword in _FROM_THEN_ON:
        title = (
            failure.misplaced(failure.tokens[at])
            if at
            else f"a clause cannot begin with {quote_token(failure.tokens[at])}"
        )
        code = "TLT0101" if at else "TLT0107"
        return failure.error(code, title, _FROM_THEN_ON[keyword], span=failure.tokens[at].span)
    if keyword in OPERATORS:
        is_clear = is_clear and keyword == "reach" and failure.tokens[at].text != "while"
        is_clear = is_clear and not has_token(failure, second, stop, INFIX)
    wrapped = form if previous in (None, "THEN") else replace(form, formula=f"({form.formula})")
    return rewrite_error(failure, at, (at, stop), wrapped, parts if is_clear else None)


def _condition_end(failure: ParseFailure, start: int, stop: int) -> int:
    """Return the index where a condition that begins at index ``start`` ends.

    The condition ends at `then`, a comma or a colon. Without one of these, it ends after a name and
    its arguments.
    """
    for index in outer_indices(failure.tokens, start, stop):
        if failure.tokens[index].text in _SEPARATORS:
            return index
    name = start + (failure.tokens[start].type == "NOT")
    following: Token | None = failure.tokens[name + 1] if name + 1 < stop else None
    if following is None or following.type != "LPAR":
        return min(name + 1, stop)
    return next((index + 1 for index in outer_indices(failure.tokens, name + 1, stop) if index > name + 1), stop)
