"""Turn the expressions of predicates into statements of a program.

A ``when`` inside an expression becomes a branch before it that assigns a variable. A variable also
holds a subexpression that nests too deep for the parsers of some languages, and the base of a power
that is written as a product.

Evaluation is as lazy as in Python: operands of ``and`` and ``or`` that need statements of their own
go into separate branches.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from typing import Final, Union

from tltlc.expression import tree as source
from tltlc.expression.evaluate import MULTIPLIED_EXPONENTS
from tltlc.program.tree import (
    All,
    Any,
    Assign,
    BinaryNumber,
    Compare,
    Declare,
    Expression,
    If,
    Negate,
    Not,
    NumericCall,
    Real,
    Statement,
    Type,
    Variable,
)

_DEEPEST: Final = 30
"""The depth at which expressions are split. C# and GDScript compilers take some hundreds of levels, Lua takes 200."""

_Node = Union[source.Expression, source.Condition]


def defined(name: str, statements: Sequence[Statement], *, changes: bool = True) -> tuple[Statement, ...]:
    """Return the statements of :meth:`ExpressionTranslator.assigned` with a declaration of the variable.

    The declaration includes the value where a single assignment gives it. Pass ``changes=True`` if
    the variable is assigned again later, as when the value of an atom is clamped to its range.
    """
    *before, last = statements
    if isinstance(last, Assign) and last.name == name:
        return (*before, Declare(name, "real", last.value, changes))
    return (Declare(name, "real", None, changes), *statements)


