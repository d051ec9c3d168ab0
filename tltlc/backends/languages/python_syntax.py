"""Print the program of a monitor, tuples and dicts in Python."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import ClassVar

from tltlc.program import reward_step, states
from tltlc.program.names import string_literal
from tltlc.program.printer import CHOICE, OR, Printer
from tltlc.program.tree import (
    Assign,
    BinaryNumber,
    Declare,
    Int,
    NumericCall,
    ProgramExpression,
    Statement,
    Table,
    Type,
)


class PythonPrinter(Printer):
    """Prints the program of a monitor (:mod:`tltlc.program`) as Python code.

    ``atoms`` are the names of the atoms in the spec.
    """

    COMMENT: ClassVar[str] = "#"
    TEST: ClassVar[int] = OR
    TYPES: ClassVar[dict[Type, str]] = {"real": "float", "int": "int", "bool": "bool"}
    WORDS: ClassVar[dict[str, str]] = {"and": "and", "or": "or", "not": "not ", "true": "True", "false": "False"}
    END: ClassVar[str] = ""
    TABLES: ClassVar[dict[Table, str]] = {name: f"_{name.upper()}" for name in Printer.TABLES}

    def __init__(self, atoms: Sequence[str]) -> None:
        self._atoms = atoms

    def lines(self, statements: Iterable[Statement], depth: int = 0) -> list[str]:
        """Return the lines of statements; declarations without a value are left out, since Python needs none."""
        needed = (
            statement for statement in statements if not (isinstance(statement, Declare) and statement.value is None)
        )
        return super().lines(needed, depth)

    def declaration(self, statement: Declare) -> str:
        """Return a declaration with a value, which is an assignment in Python."""
        assert statement.value is not None, "variables without a value are left out"
        return f"{statement.name} = {self.text(statement.value, CHOICE)}"

    def name(self, name: str) -> str:
        """Return the name of a variable in Python.

        For ``steps_real``, the number of steps as a real number, this is the int ``steps``, which
        Python converts where a real number is needed.
        """
        return reward_step.STEPS if name == reward_step.STEPS_REAL else name

    def assignment(self, statement: Assign) -> str:
        """Return the text of an assignment; ``limiting`` gets the name of an atom or None instead of an index."""
        return f"{statement.name} = {self.result(statement)}"

    def result(self, statement: Assign) -> str:
        """Return the text of the value that a statement assigns."""
        match statement:
            case Assign(states.LIMITING, Int(index)):
                return string_literal(self._atoms[index]) if index >= 0 else "None"
        return self.text(statement.value, CHOICE)

    def head(self, test: str, *, first: bool) -> str:
        """Return the line that begins a case: ``if`` or ``elif``, with its test."""
        return f"if {test}:" if first else f"elif {test}:"

    def otherwise(self) -> str:
        """Return the line that begins the ``else``."""
        return "else:"

    def closing(self) -> list[str]:
        """Return no lines, because Python ends a branch by its indentation."""
        return []

    def _text_and_binding(self, node: ProgramExpression) -> tuple[str, int]:
        """Return the text of an expression and its binding strength, which decides where brackets are needed.

        ``min(min(a, b), c)`` becomes ``min(a, b, c)``, which is faster; so do nested calls of ``max``.
        The result is the same: of equal arguments, the first.
        """
        match node:
            case NumericCall("min" | "max" as function):
                return super()._text_and_binding(NumericCall(function, tuple(_arguments(node))))
            case NumericCall("divide", (left, right)):
                return super()._text_and_binding(BinaryNumber("/", left, right))
        return super()._text_and_binding(node)

    def choice(self, test: str, value: str, otherwise: str) -> str:
        """Return the text of a conditional expression in Python."""
        return f"{value} if {test} else {otherwise}"

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """Return the text of a call of a numeric function in Python."""
        return super().call("pow" if function == "power" else function, arguments)


def _arguments(node: NumericCall) -> list[ProgramExpression]:
    """Return the arguments of nested calls of one function: ``a, b, c`` for ``f(f(a, b), c)``."""
    first, second = node.args
    before = _arguments(first) if isinstance(first, NumericCall) and first.function == node.function else [first]
    return [*before, second]


def tuple_items(items: Sequence[str]) -> Sequence[str]:
    """Return the items of a tuple; a single one ends with a comma."""
    return (f"{items[0]},",) if len(items) == 1 else items


def short_tuple(items: Sequence[str]) -> str:
    """Return the text of a tuple on one line."""
    return f"({', '.join(tuple_items(items))})"


def long_tuple(items: Sequence[str]) -> str:
    """Return the text of a tuple, with a line for each item; ``()`` if there are no items."""
    return "\n".join(["(", *(f"{Printer.INDENT}{item}," for item in items), ")"]) if items else "()"


def long_dict(items: Sequence[str]) -> str:
    """Return the text of a dict, with a line for each item; ``{}`` if there are no items."""
    return "\n".join(["{", *(f"{Printer.INDENT}{item}," for item in items), "}"]) if items else "{}"
