"""The text of a program in GDScript."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import ClassVar

from tltlc.backends.godot.numbers import number
from tltlc.program.printer import Printer
from tltlc.program.tree import Assign, Call, Declare, Expression, Negate, Real, Type, Variable

_BETTER = {"min": "<", "max": ">"}
_CHOICE = -1
"""How tightly ``a if b else c`` binds: less than anything else."""


class Gd(Printer):
    """Prints GDScript.

    ``names`` tells what stands for a variable of the program that has another name here, ``functions`` what the
    engine calls functions that it has, and ``swapped`` which take their second argument first; the others are the
    script's own.
    """

    INDENT: ClassVar[str] = "\t"
    COMMENT: ClassVar[str] = "#"
    TYPES: ClassVar[dict[Type, str]] = {"real": "float", "int": "int", "bool": "bool"}
    WORDS: ClassVar[dict[str, str]] = {"and": "and", "or": "or", "not": "not ", "true": "true", "false": "false"}
    END: ClassVar[str] = ""
    _START: ClassVar[dict[Type, str]] = {"real": "0.0", "int": "0", "bool": "false"}

    def __init__(self, names: Mapping[str, str], functions: Mapping[str, str], swapped: Collection[str] = ()) -> None:
        self._names, self._functions, self._swapped = names, functions, swapped

    def declaration(self, statement: Declare) -> str:
        """A variable has a value from the start."""
        value = self._START[statement.type] if statement.value is None else self.text(statement.value, _CHOICE)
        return f"var {self.name(statement.name)}: {self.TYPES[statement.type]} = {value}"

    def assignment(self, statement: Assign) -> str:
        """An assignment."""
        return f"{self.name(statement.name)} = {self.text(statement.value, _CHOICE)}"

    def head(self, test: str, *, first: bool) -> str:
        """Blocks are indented, and no brackets stand around tests."""
        return f"if {test}:" if first else f"elif {test}:"

    def otherwise(self) -> str:
        """The line before what is done where no test holds."""
        return "else:"

    def closing(self) -> list[str]:
        """Nothing ends a branch."""
        return []

    def nothing(self, depth: int) -> list[str]:
        """A body holds something."""
        return [f"{self.INDENT * depth}pass"]

    def name(self, name: str) -> str:
        """What stands for a variable."""
        return self._names.get(name, name)

    def real(self, value: float) -> str:
        """A number that is read exactly."""
        return number(value)

    def _written(self, node: Expression) -> tuple[str, int]:
        """The less or greater of two names or numbers without a call, which would cost more than all the rest."""
        match node:
            case Call("min" | "max" as function, (first, second)) if function not in self._functions:
                if _is_simple(first) and _is_simple(second):
                    one, other = self.text(first), self.text(second)
                    return f"{other} if {other} {_BETTER[function]} {one} else {one}", _CHOICE
        return super()._written(node)

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """A function of the engine, or of the script."""
        ordered = list(reversed(arguments)) if function in self._swapped else arguments
        return super().call(self._functions.get(function, f"_{function}"), ordered)


def _is_simple(node: Expression) -> bool:
    """Whether it may well be written twice."""
    return isinstance(node.operand if isinstance(node, Negate) else node, (Variable, Real))
