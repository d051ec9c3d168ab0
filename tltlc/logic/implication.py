"""Quick proofs about formulas on finite traces, such as that one implies another.

What the functions prove is true, but they give up where a proof would be long.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Final

from tltlc.logic import formula as build
from tltlc.logic.formula import FALSE, TRUE, Formula, FormulaOp
from tltlc.logic.signature import signature

DUAL: Final[dict[FormulaOp, FormulaOp]] = {
    "X": "N",
    "N": "X",
    "F": "G",
    "G": "F",
    "U": "R",
    "R": "U",
    "W": "M",
    "M": "W",
}
"""The dual of each operator. When negation moves inwards, the dual replaces the operator: ``!X a`` is ``N !a``."""

_MOST_PAIRS: Final = 400
_DEEPEST: Final = 40
_COMPLEMENT_DEPTH: Final = 3
_LAST_DEPTH: Final = 6

_ImplicationTest = Callable[[Formula, Formula], bool]


def syntactically_implies(premise: Formula, conclusion: Formula) -> bool:
    """Whether the syntax shows that ``premise`` implies ``conclusion`` on every finite trace.

    False means "not shown": the proof gives up after about 400 pairs of subformulas.
    """
    return _implies(premise, conclusion, {}, 0)


@lru_cache(maxsize=8192)
def complement(formula: Formula, depth: int = _COMPLEMENT_DEPTH) -> Formula:
    """Return the negation of a formula, with ``not`` pushed inwards through up to ``depth`` operators."""
    if formula.op == "not":
        return formula.args[0]
    if formula is TRUE or formula is FALSE:
        return FALSE if formula is TRUE else TRUE
    if not depth or formula.op in ("atom", "iff"):
        return build.not_(formula)
    if formula.op == "implies":
        return build.and_(formula.args[0], complement(formula.args[1], depth - 1))
    args = tuple(complement(argument, depth - 1) for argument in formula.args)
    if formula.op == "and":
        return build.or_(*args)
    return build.and_(*args) if formula.op == "or" else build.temporal(DUAL[formula.op], args)


def value_at_last(formula: Formula, depth: int = _LAST_DEPTH) -> bool | None:
    """Return the truth value that the formula has at the last sample of every trace: True for ``a | N b``.

    Returns None if this value depends on atoms, or if it was not found within ``depth`` nested
    operators.
    """
    op = formula.op
    if op in ("true", "N"):
        return True
    if op in ("false", "X"):
        return False
    if op == "atom" or not depth:
        return None
    values = [value_at_last(argument, depth - 1) for argument in formula.args]
    match op:
        case "not":
            return None if values[0] is None else not values[0]
        case "F" | "G":
            return values[0]
        case "U" | "R":
            return values[1]
        case "and" | "M":
            return _all(values)
        case "or" | "W":
            return _any(values)
        case "implies":
            return _any([None if values[0] is None else not values[0], values[1]])
        case _:
            return None if None in values else values[0] == values[1]


def _all(values: list[bool | None]) -> bool | None:
    if False in values:
        return False
    return None if None in values else True


def _any(values: list[bool | None]) -> bool | None:
    if True in values:
        return True
    return None if None in values else False


def _implies(p: Formula, q: Formula, known: dict[tuple[Formula, Formula], bool], depth: int) -> bool:
    if p is q or p is FALSE or q is TRUE:
        return True
    if signature(p) & ~signature(q):
        return False
    result = known.get((p, q))
    if result is None:
        if depth > _DEEPEST or len(known) > _MOST_PAIRS:
            return False
        known[p, q] = False  # a proof may not use its own conclusion
        result = known[p, q] = _prove(p, q, known, depth + 1)
    return result


def _prove(p: Formula, q: Formula, known: dict[tuple[Formula, Formula], bool], depth: int) -> bool:
    """Whether a law of finite traces shows that ``p`` implies ``q``; each line of the code is a law."""

    def shows(premise: Formula, conclusion: Formula) -> bool:
        return _implies(premise, conclusion, known, depth)

    a, b = p.args, q.args
    if q.op == "and":
        return all(shows(p, part) for part in b)
    if p.op == "or":
        return all(shows(part, q) for part in a)
    if p.op == "implies":
        return shows(a[1], q) and shows(complement(a[0]), q)
    return (
        (p.op == "and" and any(shows(part, q) for part in a))
        or (q.op == "or" and any(shows(p, part) for part in b))
        or (q.op == "implies" and (shows(p, b[1]) or shows(p, complement(b[0]))))
        or (p.op == "not" and q.op == "not" and shows(b[0], a[0]))
        or (p.is_temporal and _weaken_premise(p, q, shows))
        or (q.is_temporal and _strengthen_conclusion(p, q, shows))
        or (p.is_temporal and q.is_temporal and _compare_operands(p, q, shows))
    )


def _weaken_premise(p: Formula, q: Formula, shows: _ImplicationTest) -> bool:
    """Whether ``q`` follows from a formula that the temporal formula ``p`` implies.

    ``G a`` implies ``a``, ``a U b`` implies ``a | b``, …
    """
    a = p.args
    match p.op:
        case "G":
            return shows(a[0], q)
        case "U" | "W":
            return (shows(a[0], q) and shows(a[1], q)) or (p.op == "U" and q.op == "F" and shows(a[1], q))
        case "R" | "M":
            return shows(a[1], q) or (p.op == "M" and q.op == "F" and shows(a[0], q))
        case "F" | "X":
            return q.op == "F" and shows(a[0], q)
        case _:
            return False


def _strengthen_conclusion(p: Formula, q: Formula, shows: _ImplicationTest) -> bool:
    """Whether ``p`` implies a formula from which the temporal formula ``q`` follows.

    ``a`` implies ``F a``, ``b`` implies ``a U b``, …
    """
    b = q.args
    match q.op:
        case "F":
            return shows(p, b[0])
        case "U" | "W":
            return shows(p, b[1]) or (q.op == "W" and p.op == "G" and shows(p, b[0]))
        case "R" | "M":
            return shows(p, b[1]) and (shows(p, b[0]) or (q.op == "R" and p.op == "G"))
        case "G" | "N":
            return p.op == "G" and shows(p, b[0])
        case _:
            return False


def _compare_operands(p: Formula, q: Formula, shows: _ImplicationTest) -> bool:
    """Whether ``q`` has the operator of ``p`` or a weaker operator, and the operands of ``p`` imply those of ``q``.

    For example, ``a U b`` implies ``(a | c) W b``. ``F G`` and ``G F`` count as one operator:
    ``F G a`` and ``G F a`` both mean ``a`` at the last sample.
    """
    a, b = p.args, q.args
    if (p.op, q.op) in _NOT_WEAKER and all(shows(x, y) for x, y in zip(a, b, strict=True)):
        return True
    if (p.op, a[0].op) in _LAST and (q.op, b[0].op) in _LAST:
        return shows(a[0].args[0], b[0].args[0])
    return False


_NOT_WEAKER: Final = frozenset(
    [*((op, op) for op in DUAL), ("X", "N"), ("G", "F"), ("U", "W"), ("M", "R")],
)
_LAST: Final = (("F", "G"), ("G", "F"))
