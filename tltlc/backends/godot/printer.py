"""Print the program of a monitor in GDScript."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import ClassVar

from tltlc.backends.godot.numbers import number
from tltlc.program.printer import CHOICE, OR, Printer
from tltlc.program.tree import (
    Assign,
    Declare,
    Negate,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
    Table,
    Type,
)

_BETTER = {"min": "<", "max": ">"}


class Gd(Printer):
    """Prints the program of a monitor (:mod:`tltlc.program`) as GDScript.

    ``names`` maps variables of the program to their names in the script. ``functions`` maps numeric
    functions of the program to functions of Godot; all others are functions of the script itself.
    Functions in ``swapped`` get their arguments in reverse order.
    """

    INDENT: ClassVar[str] = "\t"
    COMMENT: ClassVar[str] = "#"
    TEST: ClassVar[int] = OR
    TYPES: ClassVar[dict[Type, str]] = {"real": "float", "int": "int", "bool": "bool"}
    WORDS: ClassVar[dict[str, str]] = {"and": "and", "or": "or", "not": "not ", "true": "true", "false": "false"}
    END: ClassVar[str] = ""
    TABLES: ClassVar[dict[Table, str]] = {name: f"_{name.upper()}" for name in Printer.TABLES}
    _START: ClassVar[dict[Type, str]] = {"real": "0.0", "int": "0", "bool": "false"}

    def __init__(self, names: Mapping[str, str], functions: Mapping[str, str], swapped: Collection[str] = ()) -> None:
        self._names, self._functions, self._swapped = names, functions, swapped

    def declaration(self, statement: Declare) -> str:
        """Return the text of the declaration of a variable.

        A variable without a value gets 0 or false, because GDScript needs one.
        """
        value = self._START[statement.type] if statement.value is None else self.text(statement.value, CHOICE)
        return f"var {self.name(statement.name)}: {self.TYPES[statement.type]} = {value}"

    def assignment(self, statement: Assign) -> str:
        """Return the text of an assignment in GDScript."""
        return f"{self.name(statement.name)} = {self.text(statement.value, CHOICE)}"

    def head(self, test: str, *, first: bool) -> str:
        """Return the first line of a case: ``if`` or ``elif`` with its test."""
        return f"if {test}:" if first else f"elif {test}:"

    def otherwise(self) -> str:
        """Return the line that begins the ``else``."""
        return "else:"

    def closing(self) -> list[str]:
        """Return no lines, because GDScript ends a branch by its indentation."""
        return []

    def nothing(self, depth: int) -> list[str]:
        """Return the body of a branch without statements: ``pass``, because GDScript allows no empty body."""
        return [f"{self.INDENT * depth}pass"]

    def name(self, name: str) -> str:
        """Return the name that a variable of the program has in the script."""
        return self._names.get(name, name)

    def real(self, value: float) -> str:
        """Return an expression whose value in Godot is exactly this number."""
        return number(value)

    def _text_and_binding(self, node: ProgramExpression) -> tuple[str, int]:
        """Return the text of an expression and its binding strength, which decides where brackets are needed.

        If Godot lacks an exact ``min`` or ``max``, a call with two variables or numbers becomes a
        conditional expression, which is faster than a function of the script.
        """
        match node:
            case NumericCall("min" | "max" as function, (first, second)) if function not in self._functions:
                if _is_simple(first) and _is_simple(second):
                    first_text, second_text = self.text(first), self.text(second)
                    return f"{second_text} if {second_text} {_BETTER[function]} {first_text} else {first_text}", CHOICE
        return super()._text_and_binding(node)

    def choice(self, test: str, value: str, otherwise: str) -> str:
        """Return the text of a conditional expression in GDScript."""
        return f"{value} if {test} else {otherwise}"

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """Return the text of a call of a numeric function of Godot or of the script."""
        ordered = list(reversed(arguments)) if function in self._swapped else arguments
        return super().call(self._functions.get(function, f"_{function}"), ordered)


def _is_simple(node: ProgramExpression) -> bool:
    """Whether an expression is a variable or a number, perhaps negated, and so costs little to compute twice."""
    return isinstance(node.operand if isinstance(node, Negate) else node, (ProgramVariable, Real))
