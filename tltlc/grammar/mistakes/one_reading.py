"""Decide whether an English word has only one meaning where it stands.

An error gets a fix only in this case.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from tltlc.grammar.keywords import CONDITIONS
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.parse_failure import BEFORE_ONE, INFIX, UNTILS, ParseFailure, outer_indices
from tltlc.grammar.mistakes.rephrasing import formula_start, formula_stop

UNCLEAR: Final = INFIX - {"AND", "OR"}
"""Operators beside which it is unclear what an English word or a time applies to."""
TEMPORAL: Final = BEFORE_ONE - {"NOT"}
QUANTIFIERS: Final = frozenset(("ALL", "ANY"))
_STATES: Final = ("but", "xor", "xnor", "nor", "nand", "without")
"""Words that join two conditions on the same step.

Their replacement in the language means the same in every clause, and inside brackets.
"""
_NEGATED: Final = {
    "keep": ("before", "after", "unless", *CONDITIONS, "during"),
    "require": ("if",),
}
"""Maps a clause keyword to words for which `not a WORD b` has one meaning in the clause.

The meaning is the same whether `not` applies to `a` alone or to `a WORD b`.
"""
_AS_WRITTEN: Final = ("but", "xor", "xnor")
"""Words for which `not a WORD b` has one meaning in all clauses.

