"""Unfold bounded operators into steps: ``F[0,2] p`` becomes ``p | X(p | X p)``."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.logic.formula import Formula, and_, bound_of, next_, or_, rebuild, weak_next
from tltlc.resolve.context import LARGEST_EXPANSION, Context, expansion_error


def unfold(formula: Formula, context: Context) -> Formula:
    """Return the formula without bounded operators.

    ``F`` becomes ``X`` (strong next), so ``F[a,b] p`` is false past the end of the trace. ``G`` becomes
    ``N`` (weak next), so ``G[a,b] p`` requires nothing there. Raises ResolutionError (TLT0315) if the
    formula becomes too large.
    """
    if not any(True for _ in bounded_parts(formula)):
        return formula
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        operands = tuple(done[operand] for operand in node.args)
        done[node] = _unfolded(node, operands[0], context) if bound_of(node) else rebuild(node, operands)
    return done[formula]


def bounded_parts(formula: Formula) -> Iterator[Formula]:
    """Yield the distinct bounded operators in a formula."""
    return (node for node in formula.walk() if node.op in ("F[]", "G[]"))


def _unfolded(node: Formula, operand: Formula, context: Context) -> Formula:
    bound, place = bound_of(node), context.bound_of[node]
    assert bound is not None, "a bounded operator"
    subject = f"the bound of `{place.operator}`"
    if 2 * bound.high + (bound.high - bound.low + 1) * context.tree_size(operand) > 2 * LARGEST_EXPANSION:
        raise expansion_error(subject, place.source, place.span, is_bound=True)
    result = operand
    join, step = (and_, weak_next) if node.op == "G[]" else (or_, next_)
    for _ in range(bound.high - bound.low):
        result = join(operand, step(result))
    for _ in range(bound.low):
        result = step(result)
    return context.check_size(result, subject, place.source, place.span, is_bound=True)
