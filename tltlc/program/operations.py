"""The operations of predicates as expressions of a program."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce

from tltlc.expression import tree as source
from tltlc.program.tree import (
    All,
    Any,
    BinaryNumber,
    Choice,
    Compare,
    Negate,
    Not,
    NumericCall,
    ProgramExpression,
    Real,
)


def operation(node: source.Op, args: Sequence[ProgramExpression]) -> ProgramExpression:
    """Return the operation of a node with ``args``, its translated operands; powers are calls."""
    match node.op:
        case "+" | "-" | "*":
            op = node.op
            return reduce(lambda left, right: BinaryNumber(op, left, right), args)
        case "/":
            return reduce(_divide, args)
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


def _divide(left: ProgramExpression, right: ProgramExpression) -> ProgramExpression:
    """Return a quotient: ``/`` if the divisor is a literal other than 0, else a call of ``divide``.

    ``divide`` reports a division by 0 when the program runs.
    """
    if isinstance(right, Real) and right.value != 0.0:
        return BinaryNumber("/", left, right)
    return NumericCall("divide", (left, right))


def all_or_any(op: str, tests: Sequence[ProgramExpression]) -> ProgramExpression:
    """Return the conjunction of tests if ``op`` is ``and``, else their disjunction; one test stays as it is."""
    if len(tests) == 1:
        return tests[0]
    return All(tuple(tests)) if op == "and" else Any(tuple(tests))


def nesting_depth(node: ProgramExpression) -> int:
    """Return how deep operations are nested in an expression; 0 for a variable or a number."""
    match node:
        case BinaryNumber(_, left, right) | Compare(_, left, right):
            return 1 + max(nesting_depth(left), nesting_depth(right))
        case NumericCall(_, args) | All(args) | Any(args):
            return 1 + max(map(nesting_depth, args))
        case Choice(test, value, otherwise):
            return 1 + max(map(nesting_depth, (test, value, otherwise)))
        case Negate(operand) | Not(operand):
            return 1 + nesting_depth(operand)
    return 0
