from __future__ import annotations

import random
from collections.abc import Iterable
from functools import reduce
from itertools import accumulate

from tests.backends.program.interpreter import Scope
from tltlc.program.nesting_limit import split_deep_values
from tltlc.program.printer import Printer
from tltlc.program.tree import (
    Assign,
    Bool,
    Declare,
    If,
    Negate,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
)


def greatest(terms: Iterable[ProgramExpression]) -> ProgramExpression:
    return reduce(lambda left, right: NumericCall("max", (left, right)), terms)


def depth(line: str) -> int:
    """Return the nesting depth of the brackets."""
    return max(accumulate((character == "(") - (character == ")") for character in line))


def test_values_stay_the_same() -> None:
    draw = random.Random(7)
    numbers = [Real(draw.uniform(-1.0, 1.0)) for _ in range(200)]
    deep = NumericCall("min", (Negate(greatest(numbers[:150])), NumericCall("min", (Real(0.5), greatest(numbers)))))
    statements = [If(((Bool(True), (Declare("x", "real", deep), Assign("y", Negate(ProgramVariable("x"))))),))]
    cut = split_deep_values(statements)
    actual, expected = Scope({}), Scope({})
    actual.run([Declare("y", "real", None, changes=True), *cut])
    expected.run([Declare("y", "real", None, changes=True), *statements])
    assert actual.values["y"] == expected.values["y"]
    assert max(map(depth, Printer().lines(cut))) <= 32


def test_shallow_statements_are_unchanged() -> None:
    statements: list[Statement] = [Assign("x", NumericCall("min", (Real(1.0), Negate(Real(2.0)))))]
    assert split_deep_values(statements) == tuple(statements)


def test_new_names_avoid_existing_ones() -> None:
    statements = [Assign("x", greatest(ProgramVariable(f"part{number}") for number in range(70)))]
    cut = split_deep_values(statements, [f"part{number}" for number in range(70)])
    assert [line.name for line in cut if isinstance(line, Declare)] == ["part_1", "part_2"]
