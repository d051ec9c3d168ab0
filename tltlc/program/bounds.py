"""What is sure of numbers before a monitor runs: divisors that are never 0, atoms that never leave their range.

Signals and params are finite and in their ranges, which a monitor sees to.  From there intervals are computed, with
what the tests before a statement tell.  Operations of doubles round, but never turn an order around, so that the
rounded ends of an interval bound the rounded results.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Final, Literal

from tltlc.core.record import record, replace
from tltlc.program.tree import (
    All,
    Any,
    Assign,
    Binary,
    Call,
    Compare,
    Declare,
    Expression,
    If,
    Negate,
    Not,
    Real,
    Statement,
    Variable,
)
from tltlc.program.uses import parts

_MOST: Final = sys.float_info.max
_OPPOSITE: Final[Mapping[str, Literal["<", "<=", ">", ">="]]] = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}


@record
class Range:
    """Between which ends a value lies that is sure to be a number; infinite ends may be reached."""

    low: float
    high: float

    def without_zero(self) -> bool:
        """Whether it is sure not to be 0."""
        return self.low > 0.0 or self.high < 0.0


def within(low: float | None, high: float | None) -> Range:
    """Finite, and between the ends that there are."""
    return Range(-_MOST if low is None else low, _MOST if high is None else high)


def proven(
    name: str, statements: Sequence[Statement], known: Mapping[str, Range]
) -> tuple[tuple[Statement, ...], Range | None]:
    """The statements, in which ``/`` divides where the divisor is sure not to be 0, and the range of a variable then.

    ``known`` are the ranges of the variables that are there before.  The range is None where the variable may be no
    number.
    """
    facts = _Facts({Variable(variable): range_ for variable, range_ in known.items()}, frozenset())
    written = facts.statements(statements)
    return written, facts.range(Variable(name))


class _Facts:
    """What holds at a point of a program: ranges of expressions, and pairs of which the first is at most the second.

    ``assigned`` are the variables from outside that statements have given a value.
    """

    def __init__(self, ranges: dict[Expression, Range], ordered: frozenset[tuple[Expression, Expression]]) -> None:
        self._ranges, self._ordered = ranges, ordered
        self._computed_before: dict[Expression, Range | None] = {}
        self._compared: set[Expression] = set()
        self.assigned: dict[str, None] = {}

    # --- statements -------------------------------------------------------------------------------

    def statements(self, statements: Iterable[Statement]) -> tuple[Statement, ...]:
        """The statements, rewritten; afterwards what holds behind them is known here."""
        found: list[Statement] = []
        declared: set[str] = set()
        for statement in statements:
            if isinstance(statement, If):
                found.append(self._branches(statement))
            elif isinstance(statement, (Declare, Assign)):
                value = None if statement.value is None else self.written(statement.value)
                self._give(statement.name, None if value is None else self.range(value))
                found.append(replace(statement, value=value))
            else:
                found.append(statement)
            if isinstance(statement, Declare):
                declared.add(statement.name)
        for name in declared:
            self.assigned.pop(name, None)
        return tuple(found)

    def _branches(self, statement: If) -> If:
        """Behind a branch a variable is in the range of one of the cases."""
        before = self._copy()
        ends: list[_Facts] = []
        cases = []
        for test, body in statement.cases:
            rewritten = before.written(test)
            inside = before._copy()
            inside._assume(test, True)
            cases.append((rewritten, inside.statements(body)))
            ends.append(inside)
            before._assume(test, False)
        otherwise = before.statements(statement.otherwise)
        ends.append(before)
        for name in {name: None for end in ends for name in end.assigned}:
            self._give(name, _hull([end._ranges.get(Variable(name)) for end in ends]))
        return If(tuple(cases), otherwise)

    def _give(self, name: str, range_: Range | None) -> None:
        """A variable has a new value: what was known of it is no longer true."""
        variable = Variable(name)
        self._computed_before.clear()
        self._ranges.pop(variable, None)
        if variable in self._compared:
            for node in [node for node in self._ranges if variable in parts([node])]:
                del self._ranges[node]
            self._ordered = frozenset(pair for pair in self._ordered if variable not in parts(pair))
        if range_ is not None:
            self._ranges[variable] = range_
        self.assigned[name] = None

    def _copy(self) -> _Facts:
        copied = _Facts(dict(self._ranges), self._ordered)
        copied._compared = set(self._compared)
        return copied

    # --- tests ------------------------------------------------------------------------------------

    def _assume(self, test: Expression, holds: bool) -> None:
        """The test has come out so."""
        match test:
            case Not(operand):
                self._assume(operand, not holds)
            case All(args) if holds:
                for argument in args:
                    self._assume(argument, True)
            case Any(args) if not holds:
                for argument in args:
                    self._assume(argument, False)
            case Compare(op, left, right) if op in _OPPOSITE:
                low, high = self.range(left), self.range(right)
                # Of what may be no number a test that fails tells nothing.
                if low is None or high is None:
                    return
                op = op if holds else _OPPOSITE[op]
                if op in (">", ">="):
                    left, right, low, high = right, left, high, low
                # Strictly less is at most the next number below.
                least, most = low.low, high.high
                if op in ("<", ">"):
                    least, most = math.nextafter(least, math.inf), math.nextafter(most, -math.inf)
                self._ordered |= {(left, right)}
                self._compared.update(parts((left, right)))
                self._computed_before.clear()
                self._narrow(left, Range(low.low, min(low.high, most)))
                self._narrow(right, Range(max(least, high.low), high.high))

    def _narrow(self, node: Expression, range_: Range) -> None:
        # A test that cannot come out so has an empty range: its case is never met, whatever is said of it.
        if range_.low <= range_.high and not isinstance(node, Real):
            self._ranges[node] = range_

    # --- expressions ------------------------------------------------------------------------------

    def written(self, node: Expression) -> Expression:
        """The expression, in which ``/`` divides where the divisor is sure not to be 0."""
        match node:
            case Call("divide", (left, right)):
                left, right = self.written(left), self.written(right)
                divisor = self.range(right)
                if divisor is not None and divisor.without_zero():
                    return Binary("/", left, right)
                return Call("divide", (left, right))
            case Call(function, args):
                return Call(function, tuple(map(self.written, args)))
            case Binary(op, left, right):
                return Binary(op, self.written(left), self.written(right))
            case Compare(compared, left, right):
                return Compare(compared, self.written(left), self.written(right))
            case Negate(operand):
                return Negate(self.written(operand))
            case Not(operand):
                return Not(self.written(operand))
            case All(args):
                return All(tuple(map(self.written, args)))
            case Any(args):
                return Any(tuple(map(self.written, args)))
        return node

    def range(self, node: Expression) -> Range | None:
        """Where the value of an expression lies; None where it may be no number, or nothing is known."""
        if node in self._computed_before:
            return self._computed_before[node]
        computed = self._computed(node)
        known = self._ranges.get(node)
        if computed is not None and known is not None:
            known = Range(max(computed.low, known.low), min(computed.high, known.high))
        self._computed_before[node] = known = known or computed
        return known

    def _computed(self, node: Expression) -> Range | None:
        match node:
            case Real(value):
                return Range(value, value)
            case Negate(operand):
                range_ = self.range(operand)
                return range_ and Range(-range_.high, -range_.low)
            case Binary("-", left, right):
                return self._difference(left, right)
            case Binary("/", left, right):
                return self._quotient(left, right)
            case Binary("*", left, right) if left == right:
                range_ = self.range(left)
                return range_ and _square(range_)
            case Binary(op, left, right):
                return _ends(lambda x, y: x * y if op == "*" else x + y, self.range(left), self.range(right), op)
            case Call("min" | "max" as function, (left, right)):
                first, second = self.range(left), self.range(right)
                if first is None or second is None:
                    return None
                pick = min if function == "min" else max
                return Range(pick(first.low, second.low), pick(first.high, second.high))
            case Call("abs", (operand,)):
                range_ = self.range(operand)
                return range_ and _absolute(range_)
            case Call("tanh", (operand,)):
                # Languages that have none compute it from others, and round.
                return Range(-2.0, 2.0) if self.range(operand) else None
        return None

    def _difference(self, left: Expression, right: Expression) -> Range | None:
        found = _ends(lambda x, y: x - y, self.range(left), self.range(right), "-")
        if found is not None and (right, left) in self._ordered:
            return Range(max(found.low, 0.0), max(found.high, 0.0))
        return found

    def _quotient(self, left: Expression, right: Expression) -> Range | None:
        dividend, divisor = self.range(left), self.range(right)
        if divisor is None or not divisor.without_zero():
            return None
        found = _ends(lambda x, y: x / y, dividend, divisor, "/")
        if found is not None and divisor.low > 0.0 and self._at_most(left, right):
            return Range(min(found.low, 1.0), min(found.high, 1.0))
        return found

    def _at_most(self, left: Expression, right: Expression) -> bool:
        """Whether one difference is at most another: ``a - b`` and ``a - c`` where c is at most b."""
        match left, right:
            case Binary("-", first, less), Binary("-", second, least) if first == second:
                taken, other = self.range(less), self.range(least)
                return (least, less) in self._ordered or bool(taken and other and other.high <= taken.low)
        return False


def _ends(operation: Callable[[float, float], float], left: Range | None, right: Range | None, op: str) -> Range | None:
    """The range of an operation that rises or falls with each operand; None where an end is no number."""
    if left is None or right is None:
        return None
    if op == "*" and (_is_zero_by_infinity(left, right) or _is_zero_by_infinity(right, left)):
        return None
    ends = [operation(x, y) for x in (left.low, left.high) for y in (right.low, right.high)]
    return None if any(map(math.isnan, ends)) else Range(min(ends), max(ends))


def _is_zero_by_infinity(left: Range, right: Range) -> bool:
    return left.low <= 0.0 <= left.high and (math.isinf(right.low) or math.isinf(right.high))


def _absolute(range_: Range) -> Range:
    ends = abs(range_.low), abs(range_.high)
    return Range(0.0 if range_.low <= 0.0 <= range_.high else min(ends), max(ends))


def _square(range_: Range) -> Range:
    ends = _absolute(range_)
    return Range(ends.low * ends.low, ends.high * ends.high)


def _hull(ranges: Sequence[Range | None]) -> Range | None:
    known = [range_ for range_ in ranges if range_ is not None]
    if len(known) < len(ranges):
        return None
    return Range(min(range_.low for range_ in known), max(range_.high for range_ in known))
