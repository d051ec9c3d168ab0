"""Decide whether a spec without a ``judge`` clause is judged at its goal or at its limit.

An episode that is judged at its goal ends as soon as it enters an accepting state or a trap. An
episode that is judged at its limit goes on to the limit of steps, or until its verdict is final.

The rule is in ``docs/semantics.md``, "When a spec is judged"; the reasons are in ``docs/adr/0009``.
"""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.logic.bounded_operators import bounded_operator, operands_with_bounds
from tltlc.logic.formula import Formula, and_
from tltlc.logic.normal_form import negation_normal_form
from tltlc.resolve.spec import Conjunct, JudgeMode


def judge_of(parts: Iterable[Conjunct]) -> JudgeMode:
    """Return when a spec over finite traces is judged, given its clauses, of which none is a ``judge`` clause.

    The result is ``goal`` (as soon as the trace is accepted) or ``limit`` (at the limit of steps);
    :func:`default_judge` has the rule.
    """
    return default_judge(and_(*(part.unbounded or part.formula for part in parts)))


def default_judge(formula: Formula) -> JudgeMode:
    """Return when a spec with this formula is judged, if it has no ``judge`` clause.

    The result is ``goal`` (as soon as the trace is accepted) or ``limit`` (at the limit of steps).
    It is ``limit`` if the formula, in negation normal form, is true on the empty trace. By
    convention, literals (``p`` and ``!p`` alike) and formulas with the outermost operator ``G``,
    ``R``, ``W`` or ``N`` are true on the empty trace; formulas with ``F``, ``U``, ``M`` or ``X``
    are false. So ``G p`` is judged at the limit, and ``F q & G p`` at the goal.
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
    """Return the operands of an ``and`` or ``or``; an empty list for any other operator.

    ``F[0,n] p`` also gives an empty list: it is stored as ``p | X(p | …)``, but counts as one
    temporal operator here.
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
