"""Interval analysis: find divisors that are never 0, and atoms whose values are always in [-1, 1].

The monitor checks that signals and params are finite and in their ranges. The interval of each
expression is computed from these ranges, and from the tests that are true where the expression is
computed. Operations round their results, but rounding keeps their order, so the rounded ends of an
interval are bounds of the rounded results.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import Final, Literal

from tltlc.core.record import record, replace
from tltlc.program.tree import (
    FAILING,
    All,
    Any,
    Assign,
    BinaryNumber,
    Choice,
    Compare,
    Declare,
    If,
    Negate,
    Not,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
)
from tltlc.program.used_names import functions_in, parts

_MOST: Final = sys.float_info.max
_OPPOSITE: Final[Mapping[str, Literal["<", "<=", ">", ">="]]] = {"<": ">=", "<=": ">", ">": "<=", ">=": "<"}


@record
class ValueRange:
    """The interval in which the value of an expression lies. The value is never NaN.

    Both ends belong to the interval and may be infinite.
    """

    low: float
    high: float

    def without_zero(self) -> bool:
        """Whether the interval excludes 0."""
        return self.low > 0.0 or self.high < 0.0


def range_between(low: float | None, high: float | None) -> ValueRange:
    """Return the interval of a finite value from ``low`` to ``high``.

    If an end is None, the least or the greatest finite double takes its place.
    """
    return ValueRange(-_MOST if low is None else low, _MOST if high is None else high)


def prove_ranges(
    name: str, statements: Sequence[Statement], known: Mapping[str, ValueRange], limited: Collection[str] = ()
) -> tuple[tuple[Statement, ...], ValueRange | None]:
    """Replace ``divide`` by ``/`` where the divisor is never 0, and find the range of a variable.

    ``divide`` is a function that also reports a division by 0. Return the new statements, and the
    range of the variable ``name`` after them. The range is None if nothing is known about the
    value, or if it may be NaN. ``known`` maps the variables that exist before the statements to
    their ranges. For the variables in ``limited``, the ``min`` of the variable and a number that it
    never exceeds becomes the variable.
    """
    facts = _Facts({ProgramVariable(variable): range_ for variable, range_ in known.items()}, frozenset(), limited)
    written = facts.statements(statements)
    return written, facts.range(ProgramVariable(name))


class _Facts:
    """What is known at a point of a program: ranges of expressions, and pairs ``(a, b)`` with ``a <= b``.

    ``assigned_variables`` has the variables that are assigned in the current body (the statements
    of a case, or the whole program) but are declared outside this body. The methods also rewrite
    divisions: ``divide``, which reports a division by 0, becomes ``/``.
    """

    def __init__(
        self,
        ranges: dict[ProgramExpression, ValueRange],
        ordered: frozenset[tuple[ProgramExpression, ProgramExpression]],
        limited: Collection[str],
    ) -> None:
        self._ranges, self._at_most_pairs, self._limited = ranges, ordered, limited
        self._cache: dict[ProgramExpression, ValueRange | None] = {}
        self._compared: set[ProgramExpression] = set()
        self.assigned_variables: dict[str, None] = {}

    # --- statements -------------------------------------------------------------------------------

    def statements(self, statements: Iterable[Statement]) -> tuple[Statement, ...]:
        """Return the statements with ``/`` instead of ``divide`` where the divisor is never 0.

        Update the facts to what is known after the statements.
        """
        rewritten: list[Statement] = []
        declared: set[str] = set()
        for statement in statements:
            if isinstance(statement, If):
                rewritten.append(self._branches(statement))
            elif isinstance(statement, (Declare, Assign)):
                value = None if statement.value is None else self.rewrite(statement.value)
                self._assign(statement.name, None if value is None else self.range(value))
                rewritten.append(replace(statement, value=value))
            else:
                rewritten.append(statement)
            if isinstance(statement, Declare):
                declared.add(statement.name)
        for name in declared:
            self.assigned_variables.pop(name, None)
        return tuple(rewritten)

    def _branches(self, statement: If) -> If:
        """Return an ``if`` with ``/`` instead of ``divide`` where the divisor is never 0.

        Update the facts to what is known after the ``if``: the range of a variable then covers its
        ranges at the ends of all cases.
        """
        before = self._copy()
        ends: list[_Facts] = []
        cases = []
        for test, body in statement.cases:
            rewritten = before.rewrite(test)
            inside = before._copy()
            inside._assume(test, True)
            cases.append((rewritten, inside.statements(body)))
            ends.append(inside)
            before._assume(test, False)
        otherwise = before.statements(statement.otherwise)
        ends.append(before)
        for name in {name: None for end in ends for name in end.assigned_variables}:
            self._assign(name, _hull([end._ranges.get(ProgramVariable(name)) for end in ends]))
        return If(tuple(cases), otherwise)

    def _assign(self, name: str, range_: ValueRange | None) -> None:
        """Record that a variable has a new value in ``range_``, and drop the facts about its old value.

        If ``range_`` is None, nothing is known about the new value.
        """
        variable = ProgramVariable(name)
        self._cache.clear()
        self._ranges.pop(variable, None)
        if variable in self._compared:
            for node in [node for node in self._ranges if variable in parts([node])]:
                del self._ranges[node]
            self._at_most_pairs = frozenset(pair for pair in self._at_most_pairs if variable not in parts(pair))
        if range_ is not None:
            self._ranges[variable] = range_
        self.assigned_variables[name] = None

    def _copy(self) -> _Facts:
        copied = _Facts(dict(self._ranges), self._at_most_pairs, self._limited)
        copied._compared = set(self._compared)
        return copied

    # --- tests ------------------------------------------------------------------------------------

    def _assume(self, test: ProgramExpression, holds: bool) -> None:
        """Add the facts that follow from a test that is true (``holds``) or false."""
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
                # Comparisons with NaN are false, so nothing follows from a false test of a value that may be NaN.
                if low is None or high is None:
                    return
                op = op if holds else _OPPOSITE[op]
                if op in (">", ">="):
                    left, right, low, high = right, left, high, low
                # a < b means that a is at most the next double below b.
                least, most = low.low, high.high
                if op in ("<", ">"):
                    least, most = math.nextafter(least, math.inf), math.nextafter(most, -math.inf)
                self._at_most_pairs |= {(left, right)}
                self._compared.update(parts((left, right)))
                self._cache.clear()
                self._narrow(left, ValueRange(low.low, min(low.high, most)))
                self._narrow(right, ValueRange(max(least, high.low), high.high))

    def _narrow(self, node: ProgramExpression, range_: ValueRange) -> None:
        # If the range is empty, the test never has this result, and its body never runs. No facts are needed there.
        if range_.low <= range_.high and not isinstance(node, Real):
            self._ranges[node] = range_

    # --- expressions ------------------------------------------------------------------------------

    def rewrite(self, node: ProgramExpression) -> ProgramExpression:
        """Return the expression with ``/`` instead of ``divide`` where the divisor is never 0."""
        match node:
            case NumericCall("divide", (left, right)):
                left, right = self.rewrite(left), self.rewrite(right)
                divisor = self.range(right)
                if divisor is not None and divisor.without_zero():
                    return BinaryNumber("/", left, right)
                return NumericCall("divide", (left, right))
            case NumericCall("min", (ProgramVariable(name) as variable, Real(greatest))) if name in self._limited:
                known = self.range(variable)
                return variable if known is not None and known.high <= greatest else node
            case NumericCall(function, args):
                return self._chosen(NumericCall(function, tuple(map(self.rewrite, args))))
            case Choice(test, value, otherwise):
                return Choice(self.rewrite(test), self.rewrite(value), self.rewrite(otherwise))
            case BinaryNumber(op, left, right):
                return BinaryNumber(op, self.rewrite(left), self.rewrite(right))
            case Compare(compared, left, right):
                return Compare(compared, self.rewrite(left), self.rewrite(right))
            case Negate(operand):
                return Negate(self.rewrite(operand))
            case Not(operand):
                return Not(self.rewrite(operand))
            case All(args):
                return All(tuple(map(self.rewrite, args)))
            case Any(args):
                return Any(tuple(map(self.rewrite, args)))
        return node

    def _chosen(self, node: NumericCall) -> ProgramExpression:
        """Return the ``min`` or ``max`` of a number in [-1, 1] and a flag, which is -1 or 1, as a choice of one.

        The number is then computed only if the flag does not decide. Return any other call as it is.
        """
        match node:
            case NumericCall("min" | "max", (value, Choice(test, Real(1.0), Real(-1.0)))) | NumericCall(
                "min" | "max", (Choice(test, Real(1.0), Real(-1.0)), value)
            ):
                range_ = self.range(value)
                if range_ is None or range_.low < -1.0 or range_.high > 1.0 or functions_in([value]) & FAILING:
                    return node
                return Choice(test, value, Real(-1.0)) if node.function == "min" else Choice(test, Real(1.0), value)
        return node

    def range(self, node: ProgramExpression) -> ValueRange | None:
        """Return the range of an expression.

        Return None if the expression may be NaN or have no value, or if nothing is known about it.
        """
        if node in self._cache:
            return self._cache[node]
        computed = self._compute(node)
        recorded = self._ranges.get(node)
        if computed is not None and recorded is not None:
            recorded = ValueRange(max(computed.low, recorded.low), min(computed.high, recorded.high))
        self._cache[node] = recorded = recorded or computed
        return recorded

    def _compute(self, node: ProgramExpression) -> ValueRange | None:
        match node:
            case Real(value):
                return ValueRange(value, value)
            case Negate(operand):
                range_ = self.range(operand)
                return range_ and ValueRange(-range_.high, -range_.low)
            case BinaryNumber("-", left, right):
                return self._difference(left, right)
            case BinaryNumber("/", left, right):
                return self._quotient(left, right)
            case BinaryNumber("*", left, right) if left == right:
                range_ = self.range(left)
                return range_ and _square(range_)
            case BinaryNumber(op, left, right):
                return _ends(lambda x, y: x * y if op == "*" else x + y, self.range(left), self.range(right), op)
            case NumericCall("min" | "max" as function, (left, right)):
                first, second = self.range(left), self.range(right)
                if first is None or second is None:
                    return None
                pick = min if function == "min" else max
                return ValueRange(pick(first.low, second.low), pick(first.high, second.high))
            case Choice(_, value, otherwise):
                return _hull([self.range(value), self.range(otherwise)])
            case NumericCall("abs", (operand,)):
                range_ = self.range(operand)
                return range_ and _absolute(range_)
            case NumericCall("tanh", (operand,)):
                # Languages without tanh compute it from other functions, whose rounded result may exceed 1.
                return ValueRange(-2.0, 2.0) if self.range(operand) else None
        return None

    def _difference(self, left: ProgramExpression, right: ProgramExpression) -> ValueRange | None:
        range_ = _ends(lambda x, y: x - y, self.range(left), self.range(right), "-")
        if range_ is not None and (right, left) in self._at_most_pairs:
            return ValueRange(max(range_.low, 0.0), max(range_.high, 0.0))
        return range_

    def _quotient(self, left: ProgramExpression, right: ProgramExpression) -> ValueRange | None:
        dividend, divisor = self.range(left), self.range(right)
        if divisor is None or not divisor.without_zero():
            return None
        range_ = _ends(lambda x, y: x / y, dividend, divisor, "/")
        if range_ is not None and divisor.low > 0.0 and self._at_most(left, right):
            return ValueRange(min(range_.low, 1.0), min(range_.high, 1.0))
        return range_

    def _at_most(self, left: ProgramExpression, right: ProgramExpression) -> bool:
        """Whether it is known that ``left <= right``.

        It is known if ``left`` is ``a - b``, ``right`` is ``a - c``, and ``c <= b`` is known.
        """
        match left, right:
            case BinaryNumber("-", minuend, b), BinaryNumber("-", other_minuend, c) if minuend == other_minuend:
                b_range, c_range = self.range(b), self.range(c)
                return (c, b) in self._at_most_pairs or bool(b_range and c_range and c_range.high <= b_range.low)
        return False


def _ends(
    operation: Callable[[float, float], float], left: ValueRange | None, right: ValueRange | None, op: str
) -> ValueRange | None:
    """Return the range of an operation that is monotonic in each operand.

    ``left`` and ``right`` are the ranges of the operands, and ``op`` is the operator, such as
    ``*``. Return None if the result may be NaN, or if a range is None.
    """
    if left is None or right is None:
        return None
    if op == "*" and (_is_zero_by_infinity(left, right) or _is_zero_by_infinity(right, left)):
        return None
    ends = [operation(x, y) for x in (left.low, left.high) for y in (right.low, right.high)]
    return None if any(map(math.isnan, ends)) else ValueRange(min(ends), max(ends))


def _is_zero_by_infinity(left: ValueRange, right: ValueRange) -> bool:
    return left.low <= 0.0 <= left.high and (math.isinf(right.low) or math.isinf(right.high))


def _absolute(range_: ValueRange) -> ValueRange:
    ends = abs(range_.low), abs(range_.high)
    return ValueRange(0.0 if range_.low <= 0.0 <= range_.high else min(ends), max(ends))


def _square(range_: ValueRange) -> ValueRange:
    ends = _absolute(range_)
    return ValueRange(ends.low * ends.low, ends.high * ends.high)


def _hull(ranges: Sequence[ValueRange | None]) -> ValueRange | None:
    known_ranges = [range_ for range_ in ranges if range_ is not None]
    if len(known_ranges) < len(ranges):
        return None
    return ValueRange(min(range_.low for range_ in known_ranges), max(range_.high for range_ in known_ranges))
