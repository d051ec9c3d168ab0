"""Decide whether a spec without a ``judge`` clause is judged at its goal or at its limit.

The rule is in ``docs/semantics.md``, "When a spec is judged"; the reasons are in ``docs/adr/0009``.
"""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.logic.bounded_operators import bounded_operator, operands_with_bounds
from tltlc.logic.formula import Formula, and_
from tltlc.logic.normal_form import negation_normal_form
from tltlc.resolve.spec import Conjunct, JudgeMode


def judge_of(parts: Iterable[Conjunct]) -> JudgeMode:
    """Return the judge (``goal`` or ``limit``) of a spec over finite traces that has these clauses and no ``judge``."""
    return default_judge(and_(*(part.unbounded or part.formula for part in parts)))


def default_judge(formula: Formula) -> JudgeMode:
    """Return how a spec without a ``judge`` clause is judged: at its ``limit`` or at its ``goal``.

    It is judged at its limit if its formula is true on the empty trace. The formula is taken in
    negation normal form. By convention, literals (``p`` and ``!p`` alike) and formulas with the
    outermost operator ``G``, ``R``, ``W`` or ``N`` are true on the empty trace; formulas with ``F``,
    ``U``, ``M`` or ``X`` are false.
    """
    normal = negation_normal_form(formula)
    value: dict[Formula, bool] = {}
    stack = [normal]
    while stack:
        node = stack[-1]
        waiting = [part for part in _boolean_operands(node) if part not in value]
        if waiting:
            stack.extend(waiting)
        else:
            value[stack.pop()] = _is_true_of_nothing_yet(node, value)
    return "limit" if value[normal] else "goal"


def _boolean_operands(node: Formula) -> list[Formula]:
    """Return the operands of an ``and`` or ``or``; none for any other operator and for ``F[0,n] p``.

    ``F[0,n] p`` is stored as ``p | X(p | …)``, but counts as one temporal operator here.
    """
    if node.op == "or":
        return [] if bounded_operator(node) else operands_with_bounds(node)
    return list(node.args) if node.op == "and" else []


def _is_true_of_nothing_yet(node: Formula, value: dict[Formula, bool]) -> bool:
    if node.op == "and":
        return all(value[operand] for operand in _boolean_operands(node))
    if node.op == "or":
        return any(value[operand] for operand in _boolean_operands(node))
    return node.op not in ("false", "F", "U", "M", "X")