The meaning is the same whether `not` applies to `a` alone or to `a WORD b`.
"""
_IN_RULES: Final = frozenset(("AND", "OR", "IMPLIES", *QUANTIFIERS))


def has_token(failure: ParseFailure, start: int, stop: int, kinds: Collection[str]) -> bool:
    """Whether the tokens from index ``start`` up to ``stop`` include one of ``kinds`` outside brackets."""
    return any(failure.tokens[index].type in kinds for index in outer_indices(failure.tokens, start, stop))


def is_of_one_step(failure: ParseFailure, start: int, stop: int) -> bool:
    """Whether the formula from index ``start`` up to ``stop`` is about one step, without a temporal operator."""
    return not any(token.type in TEMPORAL | UNTILS | {"THEN"} for token in failure.tokens[start:stop])


def is_clear_word(failure: ParseFailure, word: str, left: tuple[int, int], right: tuple[int, int], kind: str) -> bool:
    """Whether `a WORD b` has only one meaning in a clause of this kind, judged by `a` and `b`.

    ``left`` and ``right`` are the ranges of the token indices of `a` and `b`.
    """
    sides = (left, right)
    if any(has_token(failure, *side, UNCLEAR | TEMPORAL) for side in sides):
        return False
    if has_token(failure, *left, {"NOT"}) and word not in (*_NEGATED.get(kind, ()), *_AS_WRITTEN):
        return False
    if word in (*CONDITIONS, "during"):
        # `a and b if c` has two readings if `and` differs from the operator that replaces `if`.
        left_kinds, right_kinds = ({"OR"}, {"OR"}) if kind in ("reach", "avoid") else ({"AND"}, {"AND", "OR"})
        if has_token(failure, *left, left_kinds) or has_token(failure, *right, right_kinds):
            return False
        return not _has_variable_of(failure, left, right)
    if has_token(failure, *left, QUANTIFIERS):
        return False
    if word == "but":
        return not any(has_token(failure, *side, {"OR"}) for side in sides)
    if word == "without":
        # After a goal, `without` may apply to all goals of the plan.
        ambiguous = {"AND", "OR"} if kind == "reach" else {"OR"}
        is_ambiguous = has_token(failure, *left, ambiguous) or has_token(failure, *right, INFIX)
        return not is_ambiguous and all(is_of_one_step(failure, *side) for side in sides)
    # `a or b unless c` has one meaning if `unless` itself is an `or`.
    is_or = word == "unless" and kind in ("reach", "keep")
    if any(has_token(failure, *side, INFIX - {"OR"} if is_or else INFIX) for side in sides):
        return False
    return word in _STATES or all(is_of_one_step(failure, *side) for side in sides)


def is_clear_here(failure: ParseFailure, word: str) -> bool:
    """Whether an English word has only one meaning where parsing failed, judged by the tokens around it.

    These are the keyword of the clause and the operators around the open brackets.
    """
    clause = failure.tokens[0].text if failure.start == "clause" else ""
    if word in _STATES:
        return not _is_in_call(failure)
    if failure.tokens[0].type == "LET" or _is_in_call(failure):
        # The definition may be used both as a goal and as a rule.
        return False
    if word in (*CONDITIONS, "during"):
        is_rule = (
            clause == "keep" or has_always_before(failure) or (failure.start == "clause" and not failure.stop.index)
        )
        if not failure.open_brackets:
            return is_rule or word == "if" or clause in ("reach", "avoid")
        return (
            clause not in ("reach", "avoid")
            and (is_rule or word == "if")
            and _surroundings_are(failure, _IN_RULES | {"ALWAYS"})
        )
    return not failure.open_brackets or (
        clause not in ("reach", "avoid", "keep") and _surroundings_are(failure, _IN_RULES)
    )


def is_clear_time_here(failure: ParseFailure, *, may_be_negated: bool, may_be_kept: bool) -> bool:
    """Whether a time inside the open brackets has only one meaning, judged by the operators around them.

    ``may_be_negated`` allows `not` before a bracket, and ``may_be_kept`` allows `always`. Without open
    brackets, the result is true outside a `let`.
    """
    if failure.tokens[0].type == "LET" or _is_in_call(failure):
        return False
    kinds = {*_IN_RULES, *(("NOT",) if may_be_negated else ()), *(("ALWAYS",) if may_be_kept else ())}
    return not failure.open_brackets or _surroundings_are(failure, kinds)


def has_always_before(failure: ParseFailure) -> bool:
    """Whether one of the brackets that are open where parsing failed directly follows `always`."""
    return any(before is not None and before.type == "ALWAYS" for before in _tokens_before_brackets(failure))


def effective_clause(failure: ParseFailure, at: int) -> str:
    """Return the clause keyword that says how a formula at index ``at`` is used.

    If an `always` stands before the index, return ``keep``; else, if an `eventually` does, ``reach``;
    else the keyword of the clause, or "" outside a clause.
    """
    clause = failure.tokens[0].text if failure.start == "clause" else ""
    kinds = [token.type for token in failure.tokens[:at]]
    return "keep" if "ALWAYS" in kinds else "reach" if "EVENTUALLY" in kinds else clause


def _has_variable_of(failure: ParseFailure, left: tuple[int, int], right: tuple[int, int]) -> bool:
    """Whether the tokens in ``right`` use a variable whose quantifier is in ``left``, as in ``all x in (a): p if x``.

    Both are ranges of token indices.
    """
    heads = (index + 1 for index in outer_indices(failure.tokens, *left) if failure.tokens[index].type in QUANTIFIERS)
    variables = {failure.tokens[index].text for index in heads}
    return any(token.text in variables for token in failure.tokens[slice(*right)])


def _surroundings_are(failure: ParseFailure, kinds: Collection[str]) -> bool:
    """Whether only certain operators stand around the brackets that are open where parsing failed.

    The operators before a bracket must be of ``kinds``. The operators after the brackets must be
    `and` or `or`.
    """
    operators = INFIX | BEFORE_ONE | QUANTIFIERS
    start, stop = _piece_formula_start(failure), formula_stop(failure)
    opening = {id(token) for token in failure.open_brackets}
    before: list[Token] = []
    for index, token in enumerate(failure.tokens[: formula_start(failure)]):
        if id(token) in opening:
            before += (failure.tokens[i] for i in outer_indices(failure.tokens, start, index))
            start = index + 1
    after = (failure.tokens[i] for i in outer_indices(failure.tokens, stop, len(failure.tokens)))
    return all(token.type in kinds for token in before if token.type in operators) and all(
        token.type in ("AND", "OR") for token in after if token.type in operators
    )


def _is_in_call(failure: ParseFailure) -> bool:
    """Whether an open bracket encloses something else than a formula, such as the arguments of a call."""
    brackets = any(token.type != "LPAR" for token in failure.open_brackets)
    return brackets or any(before is not None and before.type == "NAME" for before in _tokens_before_brackets(failure))


def _tokens_before_brackets(failure: ParseFailure) -> list[Token | None]:
    """Return the token before each open bracket; None for a bracket that is the first token."""
    opening = {id(token) for token in failure.open_brackets}
    return [
        failure.tokens[index - 1] if index else None
        for index, token in enumerate(failure.tokens)
        if id(token) in opening
    ]


def _piece_formula_start(failure: ParseFailure) -> int:
    """Return the index where the formula begins in the declaration or clause in which parsing failed."""
    if failure.start == "declaration":
        return next((index + 1 for index, token in enumerate(failure.tokens) if token.type == "EQUAL"), 0)
    return 1 if failure.start == "clause" else 0
