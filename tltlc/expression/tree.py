"""Arithmetic over signals and params: what an atom's robustness is computed from.

The nodes mirror the artefact's JSON one to one (design: ``expression`` of an atom).  They are
frozen, know nothing of the surface language and hold no units: every number is in SI units.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Literal, Union

from tltlc.core.record import record

ArithmeticOp = Literal["+", "-", "*", "/", "^", "neg", "min", "max", "abs", "clamp", "sqrt", "exp", "tanh"]
ConditionOp = Literal["<", "<=", ">", ">=", "and", "or", "not"]

LEAST: Final = 1e-30
"""The least robustness of a comparison that is true by more: small, and yet a number in formats of 32 bits."""


@record
class Const:
    """A finite number."""

    value: float


@record
class Signal:
    """The present value of a signal, by its full name, e.g. ``distance(s1)``; a bool counts as 0 or 1."""

    name: str


@record
class Param:
    """The value of a param, by name."""

    name: str


@record
class Op:
    """An operator or function over expressions; ``clamp`` takes (x, low, high), ``min`` and ``max`` two or more."""

    hashed_once = True
    op: ArithmeticOp
    args: tuple[Expression, ...]


@record
class Condition:
    """A comparison of two expressions, or ``and``, ``or``, ``not`` over conditions."""

    hashed_once = True
    op: ConditionOp
    args: tuple[Union[Expression, Condition], ...]


@record
class When:
    """The first case whose condition holds, else ``otherwise``."""

    hashed_once = True
    cases: tuple[tuple[Condition, Expression], ...]
    otherwise: Expression


Expression = Union[Const, Signal, Param, Op, When]


def nodes(expression: Expression | Condition) -> Iterator[Expression | Condition]:
    """Every node, in order of appearance, each before its parts; takes no recursion."""
    stack: list[Expression | Condition] = [expression]
    while stack:
        node = stack.pop()
        yield node
        if isinstance(node, (Op, Condition)):
            stack.extend(reversed(node.args))
        elif isinstance(node, When):
            stack.append(node.otherwise)
            for condition, value in reversed(node.cases):
                stack += (value, condition)


def depth(expression: Expression | Condition) -> int:
    """How many operators stand in each other: 0 for a number or a signal.  Shared parts are looked at once a level."""
    found, level = -1, {id(expression): expression}
    while level:
        found += 1
        level = {id(part): part for node in level.values() for part in parts(node)}
    return found


def most_parts(expression: Expression | Condition) -> int:
    """The most cases that a ``when`` has in an expression, or the most arguments that an operator has."""
    return max(len(node.cases) if isinstance(node, When) else len(parts(node)) for node in nodes(expression))


def parts(node: Expression | Condition) -> tuple[Expression | Condition, ...]:
    """What a node is made of."""
    if isinstance(node, When):
        return (*(part for case in node.cases for part in case), node.otherwise)
    return node.args if isinstance(node, (Op, Condition)) else ()
