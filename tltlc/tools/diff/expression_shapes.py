"""Replace the leaves of expressions: signals, params and constants."""

from __future__ import annotations

from collections.abc import Callable
from typing import Union

from tltlc.expression.tree import (
    AtomValue,
    Before,
    Condition,
    Const,
    Expression,
    Op,
    ParamValue,
    SignalValue,
    StepLength,
    When,
)

ExpressionLeaf = Union[Const, SignalValue, ParamValue, AtomValue, Before, StepLength]


def replace_leaves(node: Expression, change: Callable[[ExpressionLeaf], ExpressionLeaf]) -> Expression:
    """Return the expression in which ``change(leaf)`` takes the place of each leaf.

    The leaves are all nodes without parts, including those in conditions.
    """
    match node:
        case Op():
            return Op(node.op, tuple(replace_leaves(arg, change) for arg in node.args))
        case When():
            cases = tuple((_condition(when, change), replace_leaves(then, change)) for when, then in node.cases)
            return When(cases, replace_leaves(node.otherwise, change))
        case _:
            return change(node)


def _condition(node: Condition, change: Callable[[ExpressionLeaf], ExpressionLeaf]) -> Condition:
    return Condition(
        node.op,
        tuple(
            _condition(arg, change) if isinstance(arg, Condition) else replace_leaves(arg, change) for arg in node.args
        ),
    )
