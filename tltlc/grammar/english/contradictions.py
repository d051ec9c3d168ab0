"""Find clauses that forbid what they speak of: `keep begins a implies always for 5 s not a`.

A sentence about a later step of the same condition, such as `after the second a, no a`, would otherwise be read as
one that asks for a and for not a at one step.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.grammar.mistakes.sentences.validity import parsed_clause
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, GroupExpr, IsExpr, NameExpr, NumberExpr, Unary
from tltlc.grammar.walk import operands, parts

Literals = frozenset[tuple[str, bool]]
"""Conditions, as they are written, and whether they hold."""
_POSITIVE: Final = {
    "<": ("<", True), ">=": ("<", False), ">": (">", True), "<=": (">", False), "==": ("==", True), "!=": ("==", False),
}  # fmt: skip
"""Maps the signs of comparisons to one of the two that are opposites, and whether it is the same."""
_COUNTS: Final = ("times", "times_since", "times_within")
_LASTING: Final = ("G", "U", "W")
_NONE: Literals = frozenset()


def forbids_its_event(clauses: Sequence[str]) -> bool:
    """Whether one of some clauses asks for a condition and its negation at one step."""
    return any(_contradicts_itself(clause) for clause in clauses)


def has_empty_option(clause: str) -> bool:
    """Whether an answer is `a or b`, of which a contradicts the condition: `keep begins p implies not p or q`."""
    tree = parsed_clause(clause)
    rule = tree.value if tree is not None else None
    if not isinstance(rule, BinaryExpr) or rule.op != "implies":
        return False
    known = _at_this_step(rule.left, clause)
    options = operands(rule.right, "or", through_brackets=True)
    return len(options) > 1 and any(_differ(known, _at_this_step(option, clause)) for option in options)


def behind_its_event(clause: str) -> str:
    """Return `keep a implies weak_next always for 5 s not a` for the rule that counts from a itself; "" for others."""
    tree = parsed_clause(clause)
    rule = tree.value if tree is not None else None
    if not isinstance(rule, BinaryExpr) or rule.op != "implies" or not isinstance(rule.right, Unary):
        return ""
    answer = rule.right
    if answer.op != "G" or answer.bound is None or not _contradicts_itself(clause):
        return ""
    later = f"{clause[: answer.span.start]}weak_next {clause[answer.span.start :]}"
    return "" if _contradicts_itself(later) else later


def behind_its_count(clause: str) -> str:
    """Return the rule that asks from the next step on, if it forbids with an excuse what its condition counts.

    For `keep begins (times(a) >= 2) implies always for 3 s (not a or b)`, that is `… implies weak_next always for
    3 s (not a or b)`; "" for other rules.
    """
    tree = parsed_clause(clause)
    rule = tree.value if tree is not None else None
    if not isinstance(rule, BinaryExpr) or rule.op != "implies":
        return ""
    counted = _counted(rule.left, clause) or _count(rule.left)
    answer = rule.right
    is_later = isinstance(answer, Unary) and answer.op in ("X", "N", "F")
    if (
        counted is None
        or is_later
        or not any(isinstance(part, (Unary, BinaryExpr)) and part.op in _LASTING for part in parts(answer))
    ):
        return ""
    come = _at_this_step(counted[0], clause)
    if not any(_differ(come, _at_this_step(part, clause)) for part in parts(answer)):
        return ""
    text = clause[answer.span.start : answer.span.end]
    whole = text if isinstance(answer, (Unary, GroupExpr)) else f"({text})"
    return f"{clause[: answer.span.start]}weak_next {whole}"


def _contradicts_itself(clause: str) -> bool:
    tree = parsed_clause(clause)
    rule = tree.value if tree is not None else None
    if not isinstance(rule, BinaryExpr):
        return False
    if rule.op == "implies":
        counted = _count(rule.left)
        come = _NONE if counted is None else _at_this_step(counted[0], clause)
        return _differ(_at_this_step(rule.left, clause) | come, _at_this_step(rule.right, clause))
    if rule.op in ("U", "W"):
        counted = _counted(rule.right, clause)
        if counted is None or counted[1] <= 1:
            return False
        return _differ(_at_this_step(counted[0], clause), _at_this_step(rule.left, clause))
    return False


def _differ(one: Literals, other: Literals) -> bool:
    return any((text, not holds) in other for text, holds in one)


def _at_this_step(expr: Expr, clause: str, *, holds: bool = True) -> Literals:
    """Return conditions that hold, or do not, at each step at which an expression has a truth value."""
    if isinstance(expr, GroupExpr):
        return _at_this_step(expr.inner, clause, holds=holds)
    if isinstance(expr, IsExpr):
        operand = clause[expr.operand.span.start : expr.operand.span.end]
        return frozenset({(f"{operand} is {expr.value}", holds != expr.negated)})
    if isinstance(expr, NameExpr | CallExpr):
        return frozenset({(clause[expr.span.start : expr.span.end], holds)})
    if isinstance(expr, Unary):
        return _of_unary(expr, clause, holds=holds)
    if isinstance(expr, BinaryExpr):
        if (expr.op, holds) in (("and", True), ("or", False)):
            return _at_this_step(expr.left, clause, holds=holds) | _at_this_step(expr.right, clause, holds=holds)
        if expr.op in (">", ">=") and holds and isinstance(expr.left, CallExpr) and expr.left.name == "time_holding":
            return _at_this_step(expr.left.arguments[0].value, clause)
        if expr.op in _POSITIVE:
            sign, is_positive = _POSITIVE[expr.op]
            sides = (clause[side.span.start : side.span.end] for side in (expr.left, expr.right))
            return frozenset({(f" {sign} ".join(sides), holds == is_positive)})
        if (expr.op, holds) == ("implies", False):
            return _at_this_step(expr.left, clause) | _at_this_step(expr.right, clause, holds=False)
    return _NONE


def _of_unary(expr: Unary, clause: str, *, holds: bool) -> Literals:
    """Return what holds at the step of `not p`, `begins p`, `ends p`, `always p`, and of `once p` if it is false."""
    if expr.op == "not":
        return _at_this_step(expr.operand, clause, holds=not holds)
    if expr.op in ("begins", "ends") and holds:
        counted = _counted(expr, clause)
        if counted is not None:
            return _at_this_step(counted[0], clause)
        return _at_this_step(expr.operand, clause, holds=expr.op == "begins")
    is_from_now = expr.bound is None or expr.bound.low is None or expr.bound.low.value == 0.0
    if is_from_now and (expr.op, holds) in (
        ("G", True),
        ("H", True),
        ("historically", True),
        ("once", False),
        ("F", False),
    ):
        return _at_this_step(expr.operand, clause, holds=holds)
    return _NONE


def _counted(expr: Expr, clause: str) -> tuple[Expr, float] | None:
    """Return p and n of `begins (times(p) >= n)`, and p and 1 of `begins (once p)`; None for others."""
    if not isinstance(expr, Unary) or expr.op != "begins":
        return None
    inner = expr.operand.inner if isinstance(expr.operand, GroupExpr) else expr.operand
    if isinstance(inner, Unary) and inner.op == "once" and inner.bound is None:
        operand = inner.operand.inner if isinstance(inner.operand, GroupExpr) else inner.operand
        return operand, 1
    if not isinstance(inner, BinaryExpr):
        return None
    return _count(inner)


def _count(inner: Expr) -> tuple[Expr, float] | None:
    """Return p and n of `times(p) >= n`, which p makes true."""
    if (
        not isinstance(inner, BinaryExpr)
        or inner.op not in (">", ">=", "==")
        or not isinstance(inner.right, NumberExpr)
    ):
        return None
    call = inner.left
    if not isinstance(call, CallExpr) or call.name not in _COUNTS:
        return None
    return call.arguments[0].value, inner.right.value
