"""Find the registers that are whole numbers at every sample, which a monitor can keep as integers: *counts*.

The time that something has waited is such a number if the clock does not vary. A register is a count if it starts
as a whole number, if each value that it gets is computed from whole numbers and counts, and if it is otherwise only
compared.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from operator import add
from typing import Final

from tltlc.core.record import record
from tltlc.program.tree import (
    Assign,
    BinaryNumber,
    Choice,
    CommentLine,
    Compare,
    Declare,
    If,
    Int,
    Negate,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
    operands,
    with_operands,
)
from tltlc.program.used_names import parts

_MOST: Final = 2.0**31 - 1.0
"""The greatest magnitude of a value that is computed as an integer."""


@record
class CountCandidate:
    """A register that starts as a whole number: its variables before and after a sample, and its greatest magnitude."""

    before: str
    now: str
    magnitude: float


class Counts:
    """The variables that are counts: those of registers and, in the statements that compute them, temporary ones.

    ``computations`` maps the variables of all atoms and registers that a step computes to their statements, which
    declare them. ``names`` has the names of the counts.
    """

    def __init__(self, computations: Mapping[str, Sequence[Statement]], candidates: Sequence[CountCandidate]) -> None:
        self._twins = {
            one: other
            for register in candidates
            for one, other in ((register.before, register.now), (register.now, register.before))
        }
        self._kept = {name: register.magnitude for register in candidates for name in (register.before, register.now)}
        self._magnitudes: dict[str, float] = {}
        statements = [statement for statements in computations.values() for statement in _flat(statements)]
        temporary = {
            statement.name for statement in statements if isinstance(statement, Declare) and statement.type == "real"
        }
        self.names = set(self._kept) | (temporary - computations.keys())
        while wrong := set(self._wrong(statements)):
            self.names -= wrong | {self._twins[name] for name in wrong if name in self._twins}

    def _wrong(self, statements: Iterable[Statement]) -> Iterator[str]:
        """Yield variables in ``names`` that are no counts, given that the others are."""
        self._magnitudes = {name: magnitude for name, magnitude in self._kept.items() if name in self.names}
        for statement in statements:
            if isinstance(statement, If):
                for test, _ in statement.cases:
                    yield from self._read_as_numbers(test)
            elif not isinstance(statement, CommentLine) and statement.value is not None:
                name, value = statement.name, statement.value
                if name not in self.names:
                    yield from self._read_as_numbers(value)
                    continue
                for node in parts([value]):
                    if isinstance(node, Choice):
                        yield from self._read_as_numbers(node.test)
                magnitude = self._magnitude(value)
                if magnitude is None:
                    yield name
                elif name not in self._kept:
                    self._magnitudes[name] = max(magnitude, self._magnitudes.get(name, 0.0))

    def _read_as_numbers(self, node: ProgramExpression) -> Iterator[str]:
        """Yield the variables in ``names`` that an expression reads otherwise than to compare them."""
        match node:
            case ProgramVariable(name):
                if name in self.names:
                    yield name
            case Compare(_, left, right):
                for side in (left, right):
                    if self._magnitude(side) is None:
                        yield from self._read_as_numbers(side)
            case _:
                for part in operands(node):
                    yield from self._read_as_numbers(part)

    def _magnitude(self, node: ProgramExpression) -> float | None:
        """Return the greatest magnitude of an expression of whole numbers and counts; None for others, or too great."""
        magnitude: float | None = None
        match node:
            case Real(value) if value.is_integer():
                magnitude = abs(value)
            case ProgramVariable(name):
                magnitude = self._magnitudes.get(name)
            case Negate(operand):
                magnitude = self._magnitude(operand)
            case BinaryNumber("+" | "-", left, right):
                magnitude = _both(self._magnitude(left), self._magnitude(right), add)
            case NumericCall("min" | "max", (left, right)) | Choice(_, left, right):
                magnitude = _both(self._magnitude(left), self._magnitude(right), max)
        return magnitude if magnitude is not None and magnitude <= _MOST else None

    # --- statements of integers -------------------------------------------------------------------

    def statements(self, statements: Iterable[Statement]) -> tuple[Statement, ...]:
        """Return statements that compute the same, with counts as integers."""
        return tuple(map(self._statement, statements))

    def _statement(self, statement: Statement) -> Statement:
        match statement:
            case If(cases, otherwise):
                return If(
                    tuple((self._compared(test), self.statements(body)) for test, body in cases),
                    self.statements(otherwise),
                )
            case Declare(name, type_, value, changes):
                written = value and (self._integer(value) if name in self.names else self._compared(value))
                return Declare(name, "int" if name in self.names else type_, written, changes)
            case Assign(name, value):
                return Assign(name, self._integer(value) if name in self.names else self._compared(value))
        return statement

    def _compared(self, node: ProgramExpression) -> ProgramExpression:
        """Return an expression in which counts are compared as integers."""
        match node:
            case Compare(op, left, Real(limit)) if self._magnitude(left) is not None and abs(limit) <= _MOST:
                # Whole numbers are above 300.5 if they are above 300, and below it if they are below 301.
                rounded = math.ceil(limit) if op in ("<", ">=") else math.floor(limit)
                if rounded == limit or op not in ("==", "!="):
                    return Compare(op, self._integer(left), Int(rounded))
            case Compare(op, left, right) if None not in (self._magnitude(left), self._magnitude(right)):
                return Compare(op, self._integer(left), self._integer(right))
        return with_operands(node, map(self._compared, operands(node)))

    def _integer(self, node: ProgramExpression) -> ProgramExpression:
        match node:
            case Real(value):
                return Int(int(value))
            case Choice(test, value, otherwise):
                return Choice(self._compared(test), self._integer(value), self._integer(otherwise))
            case NumericCall(function, (left, right)):
                first, second = self._integer(left), self._integer(right)
                return Choice(Compare("<" if function == "min" else ">", second, first), second, first)
        return with_operands(node, map(self._integer, operands(node)))


def _flat(statements: Iterable[Statement]) -> Iterator[Statement]:
    """Yield statements, each ``if`` before the statements inside it."""
    for statement in statements:
        yield statement
        if isinstance(statement, If):
            for body in (*(body for _, body in statement.cases), statement.otherwise):
                yield from _flat(body)


def _both(left: float | None, right: float | None, joined: Callable[[float, float], float]) -> float | None:
    return None if left is None or right is None else joined(left, right)
