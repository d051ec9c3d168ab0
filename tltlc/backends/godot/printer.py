"""The text of a program in GDScript."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar

from tltlc.backends.godot.numbers import number
from tltlc.backends.program.printer import Printer, remark
from tltlc.backends.program.tree import Declare, Type

FAILING = {"divide", "sqrt", "power", "exp"}
"""Functions that may have no value."""


class Gd(Printer):
    """Prints GDScript.

    ``names`` tells what stands for a variable of the program that has another name here, ``functions`` what the
    engine calls functions that it has; the others are the script's own.
    """

    INDENT: ClassVar[str] = "\t"
    TYPES: ClassVar[dict[Type, str]] = {"real": "float", "int": "int", "bool": "bool"}
    WORDS: ClassVar[dict[str, str]] = {"and": "and", "or": "or", "not": "not ", "true": "true", "false": "false"}
    END: ClassVar[str] = ""
    _START: ClassVar[dict[Type, str]] = {"real": "0.0", "int": "0", "bool": "false"}

    def __init__(self, names: Mapping[str, str], functions: Mapping[str, str]) -> None:
        self._names, self._functions = names, functions

    def declaration(self, statement: Declare) -> str:
        """A variable has a value from the start."""
        value = self._START[statement.type] if statement.value is None else self.text(statement.value)
        return f"var {self.name(statement.name)}: {self.TYPES[statement.type]} = {value}"

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

    def comment(self, text: str) -> list[str]:
        """A remark."""
        return [f"# {line}" for line in remark(text)]

    def name(self, name: str) -> str:
        """What stands for a variable."""
        return self._names.get(name, name)

    def real(self, value: float) -> str:
        """A number that is read exactly."""
        return number(value)

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """A function of the engine, or of the script."""
        return super().call(self._functions.get(function, f"_{function}"), arguments)
