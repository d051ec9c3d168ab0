"""The statements and expressions of a monitor's step.

Numbers are IEEE doubles. Operations run in the order written, and each result is rounded. Where an
operation has no value in Python (division by 0, root of a negative number), the printed program
records that the atom has no value, and continues.
"""

from __future__ import annotations

from typing import Final, Literal, Union

from tltlc.core.record import record

Type = Literal["real", "int", "bool"]

Function = Literal["divide", "power", "sqrt", "exp", "tanh", "abs", "min", "max"]
"""The numeric functions.

``min`` and ``max`` take two arguments, and return the first one if both are equal: ``b < a ? b : a``
and ``b > a ? b : a``.
"""

FAILING: Final[frozenset[Function]] = frozenset({"divide", "power", "sqrt", "exp"})
"""Functions that have no value for some arguments."""


# --- expressions ----------------------------------------------------------------------------------


@record
class Real:
    """A finite double."""

    value: float


@record
class Int:
    """An integer."""

    value: int


@record
class Bool:
    """True or false."""

    value: bool


@record
class Variable:
    """A variable, by its name in the program; :class:`tltlc.program.names.VariableNames` gives these names."""

    name: str


@record
class Negate:
    """``-operand``."""

    operand: Expression


@record
class BinaryNumber:
    """``left op right`` of two numbers."""

    op: Literal["+", "-", "*", "/"]
    left: Expression
    right: Expression


@record
class NumericCall:
    """A call of a numeric function."""

    function: Function
    args: tuple[Expression, ...]


@record
class Compare:
    """A comparison of two numbers of one type."""

    op: Literal["<", "<=", ">", ">=", "==", "!="]
    left: Expression
    right: Expression


@record
class Not:
    """A test that holds if its operand fails."""

    operand: Expression


@record
class All:
    """``and`` of at least two tests, evaluated left to right up to the first that fails."""

    args: tuple[Expression, ...]


@record
class Any:
    """``or`` of at least two tests, evaluated left to right up to the first that holds."""

    args: tuple[Expression, ...]


Expression = Union[Real, Int, Bool, Variable, Negate, BinaryNumber, NumericCall, Compare, Not, All, Any]


# --- statements -----------------------------------------------------------------------------------


@record
class Declare:
    """A new variable.

    Without a value, it is assigned later: exactly once on each path, unless it ``changes``.
    """

    name: str
    type: Type
    value: Expression | None = None
    changes: bool = False


@record
class Assign:
    """An assignment to a variable."""

    name: str
    value: Expression


@record
class If:
    """A branch: runs the body of the first case whose test holds, else ``otherwise``."""

    cases: tuple[tuple[Expression, tuple[Statement, ...]], ...]
    otherwise: tuple[Statement, ...] = ()


@record
class CommentLine:
    """A comment, which may contain any characters."""

    text: str


Statement = Union[Declare, Assign, If, CommentLine]