class ExpressionTranslator:
    """Translates expressions; ``signals`` and ``params`` map names to the names of variables.

    New variables are called ``PREFIX1``, ``PREFIX2`` and so on. The count continues over all calls
    on one object.
    """

    def __init__(self, signals: Mapping[str, str], params: Mapping[str, str], prefix: str) -> None:
        self._signals, self._params, self._prefix = signals, params, prefix
        self._count = 0

    def assigned(self, name: str, expression: source.Expression) -> list[Statement]:
        """Return statements that assign the value of an expression to a declared variable."""
        lines: list[Statement] = []
        if isinstance(expression, source.When):
            return self._cases(name, expression)
        value = self._value(expression, lines)
        return [*lines, Assign(name, value)]

    def _cases(self, name: str, node: source.When) -> list[Statement]:
        """Return a ``when`` as branches; nested only where a condition needs statements of its own."""
        condition, value = node.cases[0]
        before: list[Statement] = []
        cases = [(self._test(condition, before), tuple(self.assigned(name, value)))]
        for index, (condition_after, its_value) in enumerate(node.cases[1:], start=1):
            needed: list[Statement] = []
            test = self._test(condition_after, needed)
            if needed:
                rest = source.When(node.cases[index:], node.otherwise)
                return [*before, If(tuple(cases), tuple(self._cases(name, rest)))]
            cases.append((test, tuple(self.assigned(name, its_value))))
        return [*before, If(tuple(cases), tuple(self.assigned(name, node.otherwise)))]

    # --- numbers ----------------------------------------------------------------------------------

    def _value(self, node: source.Expression, lines: list[Statement]) -> Expression:
        """Return the value of an expression; statements that must run first are appended to ``lines``."""
        if isinstance(node, source.Const):
            return Real(float(node.value))
        if isinstance(node, source.SignalValue):
            return Variable(self._signals[node.name])
        if isinstance(node, source.ParamValue):
            return Variable(self._params[node.name])
        if isinstance(node, source.When):
            name = self._declared("real", lines)
            lines += self._cases(name, node)
            return Variable(name)
        if node.op == "^" and isinstance(exponent := node.args[1], source.Const):
            factors = MULTIPLIED_EXPONENTS.get(exponent.value)
            if factors:
                base = self._named(self._argument(node.args[0], lines), lines)
                return reduce(lambda left, right: BinaryNumber("*", left, right), [base] * factors)
        return self._operation(node, [self._argument(argument, lines) for argument in node.args])

    def _argument(self, node: source.Expression, lines: list[Statement]) -> Expression:
        value = self._value(node, lines)
        return self._named(value, lines) if self._depth(value) >= _DEEPEST else value

    def _operation(self, node: source.Op, args: list[Expression]) -> Expression:
        match node.op:
            case "+" | "-" | "*":
                op = node.op
                return reduce(lambda left, right: BinaryNumber(op, left, right), args)
            case "/":
                return reduce(_divided, args)
            case "neg":
                return Negate(args[0])
            case "^":
                return NumericCall("power", tuple(args))
            case "clamp":
                return NumericCall("min", (NumericCall("max", (args[0], args[1])), args[2]))
            case "min" | "max":
                function = node.op
                return reduce(lambda left, right: NumericCall(function, (left, right)), args)
        return NumericCall(node.op, tuple(args))

    # --- tests ------------------------------------------------------------------------------------

    def _test(self, node: _Node, lines: list[Statement]) -> Expression:
        """Return a test; statements that must run first are appended to ``lines``."""
        assert isinstance(node, source.Condition), "and, or, not and cases take conditions"
        if node.op == "not":
            return Not(self._part(node.args[0], lines))
        if node.op == "and" or node.op == "or":
            return self._joined(node, lines)
        left, right = node.args
        assert not isinstance(left, source.Condition) and not isinstance(right, source.Condition)
        op = node.op
        return Compare(op, self._argument(left, lines), self._argument(right, lines))

    def _part(self, node: _Node, lines: list[Statement]) -> Expression:
        test = self._test(node, lines)
        if self._depth(test) < _DEEPEST:
            return test
        name = self._declared("bool", lines)
        lines.append(Assign(name, test))
        return Variable(name)

    def _joined(self, node: source.Condition, lines: list[Statement]) -> Expression:
        """Return ``and`` or ``or`` of several tests.

        If an operand needs statements first, they run only where the operands before it are
        undecided.
        """
        tests: list[Expression] = []
        for part in node.args:
            needed: list[Statement] = []
            test = self._part(part, needed)
            if not tests:
                lines += needed
            elif needed:
                name = self._declared("bool", lines, changes=True)
                lines.append(Assign(name, _all_or_any(node.op, tests)))
                undecided = Variable(name) if node.op == "and" else Not(Variable(name))
                lines.append(If(((undecided, (*needed, Assign(name, test))),)))
                tests, test = [], Variable(name)
            tests.append(test)
        return _all_or_any(node.op, tests)

    # --- variables --------------------------------------------------------------------------------

    def _named(self, value: Expression, lines: list[Statement]) -> Expression:
        """Return the value as a variable or number, which can be repeated without computing it again."""
        if isinstance(value, (Variable, Real)):
            return value
        self._count += 1
        name = f"{self._prefix}{self._count}"
        lines.append(Declare(name, "real", value))
        return Variable(name)

    def _declared(self, type_: Type, lines: list[Statement], changes: bool = False) -> str:
        self._count += 1
        name = f"{self._prefix}{self._count}"
        lines.append(Declare(name, type_, None, changes))
        return name

    def _depth(self, node: Expression) -> int:
        match node:
            case BinaryNumber(_, left, right) | Compare(_, left, right):
                return 1 + max(self._depth(left), self._depth(right))
            case NumericCall(_, args) | All(args) | Any(args):
                return 1 + max(map(self._depth, args))
            case Negate(operand) | Not(operand):
                return 1 + self._depth(operand)
        return 0


def _all_or_any(op: str, tests: list[Expression]) -> Expression:
    if len(tests) == 1:
        return tests[0]
    return All(tuple(tests)) if op == "and" else Any(tuple(tests))


def _divided(left: Expression, right: Expression) -> Expression:
    """Return a quotient; a plain ``/`` where the divisor is a number other than 0, else ``divide``, which may fail."""
    if isinstance(right, Real) and right.value != 0.0:
        return BinaryNumber("/", left, right)
    return NumericCall("divide", (left, right))
