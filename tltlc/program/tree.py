"""The statements and expressions that a monitor's step is made of.

Numbers are IEEE doubles; their operations are done in the order written, each rounded.  Where an operation has no value
in Python (a division by 0, a root of a negative number), a language notes that the atom has none, and goes on.
"""

from __future__ import annotations

from typing import Final, Literal, Union

from tltlc.core.record import record

Type = Literal["real", "int", "bool"]

Function = Literal["divide", "power", "sqrt", "exp", "tanh", "abs", "min", "max"]
"""``min`` and ``max`` are of two, and give the first of equal ones: ``b < a ? b : a`` and ``b > a ? b : a``."""

FAILING: Final[frozenset[Function]] = frozenset({"divide", "power", "sqrt", "exp"})
"""Functions that may have no value."""


# --- expressions ----------------------------------------------------------------------------------


@record
class Real:
    """A finite double."""

    value: float


@record
class Int:
    """A whole number."""

    value: int


@record
class Bool:
    """True or false."""

    value: bool


@record
class Variable:
    """A variable by its name in the program, which is one of :class:`Names`' own."""

    name: str


@record
class Negate:
    """``-operand``."""

    operand: Expression


@record
class Binary:
    """``left op right``, of numbers."""

    op: Literal["+", "-", "*", "/"]
    left: Expression
    right: Expression


@record
class Call:
    """A function of numbers."""

    function: Function
    args: tuple[Expression, ...]


@record
class Compare:
    """A test of two numbers of one type."""

    op: Literal["<", "<=", ">", ">=", "==", "!="]
    left: Expression
    right: Expression


@record
class Not:
    """A test that another one fails."""

    operand: Expression


@record
class All:
    """A test that all hold, left to right, no further than to the first that fails; at least two."""

    args: tuple[Expression, ...]


@record
class Any:
    """A test that one holds, left to right, no further than to the first that does; at least two."""

    args: tuple[Expression, ...]


Expression = Union[Real, Int, Bool, Variable, Negate, Binary, Call, Compare, Not, All, Any]


# --- statements -----------------------------------------------------------------------------------


@record
class Declare:
    """A new variable; without a value it is given one later, once on every way, unless it ``changes``."""

    name: str
    type: Type
    value: Expression | None = None
    changes: bool = False


@record
class Assign:
    """A variable's new value."""

    name: str
    value: Expression


@record
class If:
    """The body of the first case whose test holds, else ``otherwise``."""

    cases: tuple[tuple[Expression, tuple[Statement, ...]], ...]
    otherwise: tuple[Statement, ...] = ()


@record
class Comment:
    """A remark, which may hold any characters."""

    text: str


Statement = Union[Declare, Assign, If, Comment]
