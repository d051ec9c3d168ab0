"""Find the goals of a spec: expressions that must hold at some step."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, Quantified, Unary
from tltlc.tools.lint.file_view import ScopedExpression, SpecView, without_brackets


def goals(spec: SpecView, *, answers: bool = True) -> Iterator[ScopedExpression]:
    """Yield the goals of a spec: the expressions that must hold at some step.

    They are the operands of ``eventually``, each step of a chain ``a then b then c``, and the
    expression of a ``reach`` clause without ``then``. Parts of a negation, and of the condition of an
    implication, do not count. For ``reach a then b``, yield a and b.

    If ``answers`` is false, parts of the result of an implication do not count either, nor of ``b`` in
    ``within 2 s of a, b``. They are an answer to the condition, and no goal of play.
    """
    for clause, value in spec.clauses("reach", "keep", "require"):
        if clause.kind == "reach":
            for step in walk.operands(value.tree, "then"):
                yield value.with_tree(step)
                yield from _goals_inside(value.with_tree(step), answers=answers)
        else:
            yield from _goals_inside(value, answers=answers)


def conjuncts(goal: ScopedExpression) -> list[ScopedExpression]:
    """Return the conjuncts of a goal, in order, without brackets around them.

    An `all` quantifier counts as the conjunction of its body for each entity. So
    ``a and all x in (s1, s2): near(x)`` has the conjuncts ``a``, ``near(s1)`` and ``near(s2)``.
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
    """Whether an expression is an implication, or a conjunction of implications only.

    If such an expression is a goal, a step meets it as soon as no condition of the implications holds.
    """
    trees = (part.tree for part in conjuncts(value))
    return all(isinstance(tree, BinaryExpr) and tree.op == "implies" for tree in trees)


def _goals_inside(value: ScopedExpression, *, answers: bool) -> Iterator[ScopedExpression]:
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
        elif isinstance(tree, BinaryExpr) and tree.op in ("implies", "within"):
            operands = operands[1:] if answers else []
        pending += reversed(operands)
