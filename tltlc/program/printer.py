"""Print a program in the syntax of C.

For each other language, a subclass of :class:`Printer` overrides the methods whose output differs.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from textwrap import wrap
from typing import ClassVar, get_args

from tltlc.program.names import printable_line
from tltlc.program.tree import (
    All,
    Any,
    Assign,
    BinaryNumber,
    Bool,
    Choice,
    CommentLine,
    Compare,
    ComparisonOp,
    Declare,
    If,
    Int,
    Negate,
    Not,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
    Table,
    TableEntry,
    Type,
)

CHOICE, OR, _AND, COMPARISON, _SUM, _PRODUCT, _SIGN, UNIT = range(-1, 7)
"""Binding strengths of operators: a higher number binds more tightly."""

_BINDING = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT}
_LONGEST_COMMENT = 100
_LONGEST_LIST = 60
_LONGEST_ROW = 97
_SHORT = 12
"""If all items of a list are shorter than this, several of them share a line."""


class Printer:
    """Prints statements and expressions as C code.

    For each other language, a subclass overrides the methods whose output differs.
    """

    INDENT: ClassVar[str] = "    "
    COMMENT: ClassVar[str] = "//"
    """The start of a comment line."""
    TYPES: ClassVar[dict[Type, str]] = {"real": "double", "int": "int", "bool": "bool"}
    WORDS: ClassVar[dict[str, str]] = {"and": "&&", "or": "||", "not": "!", "true": "true", "false": "false"}
    COMPARISONS: ClassVar[dict[ComparisonOp, str]] = {
        "<": "<",
        "<=": "<=",
        ">": ">",
        ">=": ">=",
        "==": "==",
        "!=": "!=",
    }
    TEST: ClassVar[int] = COMPARISON
    """How tightly the test of a choice must bind to need no brackets."""
    END: ClassVar[str] = ";"
    """The end of a statement."""
    COMPOUND: ClassVar[bool] = False
    """Whether ``+=`` and ``-=`` add to a variable and subtract from it."""
    TABLES: ClassVar[dict[Table, str]] = {name: name for name in get_args(Table)}
    """The name of each table."""

    # --- statements -------------------------------------------------------------------------------

    def lines(self, statements: Iterable[Statement], depth: int = 0) -> list[str]:
        """Return the lines of code for statements, indented by ``depth`` levels."""
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
        """Return the code that declares a variable, with its first value if the statement has one."""
        value = "" if statement.value is None else f" = {self.text(statement.value, CHOICE)}"
        return f"{self.TYPES[statement.type]} {statement.name}{value}{self.END}"

    def assignment(self, statement: Assign) -> str:
        """Return the code that assigns a value to a variable."""
        match statement:
            case Assign(name, BinaryNumber("+" | "-" as op, ProgramVariable(left), right)) if left == name:
                if self.COMPOUND:
                    return f"{self.name(name)} {op}= {self.text(right)}{self.END}"
        return f"{self.name(statement.name)} = {self.text(statement.value, CHOICE)}{self.END}"

    def branches(self, statement: If, depth: int) -> list[str]:
        """Return the lines of code for an ``if`` with all its cases and its ``else``."""
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
        """Return the line that begins a case: ``if`` or ``else if``, with its test."""
        return f"if ({test}) {{" if first else f"}} else if ({test}) {{"

    def otherwise(self) -> str:
        """Return the line that begins the ``else``."""
        return "} else {"

    def closing(self) -> list[str]:
        """Return the lines that end an ``if`` after its last body."""
        return ["}"]

    def nothing(self, depth: int) -> list[str]:
        """Return the lines of a body without statements, indented by ``depth`` levels; in C, no lines."""
        return []

    def comment(self, text: str) -> list[str]:
        """Return the lines of a comment that says ``text``."""
        return [f"{self.COMMENT} {line}" for line in comment_lines(text)]

    # --- pieces of files --------------------------------------------------------------------------

    @classmethod
    def block(cls, lines: Iterable[str], depth: int = 1) -> str:
        """Return the lines as one text, each indented by ``depth`` levels unless it is empty."""
        return "\n".join(f"{cls.INDENT * depth}{line}" if line else "" for line in lines)

    @classmethod
    def items(cls, items: Sequence[str], depth: int = 0) -> str:
        """Return the items of a list as the text between the brackets of the list.

        If the items are too long for one line, each has a line of its own, indented one level
        deeper than ``depth``. But if all items are short, several of them share a line.
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

    def text(self, node: ProgramExpression, room: int = OR) -> str:
        """Return the text of an expression, in parentheses if its operator binds less tightly than ``room``.

        ``room`` is a binding strength, such as that of ``+``; a higher number binds more tightly.
        """
        text, binding = self._text_and_binding(node)
        return text if binding >= room else f"({text})"

    def name(self, name: str) -> str:
        """Return a variable as the language writes it, given its name in the program."""
        return name

    def real(self, value: float) -> str:
        """Return a floating-point literal for a number that is not negative."""
        return repr(value)

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """Return the code that calls a numeric function such as ``min``."""
        return f"{function}({', '.join(arguments)})"

    def choice(self, test: str, value: str, otherwise: str) -> str:
        """Return the code of an expression with the value of ``value`` if the test is true, else of ``otherwise``."""
        return f"{test} ? {value} : {otherwise}"

    def entry(self, table: Table, index: str) -> str:
        """Return the code that reads an entry of a table."""
        return f"{self.TABLES[table]}[{index}]"

    def _text_and_binding(self, node: ProgramExpression) -> tuple[str, int]:
        """Return the text of an expression, and how tightly its operator binds."""
        match node:
            case Real(value):
                # Look at the text, because -0.0 is not less than 0.
                return (f"-{self.real(-value)}", _SIGN) if repr(value)[0] == "-" else (self.real(value), UNIT)
            case Int(value):
                return str(value), _SIGN if value < 0 else UNIT
            case Bool(value):
                return self.WORDS["true" if value else "false"], UNIT
            case ProgramVariable(name):
                return self.name(name), UNIT
            case Negate(operand):
                return f"-{self.text(operand, UNIT)}", _SIGN
            case BinaryNumber(op, left, right):
                binding = _BINDING[op]
                return f"{self.text(left, binding)} {op} {self.text(right, binding + 1)}", binding
            case NumericCall(function, args):
                return self.call(function, [self.text(argument) for argument in args]), UNIT
            case Choice(test, value, otherwise):
                texts = [self.text(test, self.TEST), self.text(value), self.text(otherwise)]
                return self.choice(*texts), CHOICE
            case TableEntry(table, index):
                return self.entry(table, self.text(index)), UNIT
            case Compare(op, left, right):
                return f"{self.text(left, _SUM)} {self.COMPARISONS[op]} {self.text(right, _SUM)}", COMPARISON
            case Not(operand):
                return f"{self.WORDS['not']}{self.text(operand, UNIT)}", _SIGN
            case All(args) | Any(args):
                binding = _AND if isinstance(node, All) else OR
                word = self.WORDS["and" if isinstance(node, All) else "or"]
                # Compilers warn about `a && b || c` without parentheses.
                return f" {word} ".join(self.text(argument, COMPARISON) for argument in args), binding
        raise TypeError(f"not an expression: {node!r}")


def comment_lines(text: str) -> list[str]:
    """Return a text as lines of a comment, without the marks that begin a comment, such as ``//``.

    Characters that do not print are escaped. No line ends in a backslash, because in some languages
    a backslash joins the next line to the comment.
    """
    lines = wrap(printable_line(text), _LONGEST_COMMENT, break_long_words=False, break_on_hyphens=False)
    return [re.sub(r"\\$", r"\\ .", line) for line in lines]
