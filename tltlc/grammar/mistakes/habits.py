"""Explain forms that people know from other languages, such as ``a == b``.

Each function of ``HABITS`` recognises one form. It returns the error, or None if parsing failed for
another reason.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import UNITS_ELSEWHERE
from tltlc.grammar.lexer import END
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.equalities import VERBS, equality, value_end
from tltlc.grammar.mistakes.fragments import is_first_on_line
from tltlc.grammar.mistakes.one_reading import effective_clause
from tltlc.grammar.mistakes.parse_failure import (
    BEFORE_ONE,
    COMPARISONS,
    INFIX,
    ParseFailure,
    are_adjacent,
    outer_indices,
    quote_token,
)
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    operand_start,
    span_of,
    suggest_rewrite,
    text_of,
)
from tltlc.grammar.tables import load


def chained_comparison(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if comparisons are chained, as in ``a < b < c``, else None."""
    at = failure.stop.index
    if failure.token.type not in COMPARISONS or not failure.wants_operator:
        return None
    middle, title = value_end(failure.tokens, at, -1), "comparisons cannot be chained"
    start, stop = value_end(failure.tokens, middle - 1, -1), value_end(failure.tokens, at, 1)
    comparisons = [text_of(failure, start, at), text_of(failure, middle, stop)]
    while failure.tokens[stop].type in COMPARISONS:
        middle, at, stop = at + 1, stop, value_end(failure.tokens, stop, 1)
        comparisons.append(text_of(failure, middle, stop))
    text = " and ".join(comparisons)
    if (start, stop) != (formula_start(failure), formula_stop(failure)):
        text = f"({text})"
    diagnostic = suggest_rewrite(failure, start, stop, text, title, code="TLT0110")
    return diagnostic or failure.error("TLT0110", title, "write `a < b and b < c`")


_ARROWS: Final = {"==>": "implies", "-->": "implies", "<=>": "iff", "<==>": "iff", "<-->": "iff"}
"""Maps arrows of other languages to the words of the language."""
NO_UNITS: Final = frozenset(
    "a after also an and as at before between but by during each every except for from if in is of on once only or per "
    "thrice times twice provided since than that the then till to under unless until when whenever where while with "
    "within without".split()
)
"""Words of English that stand behind a number, as in `at most 3 per lap`, and are no units."""


