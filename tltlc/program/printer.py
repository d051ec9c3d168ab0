"""Print a program in C-like syntax; each language overrides what differs."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from textwrap import wrap
from typing import ClassVar

from tltlc.program.names import printable_line
from tltlc.program.tree import (
    All,
    Any,
    Assign,
    BinaryNumber,
    Bool,
    CommentLine,
    Compare,
    Declare,
    Expression,
    If,
    Int,
    Negate,
    Not,
    NumericCall,
    Real,
    Statement,
    Type,
    Variable,
)

_OR, _AND, _COMPARISON, _SUM, _PRODUCT, _SIGN, _UNIT = range(7)
"""Binding strengths of operators, loosest first."""

_BINDING = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT}
_LONGEST_COMMENT = 100
_LONGEST_LIST = 60
_LONGEST_ROW = 97
_SHORT = 12
"""Items shorter than this share a line."""


class Printer:
    """Prints statements and expressions as C would write them.

    Each language has a subclass that overrides what differs.
    """

    INDENT: ClassVar[str] = "    "
    COMMENT: ClassVar[str] = "//"
    """The start of a comment line."""
    TYPES: ClassVar[dict[Type, str]] = {"real": "double", "int": "int", "bool": "bool"}
    WORDS: ClassVar[dict[str, str]] = {"and": "&&", "or": "||", "not": "!", "true": "true", "false": "false"}
    END: ClassVar[str] = ";"
    """The end of a statement."""

    # --- statements -------------------------------------------------------------------------------

    def lines(self, statements: Iterable[Statement], depth: int = 0) -> list[str]:
        """Return the lines of statements, indented by ``depth`` levels."""
        lines: list[str] = []
        for statement in statements:
            if isinstance(statement, If):
                lines += self.branches(statement, depth)
                continue
            indent = self.INDENT * depth
            if isinstance(statement, CommentLine):
                lines += [f"{indent}{line}" for line in self.comment(statement.text)]
            elif isinstance(statement, Declare):
                lines.append(f"{indent}{self.declaration(statement)}")
            else:
                lines.append(f"{indent}{self.assignment(statement)}")
        return lines

    def declaration(self, statement: Declare) -> str:
        """Return a declaration, with or without a value."""
        value = "" if statement.value is None else f" = {self.text(statement.value)}"
        return f"{self.TYPES[statement.type]} {statement.name}{value}{self.END}"

    def assignment(self, statement: Assign) -> str:
        """Return an assignment."""
        return f"{self.name(statement.name)} = {self.text(statement.value)}{self.END}"

    def branches(self, statement: If, depth: int) -> list[str]:
        """Return the lines of a branch: its cases and its ``else``."""
        indent = self.INDENT * depth
        lines: list[str] = []
        for index, (test, body) in enumerate(statement.cases):
            lines.append(f"{indent}{self.head(self.text(test), first=not index)}")
            lines += self.lines(body, depth + 1) or self.nothing(depth + 1)
        if statement.otherwise:
            lines.append(f"{indent}{self.otherwise()}")
            lines += self.lines(statement.otherwise, depth + 1)
        return [*lines, *(f"{indent}{line}" for line in self.closing())]

    def head(self, test: str, *, first: bool) -> str:
        """Return the first line of a case."""
        return f"if ({test}) {{" if first else f"}} else if ({test}) {{"

    def otherwise(self) -> str:
        """Return the line that begins the ``else``."""
        return "} else {"

    def closing(self) -> list[str]:
        """Return the lines that end a branch."""
        return ["}"]

    def nothing(self, depth: int) -> list[str]:
        """Return the lines of an empty body."""
        return []

    def comment(self, text: str) -> list[str]:
        """Return a comment, on as many lines as it needs."""
        return [f"{self.COMMENT} {line}" for line in comment_lines(text)]

    # --- pieces of files --------------------------------------------------------------------------

    @classmethod
    def block(cls, lines: Iterable[str], depth: int = 1) -> str:
        """Return the lines as a text, indented by ``depth`` levels."""
        return "\n".join(f"{cls.INDENT * depth}{line}" if line else "" for line in lines)

    @classmethod
    def items(cls, items: Sequence[str], depth: int = 0) -> str:
        """Return the items of a list as the text between its brackets.

        The items are on one line if this is short, else on lines one level deeper than ``depth``.
        """
        line = ", ".join(items)
        if len(line) <= _LONGEST_LIST:
            return line
        rows: list[str] = []
        short = max(map(len, items)) < _SHORT
        for item in items:
            if rows and short and len(rows[-1]) + len(item) < _LONGEST_ROW:
                rows[-1] += f" {item},"
            else:
                rows.append(f"{item},")
        return f"\n{cls.block(rows, depth + 1)}\n{cls.INDENT * depth}"

    # --- expressions ------------------------------------------------------------------------------

    def text(self, node: Expression, room: int = _OR) -> str:
        """Return an expression, in parentheses if it binds more loosely than ``room``."""
        text, binding = self._text_and_binding(node)
        return text if binding >= room else f"({text})"

    def name(self, name: str) -> str:
        """Return a variable as it is read or assigned."""
        return name

    def real(self, value: float) -> str:
        """Return a literal of a number that is not negative."""
        return repr(value)

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """Return a call of a numeric function."""
        return f"{function}({', '.join(arguments)})"

    def _text_and_binding(self, node: Expression) -> tuple[str, int]:
        """Return the text of an expression and its binding strength."""
        match node:
            case Real(value):
                # The text shows the sign of -0.0, which a comparison with 0 would miss.
                return (f"-{self.real(-value)}", _SIGN) if repr(value)[0] == "-" else (self.real(value), _UNIT)
            case Int(value):
                return str(value), _SIGN if value < 0 else _UNIT
            case Bool(value):
                return self.WORDS["true" if value else "false"], _UNIT
            case Variable(name):
                return self.name(name), _UNIT
            case Negate(operand):
                return f"-{self.text(operand, _UNIT)}", _SIGN
            case BinaryNumber(op, left, right):
                binding = _BINDING[op]
                return f"{self.text(left, binding)} {op} {self.text(right, binding + 1)}", binding
            case NumericCall(function, args):
                return self.call(function, [self.text(argument) for argument in args]), _UNIT
            case Compare(op, left, right):
                return f"{self.text(left, _SUM)} {op} {self.text(right, _SUM)}", _COMPARISON
            case Not(operand):
                return f"{self.WORDS['not']}{self.text(operand, _UNIT)}", _SIGN
            case All(args) | Any(args):
                binding = _AND if isinstance(node, All) else _OR
                word = self.WORDS["and" if isinstance(node, All) else "or"]
                # Compilers warn about `a && b || c` without parentheses.
                return f" {word} ".join(self.text(argument, _COMPARISON) for argument in args), binding
        raise TypeError(f"no expression: {node!r}")


def comment_lines(text: str) -> list[str]:
    """Return a text as comment lines of visible characters.

    No line ends in a backslash, which would join it to the next line.
    """
    lines = wrap(printable_line(text), _LONGEST_COMMENT, break_long_words=False, break_on_hyphens=False)
    return [re.sub(r"\\$", r"\\ .", line) for line in lines]
