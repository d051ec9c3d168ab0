"""Explain counts in English: `seen at most 3 times`, `no more than twice seen`, `never seen twice within 10 s`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.lexer import END, Token
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK, clause_keyword
from tltlc.grammar.mistakes.english_times import time_at
from tltlc.grammar.mistakes.parse_failure import COMPARISONS as SIGNS
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure
from tltlc.grammar.mistakes.repeats import begun_again, quantified_body
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    operand_end,
    operand_start,
    phrase_at,
    span_of,
    suggest_rewrite,
    text_of,
)

COMPARISONS: Final[Mapping[tuple[str, ...], str]] = {
    **dict.fromkeys((("no", "more", "than"), ("not", "more", "than"), ("at", "most"), ("up", "to")), "<="),
    **dict.fromkeys((("no", "less", "than"), ("not", "less", "than"), ("no", "fewer", "than"), ("at", "least")), ">="),
    ("more", "than"): ">",
    **dict.fromkeys((("less", "than"), ("fewer", "than")), "<"),
}
"""Maps English words before a number to the sign of the comparison."""
_COUNTED: Final[Mapping[tuple[str, ...], str]] = {**COMPARISONS, ("exactly",): "=="}
_BEFORE_TIME: Final = tuple(
    (word, *rest)
    for word in ("within", "in", "during", "for", "per", "every", "each")
    for rest in (("the", "last"), ("the", "past"), ("any",), ("every",), ("each",), ("a",), ())
)
"""Words before a time in which something is counted."""
_NUMBERS: Final = {"once": "1", "twice": "2", "thrice": "3"}
_CLAUSES: Final = {
    **{(keyword, "<="): "keep times({p}) <= {n}" for keyword in ("keep", "reach", "require")},
    **{(keyword, "<"): "keep times({p}) < {n}" for keyword in ("keep", "reach", "require")},
    **{(keyword, ">="): "reach times({p}) >= {n}" for keyword in ("keep", "reach", "require")},
    **{(keyword, ">"): "reach times({p}) > {n}" for keyword in ("keep", "reach", "require")},
    **{(keyword, ">="): "avoid times({p}) >= {n}" for keyword in ("avoid", "never")},
    **{(keyword, ">"): "avoid times({p}) > {n}" for keyword in ("avoid", "never")},
}
"""Clauses for counts in English, by the keyword of the clause and the comparison.

`keep … at least` would have to hold at the first step, too, and `reach … at most` always holds there:
for these, the other clause is meant.
"""
_WITHIN: Final = {
    **{(keyword, sign): "keep" for keyword in ("keep", "require") for sign in ("<=", "<")},
    **{(keyword, sign): "avoid" for keyword in ("avoid", "never") for sign in (">=", ">")},
}
"""The keywords of clauses for counts within a time, by the keyword that was written and the comparison."""
_GOAL_WITHIN: Final = (
    "write `require eventually within {time} times({p}) {sign} {n}` for the first {time} of play, "
    "`reach times_within({p}, {time}) {sign} {n}` for any {time}"
)
COMPARE_COUNT: Final = (
    "`times_within({p}, {time})` is how often `{p}` has begun in the last {time}: compare it with a number, as in "
    "`keep times_within({p}, {time}) <= 3`"
)
_TWICE: Final = ((">=", "2"), (">", "1"))
_AT_MOST_ONCE: Final = (("<=", "1"), ("<", "2"))


@record
class _Count:
    """A count such as `at most 3 times within 10 s`.

    ``sign`` is that of the comparison, empty if there is none. ``time`` is empty without a time.
    ``start`` and ``stop`` are the indices of its tokens.
    """

    sign: str
    number: str
    time: str
    start: int
    stop: int


def count_in_words(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a formula such as ``seen at most 3 times`` or ``at most 3 times seen``, else None."""
    first, at, tokens = formula_start(failure), failure.stop.index, failure.tokens
    keyword = clause_keyword(failure)
    if tokens[first].text == "never" and keyword in ("keep", "require") and at <= first + 3:
        diagnostic = _counted_from(failure, "never", first + 1)
        if diagnostic is not None:
            return diagnostic
    for start in range(max(first, at - 2), at + 1):
        # `at most` is no formula, even where a name `at` is declared.
        is_name = tokens[start].text in declared_names(failure.source).names and tokens[start + 1].type != "NAME"
        if (start == first or tokens[start - 1].type in INFIX) and not is_name:
            diagnostic = _count_before(failure, keyword if start == first else "", start)
            if diagnostic is not None:
                return diagnostic
    operand = operand_start(tokens, at)
    timed = _timed_times(failure) or (_timed_comparison(failure) if operand is None else None)
    if operand is None or timed is not None:
        return timed
    return _count_after(failure, keyword if operand == first else "", operand, at)


