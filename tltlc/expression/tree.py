"""Arithmetic expressions over signals and params, from which the value of an atom is computed.

An expression is a tree of immutable nodes. Each class of nodes is a kind of object in the JSON of an
artefact (the file of a compiled automaton). Nodes do not depend on the syntax of the language, and
have no units: every number is in SI units.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, Literal, Union

from tltlc.core.record import record

ArithmeticOp = Literal["+", "-", "*", "/", "^", "neg", "min", "max", "abs", "clamp", "sqrt", "exp", "tanh"]
ConditionOp = Literal["<", "<=", ">", ">=", "and", "or", "not"]

LEAST: Final = 1e-30
"""The least robustness of a true comparison whose scaled margin might round to 0.

If the margin itself is smaller than this, the margin is the least robustness
(:mod:`tltlc.resolve.margins`). The number is tiny, but does not become 0 when it is converted to a
32-bit float.
"""


@record
class Const:
    """A constant, which is a finite number."""

    value: float


@record
class SignalValue:
    """The current value of a signal, by its full name, e.g. ``distance(s1)``; a bool counts as 0 or 1.

    A register (:class:`tltlc.resolve.spec.Register`) is read in the same way: no signal has its name.
    """

    name: str


@record
class ParamValue:
    """The value of a param, that is, of a named number that a source text declares."""

    name: str


@record
class AtomValue:
    """The robustness of an atom at this sample, in [-1, 1]. Only updates of registers read atoms."""

    name: str


@record
class Before:
    """The value of a register before this sample. Only updates of registers read it."""

    name: str


@record
class StepLength:
    """The time from the sample before to this one, in seconds. Only updates of registers read it."""


@record
class Op:
    """An operator or function and its arguments.

    ``neg`` and functions such as ``sqrt`` take one argument, ``clamp`` takes (x, low, high), and ``min``
    and ``max`` take two or more.
    """

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
    """A case distinction: the value of the first case whose condition is true, else ``otherwise``.

    A case is a pair of a condition and a value.
    """

    hashed_once = True
    cases: tuple[tuple[Condition, Expression], ...]
    otherwise: Expression


Recalled = Union[AtomValue, Before, StepLength]
"""What only updates of registers read."""

Expression = Union[Const, SignalValue, ParamValue, AtomValue, Before, StepLength, Op, When]


VariableKey = Union[str, AtomValue, Before, StepLength]
"""The key of a variable in a table of values: the name of a signal or register, or the node that reads the variable."""


def variable_key(node: SignalValue | Recalled) -> VariableKey:
    """Return the key under which tables have the value of a variable."""
    return node.name if isinstance(node, SignalValue) else node


def nodes(expression: Expression | Condition) -> Iterator[Expression | Condition]:
    """Yield an expression and all expressions and conditions inside it, outer before inner, from left to right.

    Does not recurse, so that deep expressions cause no RecursionError.
    """
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
    """Return how deep operators and ``when`` are nested: 0 for ``x``, 1 for ``x + 1``, 2 for ``abs(x + 1)``."""
    height, level = -1, {id(expression): expression}
    while level:
        height += 1
        level = {id(part): part for node in level.values() for part in parts(node)}
    return height


def most_parts(expression: Expression | Condition) -> int:
    """Return the size of the widest node: the most cases of a ``when``, or the most arguments of an operator."""
    return max(len(node.cases) if isinstance(node, When) else len(parts(node)) for node in nodes(expression))


def parts(node: Expression | Condition) -> tuple[Expression | Condition, ...]:
    """Return the direct parts of a node: the arguments of an operator, or the conditions and values of a ``when``.

    Any other node has no parts.
    """
    if isinstance(node, When):
        return (*(part for case in node.cases for part in case), node.otherwise)
    return node.args if isinstance(node, (Op, Condition)) else ()
