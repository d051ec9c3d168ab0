"""The statements and expressions of a monitor's step.

Numbers are IEEE doubles. Operations run in the order written, and each result is rounded. If an
operation has no value (division by 0, root of a negative number), the monitor reports that the atom
has no value.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, Literal, Union

from tltlc.core.record import record

Type = Literal["real", "int", "bool"]

ComparisonOp = Literal["<", "<=", ">", ">=", "==", "!="]

NumericFunction = Literal["divide", "power", "sqrt", "exp", "tanh", "abs", "min", "max"]
"""The numeric functions.

``min`` and ``max`` take two arguments, and return the first one if both are equal:
``b < a ? b : a`` and ``b > a ? b : a``.
"""

FAILING: Final[frozenset[NumericFunction]] = frozenset({"divide", "power", "sqrt", "exp"})
"""Functions that have no value for some arguments."""

Table = Literal["edge_targets", "state_levels", "level_progress"]
"""The tables of numbers that a program may read: fields of :class:`tltlc.program.shapes.StateTables`."""


# --- expressions ----------------------------------------------------------------------------------


@record
class Real:
    """A constant that is a finite double."""

    value: float


@record
class Int:
    """A constant that is an integer."""

    value: int


@record
class Bool:
    """The constant true or false."""

    value: bool


@record
class ProgramVariable:
    """A variable. Its ``name`` is unique in the program (see :class:`tltlc.program.names.VariableNames`)."""

    name: str


@record
class Negate:
    """The number ``-operand``."""

    operand: ProgramExpression


@record
class BinaryNumber:
    """An arithmetic operation on two numbers."""

    op: Literal["+", "-", "*", "/"]
    left: ProgramExpression
    right: ProgramExpression


@record
class NumericCall:
    """A call of a numeric function."""

    function: NumericFunction
    args: tuple[ProgramExpression, ...]


@record
class Compare:
    """A comparison of two numbers of the same type."""

    op: ComparisonOp
    left: ProgramExpression
    right: ProgramExpression


@record
class Not:
    """The negation of a test."""

    operand: ProgramExpression


@record
class All:
    """The ``and`` of at least two tests, evaluated from left to right until one of them is false."""

    args: tuple[ProgramExpression, ...]


@record
class Any:
    """The ``or`` of at least two tests, evaluated from left to right until one of them is true."""

    args: tuple[ProgramExpression, ...]


@record
class Choice:
    """The value of ``value`` if the test is true, else that of ``otherwise``; only this one is computed."""

    test: ProgramExpression
    value: ProgramExpression
    otherwise: ProgramExpression


@record
class TableEntry:
    """The entry of a table at an index, which is an integer from 0."""

    table: Table
    index: ProgramExpression


ProgramExpression = Union[
    Real, Int, Bool, ProgramVariable, Negate, BinaryNumber, NumericCall, Compare, Not, All, Any, Choice, TableEntry
]


def operands(node: ProgramExpression) -> tuple[ProgramExpression, ...]:
    """Return the expressions of which an expression is made, in order."""
    match node:
        case BinaryNumber(_, left, right) | Compare(_, left, right):
            return left, right
        case NumericCall(_, args) | All(args) | Any(args):
            return args
        case Choice(test, value, otherwise):
            return test, value, otherwise
        case Negate(operand) | Not(operand) | TableEntry(_, operand):
            return (operand,)
    return ()


def with_operands(node: ProgramExpression, new: Iterable[ProgramExpression]) -> ProgramExpression:
    """Return an expression like ``node`` that is made of ``new`` expressions, as many as :func:`operands` returns."""
    made = tuple(new)
    match node:
        case BinaryNumber(op, _, _):
            return BinaryNumber(op, *made)
        case Compare(comparison, _, _):
            return Compare(comparison, *made)
        case NumericCall(function, _):
            return NumericCall(function, made)
        case All() | Any():
            return All(made) if isinstance(node, All) else Any(made)
        case Choice():
            return Choice(*made)
        case Negate() | Not():
            return Negate(*made) if isinstance(node, Negate) else Not(*made)
        case TableEntry(table, _):
            return TableEntry(table, *made)
    return node


# --- statements -----------------------------------------------------------------------------------


@record
class Declare:
    """The declaration of a variable.

    If ``value`` is None, every path through the program assigns a value before the variable is
    read. ``changes`` says whether the program may assign to the variable again after its first
    value.
    """

    name: str
    type: Type
    value: ProgramExpression | None = None
    changes: bool = False


@record
class Assign:
    """An assignment to a variable."""

    name: str
    value: ProgramExpression


@record
class If:
    """A statement that runs the body of the first case whose test is true.

    A case is a test and its body. If no test is true, ``otherwise`` runs.
    """

    cases: tuple[tuple[ProgramExpression, tuple[Statement, ...]], ...]
    otherwise: tuple[Statement, ...] = ()


@record
class CommentLine:
    """A comment, whose text may contain any characters."""

    text: str


Statement = Union[Declare, Assign, If, CommentLine]
