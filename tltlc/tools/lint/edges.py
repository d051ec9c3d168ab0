"""Find the beginnings and ends in conditions: `begins a`, `ends a`."""

from __future__ import annotations

from typing import Final

from tltlc.grammar.tree import Expr, Unary
from tltlc.grammar.walk import conjuncts
from tltlc.tools.lint.file_view import ScopedExpression, without_brackets

_EDGES: Final = ("begins", "ends")


def edge_of(condition: ScopedExpression) -> ScopedExpression | None:
    """Return the first beginning or end in a conjunction; None if it has none."""
    tree = next(filter(is_edge, map(without_brackets, conjuncts(condition.tree))), None)
    return None if tree is None else condition.with_tree(tree)


def is_edge(tree: Expr) -> bool:
    """Whether an expression is a beginning or an end."""
    return isinstance(tree, Unary) and tree.op in _EDGES
