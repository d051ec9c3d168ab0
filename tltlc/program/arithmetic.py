"""The expressions of predicates as statements of a program.

A ``when`` inside an expression becomes a branch before it, that assigns a variable; so does what nests too deep for a
language's own parser, and the base of a power that is a product.  What Python would not compute is not computed: parts
of ``and`` and ``or`` that need statements stand in branches of their own.
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
    Type,
    Variable,
)

_DEEPEST: Final = 30
"""How deep expressions nest; C# and GDScript compilers take some hundreds of levels, Lua 200."""

_Node = Union[source.Expression, source.Condition]


def defined(name: str, statements: Sequence[Statement], *, changes: bool = True) -> tuple[Statement, ...]:
    """What :meth:`Arithmetic.assigned` gives, and the declaration of the variable: with its value where it can be.

    The variable ``changes`` where the value of an atom is brought into its range afterwards.
    """
    *before, last = statements
    if isinstance(last, Assign) and last.name == name:
        return (*before, Declare(name, "real", last.value, changes))
    return (Declare(name, "real", None, changes), *statements)


class Arithmetic:
    """Writes expressions over variables; ``signals`` and ``params`` map names to those of variables.

    New variables are called ``PREFIX1``, ``PREFIX2`` and so on, counted over all that one object writes.
    """

    def __init__(self, signals: Mapping[str, str], params: Mapping[str, str], prefix: str) -> None:
        self._signals, self._params, self._prefix = signals, params, prefix
        self._count = 0

    def assigned(self, name: str, expression: source.Expression) -> list[Statement]:
        """Statements that give a variable, which is declared, the value of an expression."""
        lines: list[Statement] = []
        if isinstance(expression, source.When):
            return self._cases(name, expression)
        value = self._value(expression, lines)
        return [*lines, Assign(name, value)]

    def _cases(self, name: str, node: source.When) -> list[Statement]:
        """A ``when`` as branches: flat where conditions need no statements of their own."""
        condition, value = node.cases[0]
        before: list[Statement] = []
        cases = [(self._test(condition, before), tuple(self.assigned(name, value)))]
        for place, (following, its_value) in enumerate(node.cases[1:], start=1):
            needed: list[Statement] = []
            test = self._test(following, needed)
            if needed:
                rest = source.When(node.cases[place:], node.otherwise)
                return [*before, If(tuple(cases), tuple(self._cases(name, rest)))]
            cases.append((test, tuple(self.assigned(name, its_value))))
        return [*before, If(tuple(cases), tuple(self.assigned(name, node.otherwise)))]

    # --- numbers ----------------------------------------------------------------------------------

    def _value(self, node: source.Expression, lines: list[Statement]) -> Expression:
        """The value of an expression, after the statements that are added to ``lines``."""
        if isinstance(node, source.Const):
            return Real(float(node.value))
        if isinstance(node, source.Signal):
            return Variable(self._signals[node.name])
        if isinstance(node, source.Param):
            return Variable(self._params[node.name])
        if isinstance(node, source.When):
            name = self._declared("real", lines)
            lines += self._cases(name, node)
            return Variable(name)
        if node.op == "^" and isinstance(exponent := node.args[1], source.Const):
            factors = MULTIPLIED_EXPONENTS.get(exponent.value)
            if factors:
                base = self._named(self._argument(node.args[0], lines), lines)
                return reduce(lambda left, right: Binary("*", left, right), [base] * factors)
        return self._operation(node, [self._argument(argument, lines) for argument in node.args])

    def _argument(self, node: source.Expression, lines: list[Statement]) -> Expression:
        value = self._value(node, lines)
        return self._named(value, lines) if self._depth(value) >= _DEEPEST else value

    def _operation(self, node: source.Op, args: list[Expression]) -> Expression:
        match node.op:
            case "+" | "-" | "*":
                op = node.op
                return reduce(lambda left, right: Binary(op, left, right), args)
            case "/":
                return reduce(_divided, args)
            case "neg":
                return Negate(args[0])
            case "^":
                return Call("power", tuple(args))
            case "clamp":
                return Call("min", (Call("max", (args[0], args[1])), args[2]))
            case "min" | "max":
                function = node.op
                return reduce(lambda left, right: Call(function, (left, right)), args)
        return Call(node.op, tuple(args))

    # --- tests ------------------------------------------------------------------------------------

    def _test(self, node: _Node, lines: list[Statement]) -> Expression:
        """A test, after the statements that are added to ``lines``."""
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
        """``and`` or ``or``; what a part needs first stands where the parts before it have decided nothing yet."""
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
        """The value as a variable or number that can be written several times."""
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
            case Binary(_, left, right) | Compare(_, left, right):
                return 1 + max(self._depth(left), self._depth(right))
            case Call(_, args) | All(args) | Any(args):
                return 1 + max(map(self._depth, args))
            case Negate(operand) | Not(operand):
                return 1 + self._depth(operand)
        return 0


def _all_or_any(op: str, tests: list[Expression]) -> Expression:
    if len(tests) == 1:
        return tests[0]
    return All(tuple(tests)) if op == "and" else Any(tuple(tests))


def _divided(left: Expression, right: Expression) -> Expression:
    """A quotient, which is sure to have a value where the divisor is a number other than 0."""
    if isinstance(right, Real) and right.value != 0.0:
        return Binary("/", left, right)
    return Call("divide", (left, right))