def never_counted(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a clause such as ``never seen more than 3 times``, else None."""
    is_never = failure.start == "clause" and failure.tokens[0].text.lower() == "never"
    return _counted_from(failure, "never", 1) if is_never else None


def _counted_from(failure: ParseFailure, keyword: str, start: int) -> Diagnostic | None:
    """Return an error for a formula and its count, in either order, which begin at an index."""
    end = operand_end(failure.tokens, start)
    after = None if end is None else _count_after(failure, keyword, start, end)
    return after or _count_before(failure, keyword, start)


def _count_after(failure: ParseFailure, keyword: str, start: int, end: int) -> Diagnostic | None:
    """Return an error for the operand from ``start`` to ``end`` if a count follows, else None."""
    count = _count_at(failure.tokens, end)
    return None if count is None else _error(failure, keyword, text_of(failure, start, end), start, count)


def _count_before(failure: ParseFailure, keyword: str, start: int) -> Diagnostic | None:
    """Return an error for a count at an index if its operand follows, else None."""
    count = _count_at(failure.tokens, start)
    end = None if count is None else operand_end(failure.tokens, count.stop)
    if count is None or end is None:
        return None
    return _error(failure, keyword, text_of(failure, count.stop, end), start, count, end)


def _error(
    failure: ParseFailure, keyword: str, operand: str, start: int, count: _Count, end: int | None = None
) -> Diagnostic | None:
    """Return the error for a count and its operand, which begin at ``start``, and end at ``end`` or after the count.

    ``keyword`` is that of the clause if the two begin it, else empty.
    """
    tokens, end = failure.tokens, end or count.stop
    span, is_whole = span_of(tokens[count.start : count.stop]), tokens[end].type == END
    title = failure.misplaced(tokens[count.start]) if count.sign else "a count is a comparison"
    has_default = keyword in ("reach", "avoid", "never") and not count.sign
    sign = ">=" if has_default else count.sign
    if count.time:
        help_ = FIXED_CLOCK
        if not failure.lacks_fixed_clock(count.time):
            role, head = _role(failure, start) if is_whole else ("", "")
            clause = _again_within(keyword if is_whole and keyword else role, operand, sign or ">=", count, head)
            if clause and failure.start == "clause":
                return suggest_rewrite(failure, 0, end, clause, title)
            within = (start, end), keyword if is_whole and keyword else role, operand
            return _within_time(failure, title, *within, sign or ">=", count, head)
    elif count.number == "1" and (sign or ">=") == ">=" and keyword in ("keep", "reach", "require") and is_whole:
        return suggest_rewrite(failure, 0, end, f"reach {operand}", title)
    elif (form := _CLAUSES.get((keyword, sign))) and is_whole:
        return suggest_rewrite(failure, 0, end, form.format(p=operand, n=count.number), title)
    elif sign == "==" and keyword in ("keep", "reach", "require") and is_whole:
        help_ = f"write two clauses: `reach times({operand}) >= {count.number} keep times({operand}) <= {count.number}`"
    elif not sign and keyword in ("keep", "require") and is_whole:
        at_least, at_most = (_CLAUSES["keep", sign].format(p=operand, n=count.number) for sign in (">=", "<="))
        help_ = f"write `{at_least}` if it must be that often at least, `{at_most}` if it must be that often at most"
    elif keyword == "require" and sign in (">=", ">") and (event := _event_behind(failure, end)):
        clause = f"keep {event} implies times({operand}) {sign} {count.number}"
        return suggest_rewrite(failure, 0, len(tokens) - 1, clause, title)
    elif sign and not keyword:
        return suggest_rewrite(failure, start, end, f"times({operand}) {sign} {count.number}", title)
    else:
        example = f"`times({operand}) {count.sign or '>='} {count.number}`"
        help_ = f"`times({operand})` is how often it has begun: compare it, as in {example}"
    return failure.error("TLT0101", title, help_, span=span)


def _event_behind(failure: ParseFailure, start: int) -> str:
    """Return the only operand of `before at_exit` at an index, the end of the clause; else ""."""
    tokens = failure.tokens
    end = operand_end(tokens, start + 1) if tokens[start].text == "before" else None
    return "" if end is None or tokens[end].type != END else text_of(failure, start + 1, end)


def _role(failure: ParseFailure, start: int) -> tuple[str, str]:
    """Return the keyword for an operand after `not` or a quantifier, and the head of the quantifier.

    `not seen twice` in a rule is `never seen twice`. The keyword is empty if other words stand before the operand.
    """
    keyword = clause_keyword(failure)
    body, head = quantified_body(failure, keyword)
    is_negated = start > body and failure.tokens[start - 1].type == "NOT"
    if start - is_negated != body or (is_negated and keyword not in ("keep", "require")):
        return "", ""
    return "never" if is_negated else keyword, head


def _timed_comparison(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a time after a comparison of `times`, as in ``times(p) <= 2 within 5 s``, else None."""
    tokens, at = failure.tokens, failure.stop.index
    phrase = phrase_at(tokens, at, _BEFORE_TIME)
    time = time_at(tokens, at + len(phrase)) if phrase else None
    begin = operand_start(tokens, at - 2) if time is not None and at > 2 else None
    if time is None or begin is None or tokens[begin].text != "times" or tokens[at - 1].type != "NUMBER":
        return None
    title, help_ = failure.misplaced(tokens[at]), FIXED_CLOCK
    if not failure.lacks_fixed_clock(time[0].text):
        operand = text_of(failure, begin + 2, at - 3)
        count = _Count(tokens[at - 2].text, tokens[at - 1].text, time[0].text, begin, at)
        keyword, head = _role(failure, begin) if tokens[time[1]].type == END else ("", "")
        return _within_time(failure, title, (begin, time[1]), keyword, operand, count.sign, count, head)
    return failure.error("TLT0101", title, help_, span=tokens[at].span)


def _timed_times(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a time beside `times`, as in ``times(p) within 5 s <= 2`` and ``within 5 s times(p) <= 2``.

    Return None if there is no such time.
    """
    tokens, at = failure.tokens, failure.stop.index - (failure.token.type == "NUMBER")
    phrase = phrase_at(tokens, at, _BEFORE_TIME)
    time = time_at(tokens, at + len(phrase)) if phrase else None
    if time is None:
        return None
    begin, sign = operand_start(tokens, at), time[1]
    if tokens[sign].text == "times":
        begin, sign = sign, operand_end(tokens, sign) or sign
    end = None if begin is None or tokens[begin].text != "times" else operand_end(tokens, begin)
    if begin is None or end is None or end < begin + 3:
        return None
    title, help_ = failure.misplaced(tokens[at]), FIXED_CLOCK
    if not failure.lacks_fixed_clock(time[0].text):
        operator, number = (token.text for token in tokens[sign : sign + 2]) if tokens[sign].type in SIGNS else ("", "")
        count = _Count(operator, number, time[0].text, begin, at)
        keyword, head = _role(failure, min(begin, at)) if tokens[sign + 2 :] == tokens[-1:] else ("", "")
        place = min(begin, at), sign + 2 if operator else max(end, time[1])
        operand = text_of(failure, begin + 2, end - 1)
        return _within_time(failure, title, place, keyword, operand, operator, count, head)
    return failure.error("TLT0101", title, help_, span=tokens[at].span)


def _within_time(
    failure: ParseFailure,
    title: str,
    place: tuple[int, int],
    keyword: str,
    operand: str,
    sign: str,
    count: _Count,
    head: str,
) -> Diagnostic:
    """Return the error for a count within a time, such as `never seen twice within 10 s`, at a place.

    ``keyword`` is that of the clause if the count is all of it, and ``head`` its quantifier.
    """
    tokens, (start, end) = failure.tokens, place
    clause = _again_within(keyword, operand, sign, count, head)
    if keyword == "reach" and sign in (">=", ">") and not clause:
        help_ = _GOAL_WITHIN.format(p=operand, sign=sign, n=count.number, time=count.time)
        return failure.error("TLT0101", title, help_, span=span_of(tokens[start:end]))
    comparison = f"times_within({operand}, {count.time}) {sign} {count.number}"
    if not clause and (keyword, sign) in _WITHIN:
        clause = " ".join(filter(None, (_WITHIN[keyword, sign], head, comparison)))
    rewrite = None
    if clause and failure.start == "clause":
        rewrite = suggest_rewrite(failure, 0, len(tokens) - 1, clause, title)
    elif sign and count.number and _is_about_the_last(failure, place):
        rewrite = suggest_rewrite(failure, start, end, comparison, title)
    if rewrite is not None:
        return rewrite
    help_ = f"write `{clause}`" if clause else COMPARE_COUNT.format(p=operand, time=count.time)
    return failure.error("TLT0101", title, help_, span=span_of(tokens[start:end]))


def _is_about_the_last(failure: ParseFailure, place: tuple[int, int]) -> bool:
    """Whether a count is what a rule asks for, as in `a implies b 3 times in the last 5 s`, and about the last time.

    Behind `and`, `or` and `not`, the count may be about more than its own operand.
    """
    tokens, (start, end) = failure.tokens, place
    words = {token.text for token in tokens[start:end]}
    return tokens[start - 1].type == "IMPLIES" and tokens[end].type == END and bool(words & {"last", "past", "any"})


def _again_within(keyword: str, operand: str, sign: str, count: _Count, head: str) -> str:
    """Return the clause for a count of two within a time, such as `never seen twice within 10 s`; else ""."""
    key, time = (sign, count.number), count.time
    if (keyword in ("avoid", "never") and key in _TWICE) or (keyword in ("keep", "require") and key in _AT_MOST_ONCE):
        return begun_again(operand, time, head)
    if keyword == "reach" and not head and key in _TWICE:
        return f"reach begins {operand} then within {time} begins {operand}"
    return ""


def _count_at(tokens: Sequence[Token], start: int) -> _Count | None:
    """Return the count that begins at an index, else None; `once` alone is an operator, and no count."""
    phrase = phrase_at(tokens, start, _COUNTED)
    sign, at = _COUNTED.get(phrase, ""), start + len(phrase)
    number = _number(tokens, at)
    if number is None or (not sign and tokens[at].text == "once"):
        return None
    text, stop = number
    time = time_at(tokens, stop + 1) if tokens[stop].text in ("within", "in") else None
    return _Count(sign, text, time[0].text if time else "", start, time[1] if time else stop)


def _number(tokens: Sequence[Token], at: int) -> tuple[str, int] | None:
    """Return the number of `3 times` or `twice` at an index, as digits, and the index after it, else None."""
    if at < len(tokens) and tokens[at].text in _NUMBERS:
        return _NUMBERS[tokens[at].text], at + 1
    if at + 1 < len(tokens) and tokens[at].type == "NUMBER" and tokens[at + 1].text in ("times", "time", "x"):
        return tokens[at].text, at + 2
    return None
