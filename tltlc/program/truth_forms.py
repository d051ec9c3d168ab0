"""Compute of atoms and registers only whether they are above 0, where nothing else of them is needed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from tltlc.program.borders import border_test
from tltlc.program.build import Program
from tltlc.program.tree import (
    All,
    Any,
    Assign,
    Bool,
    Choice,
    Compare,
    Declare,
    If,
    Not,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
    operands,
    with_operands,
)

_ZERO: Final = Real(0.0)


class TruthForms:
    """The statements that compute atoms and registers as Booleans, true above 0, or as numbers.

    ``computations`` maps the variables of atoms and registers to the statements of ``program`` that declare and
    compute them.

    - ``statements`` has the new statements.
    - ``numbers`` has the variables of atoms and registers that are numbers, because a statement reads them as such or
      their values must be checked. The others are Booleans, also before a sample.
    - ``bool_numbers`` has the variables of bool signals that are read as 0 or 1.
    """

    def __init__(self, program: Program, computations: Mapping[str, Sequence[Statement]]) -> None:
        self._ranges, self._twins = program.ranges, dict(zip(program.registers, program.before, strict=True))
        signals = zip(program.fspa.signals, program.signals, strict=True)
        self._bools = {name for signal, name in signals if signal.type == "bool"} - program.booleans
        real = {name for name, statements in computations.items() if _declares_number(name, statements)}
        self._real = real | {self._twins[name] for name in real & self._twins.keys()}
        self.numbers, self.bool_numbers = real - program.unchecked, set[str]()
        known = -1
        # A variable that becomes a number may make others numbers.
        while known < len(self.numbers) + len(self.bool_numbers):
            for now, before in self._twins.items():
                if now in real and not {now, before}.isdisjoint(self.numbers):
                    self.numbers |= {now, before}
            known = len(self.numbers) + len(self.bool_numbers)
            self.statements = {name: self._computed(name, statements) for name, statements in computations.items()}

    def holds(self, name: str) -> ProgramExpression:
        """Return a test that is true where the variable of an atom or register is above 0."""
        return Compare(">", ProgramVariable(name), _ZERO) if name in self.numbers else ProgramVariable(name)

    # --- statements -------------------------------------------------------------------------------

    def _computed(self, name: str, statements: Iterable[Statement]) -> tuple[Statement, ...]:
        is_boolean = name in self._real and name not in self.numbers
        return self._statements(statements, name if is_boolean else None)

    def _statements(self, statements: Iterable[Statement], boolean: str | None) -> tuple[Statement, ...]:
        """Return statements in which the variable ``boolean`` says whether its number is above 0."""
        return tuple(self._statement(statement, boolean) for statement in statements)

    def _statement(self, statement: Statement, boolean: str | None) -> Statement:
        match statement:
            case If(cases, otherwise):
                written = tuple((self._rewrite(test), self._statements(body, boolean)) for test, body in cases)
                return If(written, self._statements(otherwise, boolean))
            case Declare(name, type_, value, changes):
                if name == boolean:
                    return Declare(name, "bool", value and self._truth(value), changes)
                return Declare(name, type_, value and self._rewrite(value), changes)
            case Assign(name, value):
                return Assign(name, self._truth(value) if name == boolean else self._rewrite(value))
        return statement

    # --- expressions ------------------------------------------------------------------------------

    def _rewrite(self, node: ProgramExpression) -> ProgramExpression:
        """Return the expression with tests of Booleans instead of numbers; note which variables it needs as numbers."""
        match node:
            case Compare(">", ProgramVariable(name), Real(0.0)) if self._is_known(name):
                return self._truth(node.left)
            case Compare("<=", ProgramVariable(name), Real(0.0)) if self._is_known(name):
                return _not(self._truth(node.left))
            case ProgramVariable(name):
                if name in self._real:
                    self.numbers.add(name)
                elif name in self._bools:
                    self.bool_numbers.add(name)
        return with_operands(node, map(self._rewrite, operands(node)))

    def _truth(self, node: ProgramExpression) -> ProgramExpression:
        """Return a test that is true where an expression, which is never NaN, is above 0."""
        match node:
            case Real(value):
                return Bool(value > 0.0)
            case ProgramVariable(name) if self._is_known(name) and name not in self.numbers | self.bool_numbers:
                return node
            case Choice(test, value, otherwise):
                return _choice(self._rewrite(test), self._truth(value), self._truth(otherwise))
            case NumericCall("min" | "max", (left, right)):
                return _joined(node.function == "min", self._truth(left), self._truth(right))
        border = border_test(node, self._ranges)
        match border:
            case Compare(op, ProgramVariable(name), Real(limit)) if name in self._bools:
                return self._of_bool(ProgramVariable(name), _compare(0.0, op, limit), _compare(1.0, op, limit))
            case None:
                return Compare(">", self._rewrite(node), _ZERO)
        return self._rewrite(border)

    def _is_known(self, name: str) -> bool:
        return name in self._real or name in self._bools

    def _of_bool(self, variable: ProgramVariable, at_0: bool, at_1: bool) -> ProgramExpression:
        """Return a test with the truth ``at_0`` where a bool signal is 0, and ``at_1`` where it is 1."""
        return _choice(self._truth(variable), Bool(at_1), Bool(at_0))


def _declares_number(name: str, statements: Iterable[Statement]) -> bool:
    declared = (statement for statement in statements if isinstance(statement, Declare))
    return any(declaration.name == name and declaration.type == "real" for declaration in declared)


def _compare(number: float, op: str, limit: float) -> bool:
    return {">": number > limit, ">=": number >= limit, "<": number < limit, "<=": number <= limit}[op]


def _not(test: ProgramExpression) -> ProgramExpression:
    match test:
        case Bool(value):
            return Bool(not value)
        case Not(operand):
            return operand
    return Not(test)


def _joined(is_and: bool, left: ProgramExpression, right: ProgramExpression) -> ProgramExpression:
    if left == right:
        return left
    for one, other in ((left, right), (right, left)):
        if isinstance(one, Bool):
            return other if one.value == is_and else one
    return All((left, right)) if is_and else Any((left, right))


def _choice(test: ProgramExpression, value: ProgramExpression, otherwise: ProgramExpression) -> ProgramExpression:
    if value == otherwise:
        return value
    if isinstance(value, Bool):
        return _joined(False, test, otherwise) if value.value else _joined(True, _not(test), otherwise)
    if isinstance(otherwise, Bool):
        return _joined(False, _not(test), value) if otherwise.value else _joined(True, test, value)
    return Choice(test, value, otherwise)
