"""Expressions with other signals, params and constants in the same places."""

from __future__ import annotations

from collections.abc import Callable
from typing import Union

from tltlc.expression.tree import Condition, Const, Expression, Op, Param, Signal, When

Leaf = Union[Const, Signal, Param]


def with_leaves(node: Expression, change: Callable[[Leaf], Leaf]) -> Expression:
    """The expression with each of its leaves changed."""
    match node:
        case Op():
            return Op(node.op, tuple(with_leaves(each, change) for each in node.args))
        case When():
            cases = tuple((_condition(when, change), with_leaves(then, change)) for when, then in node.cases)
            return When(cases, with_leaves(node.otherwise, change))
        case _:
            return change(node)


def _condition(node: Condition, change: Callable[[Leaf], Leaf]) -> Condition:
    return Condition(
        node.op,
        tuple(
            _condition(each, change) if isinstance(each, Condition) else with_leaves(each, change) for each in node.args
        ),
    )
