"""Arithmetic over signals and params, from which an atom's robustness is computed.

The nodes match the artefact's JSON one to one (``expression`` of an atom). They are frozen,
independent of the surface syntax, and have no units: every number is in SI units.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Literal, Union

from tltlc.core.record import record

ArithmeticOp = Literal["+", "-", "*", "/", "^", "neg", "min", "max", "abs", "clamp", "sqrt", "exp", "tanh"]
ConditionOp = Literal["<", "<=", ">", ">=", "and", "or", "not"]

LEAST: Final = 1e-30
"""The least robustness of a comparison whose margin is greater than this number.

It is tiny, but not 0 as a 32-bit float.
"""


@record
class Const:
    """A finite number."""

    value: float


@record
class SignalValue:
    """The current value of a signal, by its full name, e.g. ``distance(s1)``; a bool counts as 0 or 1."""

    name: str


@record
class ParamValue:
    """The value of a param."""

    name: str


@record
class Op:
    """An operator or function; ``clamp`` takes (x, low, high), ``min`` and ``max`` take two or more arguments."""

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
    """The value of the first case whose condition is true, else ``otherwise``."""

    hashed_once = True
    cases: tuple[tuple[Condition, Expression], ...]
    otherwise: Expression


Expression = Union[Const, SignalValue, ParamValue, Op, When]


def nodes(expression: Expression | Condition) -> Iterator[Expression | Condition]:
    """Yield all nodes in order of appearance, each before its parts; does not recurse."""
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
    """Return how deep operators nest: 0 for a number or a signal. Shared parts are visited once per level."""
    height, level = -1, {id(expression): expression}
    while level:
        height += 1
        level = {id(part): part for node in level.values() for part in parts(node)}
    return height


def most_parts(expression: Expression | Condition) -> int:
    """Return the most cases of one ``when`` in an expression, or the most arguments of one operator."""
    return max(len(node.cases) if isinstance(node, When) else len(parts(node)) for node in nodes(expression))


def parts(node: Expression | Condition) -> tuple[Expression | Condition, ...]:
    """Return the direct parts of a node."""
    if isinstance(node, When):
        return (*(part for case in node.cases for part in case), node.otherwise)
    return node.args if isinstance(node, (Op, Condition)) else ()
