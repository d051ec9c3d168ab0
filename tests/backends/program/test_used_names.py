from __future__ import annotations

from tltlc.program.tree import (
    All,
    Assign,
    BinaryNumber,
    CommentLine,
    Compare,
    Declare,
    If,
    Negate,
    Not,
    NumericCall,
    ProgramVariable,
    Real,
    Statement,
)
from tltlc.program.used_names import functions_called, variables_read

x, y, z, zero = ProgramVariable("x"), ProgramVariable("y"), ProgramVariable("z"), Real(0.0)
STATEMENTS: list[Statement] = [
    CommentLine("of `comment`"),
    Declare("a", "real"),
    Declare("b", "real", Negate(NumericCall("sqrt", (BinaryNumber("+", x, zero),)))),
    If(
        ((All((Compare(">", y, zero), Not(Compare("<", NumericCall("abs", (y,)), zero)))), (Assign("a", z),)),),
        (Assign("a", NumericCall("max", (NumericCall("divide", (x, zero)), ProgramVariable("b")))),),
    ),
]


def test_variables_that_tests_and_values_read_are_returned() -> None:
    assert variables_read(STATEMENTS) == {"x", "y", "z", "b"}
    assert variables_read([]) == frozenset()


def test_functions_that_tests_and_values_call_are_returned() -> None:
    assert functions_called(STATEMENTS) == {"sqrt", "abs", "max", "divide"}