def long_arrow(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for an arrow that is read as several signs, as in ``a ==> b`` and ``a <=> b``, else None."""
    tokens, at = failure.tokens, failure.stop.index
    for start in range(max(at - 2, 1), at + 1):
        for stop in range(start + 2, min(start + 4, len(tokens))):
            arrow = "".join(token.text for token in tokens[start:stop])
            are_joined = all(map(are_adjacent, tokens[start : stop - 1], tokens[start + 1 : stop]))
            if arrow in _ARROWS and are_joined:
                # Between goals, an arrow may mean their order.
                write = None if tokens[0].type == "REACH" and _ARROWS[arrow] == "implies" else _ARROWS[arrow]
                help_ = f"write `{write}`" if write else "write `then` for an order, `implies` for a condition"
                span = span_of(tokens[start:stop])
                return failure.error("TLT0104", f"`{arrow}` means nothing here", help_, span=span, write=write)
    return None


def arrow_sign(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for the arrows ``=>`` and ``=<``, as in ``a => b`` and ``a =< b``, else None."""
    at = failure.stop.index
    after = failure.tokens[at + 1 :][:2]
    if (
        failure.token.type != "EQUAL"
        or not failure.wants_operator
        or not after
        or not are_adjacent(failure.token, after[0])
    ):
        return None
    sign = "=" + after[0].text
    if sign not in ("=>", "=<"):
        return None
    is_before_number = len(after) > 1 and after[1].type == "NUMBER"
    operator = "<=" if sign == "=<" else ">=" if is_before_number else "implies"
    help_ = f"write `{operator}`" + (" or `->`" if operator == "implies" else "")
    span = span_of(failure.tokens[at : at + 2])
    # Between goals, an arrow may mean their order.
    write = None if operator == "implies" and failure.tokens[0].type == "REACH" else operator
    help_ = help_ if write else "write `then` for an order, `implies` for a condition"
    return failure.error("TLT0104", f"`{sign}` means nothing here", help_, span=span, write=write)


def dash_comment(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a comment that begins with ``--``, else None.

    The comment is found even if the parser has read its first words as part of a formula.
    """
    tokens, at = failure.tokens, failure.stop.index
    for index in range(min(at, len(tokens) - 2), -1, -1):
        first, second, after = tokens[index], tokens[index + 1], tokens[index + 2 : index + 3]
        if first.text == second.text == "-" and are_adjacent(first, second):
            # `--3` is a number with two signs.
            if index < at and after and are_adjacent(second, after[0]):
                return None
            span = span_of([first, second])
            return failure.error(
                "TLT0104", "`--` means nothing here", "write `//` before a comment", span=span, write="//"
            )
        if is_first_on_line(failure.source, tokens, index):
            return None
    return None


def foreign_unit(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a unit that the language does not know, as in ``20 seconds`` or ``3 feet``, else None."""
    number, token = failure.previous_token, failure.token
    if number is None or number.type != "NUMBER" or token.type != "NAME" or "UNIT" not in failure.allowed_terminals:
        return None
    if token.text in VERBS and failure.tokens[failure.stop.index + 1].text in ("true", "false"):
        return _truth_of_comparison(failure)
    if token.text in VERBS and failure.allowed_terminals & COMPARISONS:
        return None  # `x + 1 is 3`
    if token.text.lower() in NO_UNITS:
        return None
    if token.text.isupper() and token.text.lower() in load().words:
        return None
    title = f"the language has no unit {quote_token(token)}"
    known = UNITS_ELSEWHERE.get(token.text.lower())
    compared = operand_start(failure.tokens, failure.stop.index - 2)
    is_ratio = compared is not None and declared_names(failure.source).type_of(failure.tokens[compared].text) == "ratio"
    if known == "%" and not is_ratio:
        # A signal with values from 0 to 100 is compared with the number alone.
        help_ = (
            f"for a ratio, write `{number.text} %`, which is {number.text}/100; otherwise write `{number.text}` alone"
        )
        return failure.error("TLT0111", title, help_)
    if known and failure.lacks_fixed_clock(f"{number.text} {known}"):
        return failure.error(
            "TLT0111", title, f"with `clock varies`, write a time: `{number.text} s`, `{number.text} ms`"
        )
    if known == "steps" and failure.start != "test_item" and failure.tokens[failure.stop.index - 2].type in COMPARISONS:
        return _compared_steps(failure, number.text, title)
    if known:
        text = f"{number.text} {known}"
        return failure.error("TLT0111", title, None, f"write `{text}`", span_of([number, token]), write=text)
    is_call = failure.tokens[failure.stop.index + 1].type == "LPAR"
    if (
        is_call
        or failure.allowed_terminals == {"UNIT"}
        or is_first_on_line(failure.source, failure.tokens, failure.stop.index)
    ):
        return None
    listed = ", ".join(f"`{name}`" for name in sorted(load().units))
    if failure.tokens[failure.stop.index - 2].type in COMPARISONS:
        help_ = f"write `{number.text}` alone: only times, lengths, speeds, angles and ratios have a unit"
        is_whole = failure.tokens[failure.stop.index + 1].type in (END, "RPAR", *INFIX)
        span = span_of([number, token]) if is_whole else None
        return failure.error("TLT0111", title, help_, span=span, write=number.text if is_whole else None)
    help_ = f"the units are {listed}; to compare a signal, write `{token.text} >= {number.text}`"
    return failure.error("TLT0111", title, help_)


def _truth_of_comparison(failure: ParseFailure) -> Diagnostic:
    """Return the error for `is true` or `is false` after a comparison, as in ``health > 3 is true``."""
    tokens, at = failure.tokens, failure.stop.index
    span = span_of(tokens[at - 1 : at + 2])
    title = failure.misplaced(tokens[at])
    if tokens[at + 1].text == "true":
        help_ = f"leave out `{tokens[at].text} true`: a comparison is true or false by itself"
        return failure.error("TLT0101", title, help_, span=span, write=tokens[at - 1].text)
    help_ = f"leave out `{tokens[at].text} false`, and put `not` before the comparison"
    return failure.error("TLT0101", title, help_, span=span)


def _compared_steps(failure: ParseFailure, number: str, title: str) -> Diagnostic:
    """Return the error for a comparison with a number of steps, as in ``time_holding(p) > 180 frames``."""
    length = declared_names(failure.source).step_s
    text = f"{float(number) * length:.6g} s" if length else ""
    help_ = "compare a time with seconds; steps count samples"
    span = span_of([failure.tokens[failure.stop.index - 1], failure.token])
    if not text:
        return failure.error("TLT0111", title, help_, span=span)
    is_exact = abs(float(text.split()[0]) - float(number) * length) < 1e-12
    help_ += f": `{number} {failure.token.text}` are {'' if is_exact else 'about '}`{text}` with this clock"
    return failure.error("TLT0111", title, help_, span=span, write=text if is_exact else None)


def doubled_operator(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if two operators stand side by side, as in ``a and then b`` or ``a then then b``, else None."""
    before, token = failure.previous_token, failure.token
    if before is None or before.type not in INFIX or token.type not in INFIX or not failure.wants_operand:
        return None
    title = f"expected a formula between {quote_token(before)} and {quote_token(token)}"
    word = token.text if (before.type, token.type) == ("AND", "THEN") else before.text
    # `keep a then b` requires `b` after the last step, and `a or then b` may mean an order or a choice.
    is_order = token.type == "THEN" and before.type in ("AND", "IMPLIES")
    is_order = is_order and effective_clause(failure, failure.stop.index) != "keep"
    write = word if token.type == before.type or is_order else None
    help_ = f"write `{write}` alone" if write else "leave out one of the two operators"
    return failure.error("TLT0101", title, help_, span=span_of([before, token]), write=write)


def prefix_between_formulas(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if an operator that takes one formula stands between two formulas, else None.

    An example is ``reach a next b``.
    """
    token, keyword, following = failure.token, failure.tokens[0].text, failure.stop.index + 1
    is_last = following + 1 >= len(failure.tokens) or is_first_on_line(failure.source, failure.tokens, following)
    if is_last and (keyword, token.type) in (("keep", "ALWAYS"), ("reach", "EVENTUALLY")):
        help_ = f"leave it out: `{keyword}` already says so"
        return failure.error("TLT0101", f"{quote_token(token)} belongs before a formula", help_)
    if is_last or token.type not in {*BEFORE_ONE, "ALL", "ANY"} or not failure.wants_operator:
        return None
    is_goal = keyword == "reach" and token.type in ("NEXT", "EVENTUALLY")
    replacement = "then" if is_goal else f"and {token.text}"
    title = f"{quote_token(token)} belongs before one formula, not between two"
    # Beside another operator, `and` may bind too tightly; `next` and `always` may follow `and`, `implies` or `then`.
    indices = outer_indices(failure.tokens, formula_start(failure), formula_stop(failure))
    is_clear = (
        token.type == "NOT"
        and failure.tokens[following].type not in INFIX
        and all(failure.tokens[index].type not in INFIX - {"AND"} for index in indices)
    )
    return failure.error("TLT0101", title, f"write `{replacement}`", write=replacement if is_clear else None)


HABITS: Final[tuple[Callable[[ParseFailure], Diagnostic | None], ...]] = (
    arrow_sign,
    equality,
    chained_comparison,
    foreign_unit,
    doubled_operator,
    prefix_between_formulas,
)
