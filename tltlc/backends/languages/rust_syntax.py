"""Print the program of a monitor, strings and documentation in Rust."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import ClassVar, Final

from tltlc.program import snippets, states
from tltlc.program.printer import CHOICE, OR, UNIT, Printer, comment_lines
from tltlc.program.tree import FAILING, Assign, Choice, Declare, ProgramExpression, Table, Type

MATH_FUNCTIONS: Final = {"sqrt", "power", "exp", "tanh"}
"""The functions of a program that Rust's ``core`` lacks."""


class RustPrinter(Printer):
    """Prints the program of a monitor (:mod:`tltlc.program`) as Rust code.

    ``atom`` is the index of the atom whose computation is being printed; registers count after the
    atoms. Functions that have no value for some arguments, such as the division, also get this index,
    to name the atom or register in the error.
    """

    TYPES: ClassVar[dict[Type, str]] = {"real": "f64", "int": "i64", "bool": "bool"}
    TEST: ClassVar[int] = OR
    COMPOUND: ClassVar[bool] = True
    TABLES: ClassVar[dict[Table, str]] = {name: name.upper() for name in Printer.TABLES}

    def __init__(self) -> None:
        self.atom = 0

    def declaration(self, statement: Declare) -> str:
        """Return a declaration, with its type if it has no value."""
        head = f"let mut {statement.name}" if statement.changes else f"let {statement.name}"
        if statement.value is None:
            return f"{head}: {self.TYPES[statement.type]};"
        return f"{head} = {self.text(statement.value, CHOICE)};"

    def name(self, name: str) -> str:
        """Return a variable, which may be a field of the monitor."""
        return f"self.{name}" if name in (states.FAILURE, states.FAILED_STEP) else name

    def assignment(self, statement: Assign) -> str:
        """Return the text of an assignment; the number of a step that failed is never 0."""
        match statement:
            case Assign(states.FAILED_STEP, steps):
                return f"{self.name(states.FAILED_STEP)} = NonZeroU64::new({self.text(steps)});"
        return super().assignment(statement)

    def head(self, test: str, *, first: bool) -> str:
        """Return the line that begins a case: ``if`` or ``else if``, with its test."""
        return f"if {test} {{" if first else f"}} else if {test} {{"

    def choice(self, test: str, value: str, otherwise: str) -> str:
        """Return an ``if`` that is an expression."""
        return f"if {test} {{ {value} }} else {{ {otherwise} }}"

    def _text_and_binding(self, node: ProgramExpression) -> tuple[str, int]:
        text, binding = super()._text_and_binding(node)
        # An `if` needs no brackets: the compiler warns about them.
        return text, UNIT if isinstance(node, Choice) else binding

    def entry(self, table: Table, index: str) -> str:
        """Return the code that reads an entry of a table; integers become indices."""
        return super().entry(table, index) + ("" if table == "level_progress" else " as usize")

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """Return the text of a call of a numeric function.

        If the function has no value for its arguments, the ``?`` after the call ends the step.
        """
        if function in FAILING:
            return super().call(f"self.{function}", [str(self.atom), *arguments]) + "?"
        return super().call(f"math::{function}" if function in MATH_FUNCTIONS else function, arguments)


def string_literal(text: str) -> str:
    """Return a string literal that has only ASCII characters."""
    return snippets.string_literal(text, _escape, snippets.is_plain_ascii)


def _escape(character: str) -> str:
    """Return the escape of a character, or of U+FFFD for half a surrogate pair, which Rust does not allow."""
    code = ord(character)
    return "\\u{fffd}" if 0xD800 <= code < 0xE000 else f"\\u{{{code:x}}}"


def markdown_lines(text: str) -> list[str]:
    """Return lines of documentation, escaped so that rustdoc reads nothing in them as code, HTML or links."""
    escaped = re.sub(r"`{3,}|~{3,}|<|\](?=[(\[:])", lambda match: re.sub("(.)", r"\\\1", match[0]), text)
    return comment_lines(escaped)
