"""Decide whether plain English has only one reading here, so that a fix can be offered."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from tltlc.grammar.keywords import CONDITIONS
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.place import BEFORE_ONE, INFIX, UNTILS, Place, outside
from tltlc.grammar.mistakes.rephrasing import formula_start, formula_stop

UNCLEAR: Final = INFIX - {"AND", "OR"}
"""Operators beside which it is unclear what a word or a time applies to."""
TEMPORAL: Final = BEFORE_ONE - {"NOT"}
QUANTIFIERS: Final = frozenset(("ALL", "ANY"))
_ORDER: Final = ("before", "after", "followed")
_STATES: Final = ("but", "xor", "xnor", "nor", "nand", "without")
"""Words that join two states at one step; their forms mean the same in all clauses, also in brackets."""
_NEGATED: Final = {
    "keep": ("before", "after", "unless", *CONDITIONS, "during"),
    "require": ("if",),
}
"""By clause, the words for which `not a WORD b` means the same whether `not` applies to `a` or to all of it."""
_AS_WRITTEN: Final = ("but", "xor", "xnor")
"""More such words, for all clauses."""
_IN_RULES: Final = frozenset(("AND", "OR", "IMPLIES", *QUANTIFIERS))


def has(place: Place, start: int, stop: int, kinds: Collection[str]) -> bool:
    """Whether a token of these kinds stands outside brackets in a part."""
    return any(place.tokens[index].type in kinds for index in outside(place.tokens, start, stop))


def is_of_one_step(place: Place, start: int, stop: int) -> bool:
    """Whether a part has no temporal operator, not even in brackets."""
    return not any(token.type in TEMPORAL | UNTILS | {"THEN"} for token in place.tokens[start:stop])


def is_clear_word(place: Place, word: str, left: tuple[int, int], right: tuple[int, int], kind: str) -> bool:
    """Whether `a WORD b` has only one reading in a clause of this kind, judged by its two sides."""
    sides = (left, right)
    if any(has(place, *side, UNCLEAR | TEMPORAL) for side in sides):
        return False
    if has(place, *left, {"NOT"}) and word not in (*_NEGATED.get(kind, ()), *_AS_WRITTEN):
        return False
    if word in (*CONDITIONS, "during"):
        # `a and b if c` has two readings if `and` differs from the operator in the form of `if`.
        left_kinds, right_kinds = ({"OR"}, {"OR"}) if kind in ("reach", "avoid") else ({"AND"}, {"AND", "OR"})
        if has(place, *left, left_kinds) or has(place, *right, right_kinds):
            return False
        return not _has_variable_of(place, left, right)
    if has(place, *left, QUANTIFIERS):
        return False
    if word == "but":
        return not any(has(place, *side, {"OR"}) for side in sides)
    if word == "without":
        # After a goal, it may apply to all goals of the plan.
        ambiguous = {"AND", "OR"} if kind == "reach" else {"OR"}
        is_ambiguous = has(place, *left, ambiguous) or has(place, *right, INFIX)
        return not is_ambiguous and all(is_of_one_step(place, *side) for side in sides)
    # `a or b unless c` has one meaning if `unless` itself is an `or`.
    is_or = word == "unless" and kind in ("reach", "keep")
    if any(has(place, *side, INFIX - {"OR"} if is_or else INFIX) for side in sides):
        return False
    return word in _STATES or all(is_of_one_step(place, *side) for side in sides)


def is_clear_here(place: Place, word: str) -> bool:
    """Whether the form is right at this place, judged by the clause and by what stands around open brackets."""
    clause = place.tokens[0].text if place.start == "clause" else ""
    if word in _STATES:
        return not _in_call(place)
    if place.tokens[0].type == "LET" or _in_call(place):
        # The definition may be used both as a goal and as a rule.
        return False
    if word in (*CONDITIONS, "during"):
        is_rule = clause == "keep" or has_always_before(place) or (place.start == "clause" and not place.stop.index)
        if not place.open_brackets:
            return is_rule or word == "if" or clause in ("reach", "avoid")
        return clause not in ("reach", "avoid") and (is_rule or word == "if") and _is_in(place, _IN_RULES | {"ALWAYS"})
    return not place.open_brackets or (clause not in ("reach", "avoid", "keep") and _is_in(place, _IN_RULES))


def is_clear_time_here(place: Place, *, may_be_negated: bool, may_be_kept: bool) -> bool:
    """Whether a time may apply to the formula in the open brackets, judged by what stands around them."""
    if place.tokens[0].type == "LET" or _in_call(place):
        return False
    kinds = {*_IN_RULES, *(("NOT",) if may_be_negated else ()), *(("ALWAYS",) if may_be_kept else ())}
    return not place.open_brackets or _is_in(place, kinds)


def has_always_before(place: Place) -> bool:
    """Whether an open bracket directly follows `always`."""
    return any(before is not None and before.type == "ALWAYS" for before in _before_brackets(place))


def clause_asked(place: Place, at: int) -> str:
    """Return the clause that the tokens before ``at`` amount to; `always` and `eventually` count as its keyword."""
    clause = place.tokens[0].text if place.start == "clause" else ""
    kinds = [token.type for token in place.tokens[:at]]
    return "keep" if "ALWAYS" in kinds else "reach" if "EVENTUALLY" in kinds else clause


def _has_variable_of(place: Place, left: tuple[int, int], right: tuple[int, int]) -> bool:
    """Whether a variable that is quantified on the left is used on the right, outside the quantifier's scope."""
    heads = (index + 1 for index in outside(place.tokens, *left) if place.tokens[index].type in QUANTIFIERS)
    variables = {place.tokens[index].text for index in heads}
    return any(token.text in variables for token in place.tokens[slice(*right)])


def _is_in(place: Place, kinds: Collection[str]) -> bool:
    """Whether only operators of these kinds stand before the open brackets, and only `and` and `or` after them."""
    operators = INFIX | BEFORE_ONE | QUANTIFIERS
    start, stop = _first(place), formula_stop(place)
    opening = {id(token) for token in place.open_brackets}
    before: list[Token] = []
    for index, token in enumerate(place.tokens[: formula_start(place)]):
        if id(token) in opening:
            before += (place.tokens[i] for i in outside(place.tokens, start, index))
            start = index + 1
    after = (place.tokens[i] for i in outside(place.tokens, stop, len(place.tokens)))
    return all(token.type in kinds for token in before if token.type in operators) and all(
        token.type in ("AND", "OR") for token in after if token.type in operators
    )


def _in_call(place: Place) -> bool:
    """Whether an open bracket belongs to a call, or to anything else but a formula."""
    brackets = any(token.type != "LPAR" for token in place.open_brackets)
    return brackets or any(before is not None and before.type == "NAME" for before in _before_brackets(place))


def _before_brackets(place: Place) -> list[Token | None]:
    """Return the token before each open bracket, or None if there is none."""
    opening = {id(token) for token in place.open_brackets}
    return [
        place.tokens[index - 1] if index else None for index, token in enumerate(place.tokens) if id(token) in opening
    ]


def _first(place: Place) -> int:
    """Return the index where the formula of the whole piece begins."""
    if place.start == "declaration":
        return next((index + 1 for index, token in enumerate(place.tokens) if token.type == "EQUAL"), 0)
    return 1 if place.start == "clause" else 0
