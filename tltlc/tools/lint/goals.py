"""Find the goals of a spec: expressions that must hold at some step."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, Quantified, Unary
from tltlc.tools.lint.file_view import ScopedExpression, SpecView, without_brackets


def goals(spec: SpecView) -> Iterator[ScopedExpression]:
    """Yield the goals of a spec, which must hold at some step.

    They are the operands of ``then`` chains and of ``eventually``, and the expressions of ``reach``
    clauses without ``then``. Expressions inside a negation, and the conditions of implications, are
    left out.
    """
    for clause, value in spec.clauses("reach", "keep", "require"):
        if clause.kind == "reach":
            for step in walk.operands(value.tree, "then"):
                yield value.with_tree(step)
                yield from _goals_inside(value.with_tree(step))
        else:
            yield from _goals_inside(value)


def conjuncts(goal: ScopedExpression) -> list[ScopedExpression]:
    """Return the conjuncts of a goal, in order.

    The conjuncts of an `all` quantifier are those of its body, once for each entity.
    """
    parts: list[ScopedExpression] = []
    for tree in walk.conjuncts(goal.tree):
        part = goal.with_tree(without_brackets(tree))
        if isinstance(part.tree, Quantified) and part.tree.all:
            parts += [conjunct for body in part.children() for conjunct in conjuncts(body)]
        else:
            parts.append(part)
    return parts


def consists_of_implications(value: ScopedExpression) -> bool:
    """Whether an expression consists of implications only.

    As a goal, such an expression is met as soon as the conditions of its implications do not hold.
    """
    trees = (part.tree for part in conjuncts(value))
    return all(isinstance(tree, BinaryExpr) and tree.op == "implies" for tree in trees)


def _goals_inside(value: ScopedExpression) -> Iterator[ScopedExpression]:
    """Yield the goals in an expression, outer before inner. Does not recurse."""
    pending = [value]
    while pending:
        part = pending.pop()
        tree = part.tree
        if isinstance(tree, Unary) and tree.op == "not":
            continue
        operands = part.children()
        if isinstance(tree, Unary) and tree.op == "F":
            yield from operands
        elif isinstance(tree, BinaryExpr) and tree.op == "then":
            operands = [part.with_tree(step) for step in walk.operands(tree, "then")]
            yield from operands
        elif isinstance(tree, BinaryExpr) and tree.op == "implies":
            operands = operands[1:]
        pending += reversed(operands)
