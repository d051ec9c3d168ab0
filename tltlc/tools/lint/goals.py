"""The goals of a spec: what has to come at some time, one step each."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.grammar import walk
from tltlc.grammar.tree import Binary, Quantified, Unary
from tltlc.tools.lint.file_view import Expression, SpecView, inner


def goals(spec: SpecView) -> Iterator[Expression]:
    """The steps of each ``reach`` and ``then``, and what stands behind ``eventually``; nothing of what is negated."""
    for clause, value in spec.clauses("reach", "keep", "require"):
        if clause.kind == "reach":
            for step in walk.operands(value.tree, "then"):
                yield value.at(step)
                yield from _inside(value.at(step))
        else:
            yield from _inside(value)


def conjuncts(goal: Expression) -> list[Expression]:
    """What a goal asks for together, in order; of `all` what it asks for of each entity."""
    found: list[Expression] = []
    for tree in walk.conjuncts(goal.tree):
        part = goal.at(inner(tree))
        if isinstance(part.tree, Quantified) and part.tree.all:
            found += [each for body in part.children() for each in conjuncts(body)]
        else:
            found.append(part)
    return found


def is_of_implications(value: Expression) -> bool:
    """Whether it asks for nothing else: as a goal it would be met by their conditions not holding."""
    trees = (part.tree for part in conjuncts(value))
    return all(isinstance(tree, Binary) and tree.op == "implies" for tree in trees)


def _inside(value: Expression) -> Iterator[Expression]:
    """The goals in an expression, outer before inner; takes no recursion."""
    waiting = [value]
    while waiting:
        part = waiting.pop()
        tree = part.tree
        if isinstance(tree, Unary) and tree.op == "not":
            continue
        found = part.children()
        if isinstance(tree, Unary) and tree.op == "F":
            yield from found
        elif isinstance(tree, Binary) and tree.op == "then":
            found = [part.at(step) for step in walk.operands(tree, "then")]
            yield from found
        elif isinstance(tree, Binary) and tree.op == "implies":
            found = found[1:]
        waiting += reversed(found)
