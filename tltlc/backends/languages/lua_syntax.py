"""Print the program of a monitor, strings and tables in Lua."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import ClassVar, Final

from tltlc.program import reward_step, snippets, states
from tltlc.program.enums import SignalEnum
from tltlc.program.printer import CHOICE, Printer
from tltlc.program.tree import Assign, Declare, If, Int, Statement

DEEPEST_BLOCK: Final = 60
"""The depth of nested blocks at which inner blocks become functions.

Lua allows 200 levels, but expressions in the blocks need some of them.
"""

KEYWORDS: Final = """
    and break do else elseif end false for function goto if in local nil not or repeat return then true until while
    continue export typeof
""".split()
"""Words of Lua and Luau."""


class LuaPrinter(Printer):
    """Prints the program of a monitor (:mod:`tltlc.program`) as Lua code.

    ``fields`` maps each variable that is a field of a table to the text that accesses the field,
    such as ``signal.health``; all other variables are local. ``atoms`` are the names of the atoms in
    the spec. Blocks that are nested too deep become functions, whose lines are collected in
    ``parts``. They can use only fields: ``tables`` are their tables, separated by commas.
    """

    INDENT = "  "
    COMMENT = "--"
    """The start of a comment.

    :meth:`Printer.comment` writes a blank after it, because ``--[[`` would begin a long comment.
    """
    WORDS: ClassVar = {"and": "and", "or": "or", "not": "not ", "true": "true", "false": "false"}
    COMPARISONS: ClassVar = {**Printer.COMPARISONS, "!=": "~="}
    TABLES: ClassVar = {name: name.upper() for name in Printer.TABLES}
    END = ""

    def __init__(self, fields: Mapping[str, str], atoms: Sequence[str], tables: str = "") -> None:
        self._fields, self._atoms, self._tables = fields, atoms, tables
        self._part_count = 0
        self.parts: list[str] = []

    def name(self, name: str) -> str:
        """Return the name of a variable in Lua.

        For ``steps_real``, the number of steps as a real number, this is ``steps``: Lua converts
        whole numbers itself.
        """
        return reward_step.STEPS if name == reward_step.STEPS_REAL else self._fields.get(name, name)

    def lines(self, statements: Iterable[Statement], depth: int = 0) -> list[str]:
        """Return the lines of statements; a declaration without a value is left out if the variable is a field."""
        needed = [
            statement
            for statement in statements
            if not (isinstance(statement, Declare) and statement.value is None and statement.name in self._fields)
        ]
        return super().lines(needed, depth)

    def declaration(self, statement: Declare) -> str:
        """Return the declaration of a local variable; if the variable is a field, return an assignment to it."""
        local = "" if statement.name in self._fields else "local "
        value = "" if statement.value is None else f" = {self.text(statement.value, CHOICE)}"
        return f"{local}{self.name(statement.name)}{value}"

    def assignment(self, statement: Assign) -> str:
        """Return the text of an assignment; the variable ``limiting`` gets the name of an atom instead of its index."""
        match statement:
            case Assign(states.LIMITING, Int(index)):
                return f"{states.LIMITING} = {string_literal(self._atoms[index]) if index >= 0 else 'nil'}"
        return super().assignment(statement)

    def branches(self, statement: If, depth: int) -> list[str]:
        """Return the lines of an ``if``.

        If the ``if`` is nested too deep, move these lines to a new function in ``parts``, and return
        a call of this function.
        """
        if depth < DEEPEST_BLOCK:
            return super().branches(statement, depth)
        self._part_count += 1
        head = f"part[{self._part_count}] = function({self._tables})"
        call = f"part[{self._part_count}]({self._tables})"
        self.parts += [head, *super().branches(statement, 1), "end", ""]
        return [f"{self.INDENT * depth}{call}"]

    def choice(self, test: str, value: str, otherwise: str) -> str:
        """Return the text of an expression that has one of two values, which are never false."""
        return f"{test} and {value} or {otherwise}"

    def head(self, test: str, *, first: bool) -> str:
        """Return the line that begins a case: ``if`` or ``elseif``, with its test."""
        return f"{'if' if first else 'elseif'} {test} then"

    def otherwise(self) -> str:
        """Return the line that begins the ``else``."""
        return "else"

    def closing(self) -> list[str]:
        """Return the lines that end an ``if``."""
        return ["end"]


def string_literal(text: str) -> str:
    """Return a string literal, in which each UTF-8 byte of a character that does not print is escaped."""
    return snippets.string_literal(text, _escape)


def _escape(character: str) -> str:
    return "".join(f"\\{byte:03d}" for byte in character.encode("utf-8", "replace"))


def table_key(name: str) -> str:
    """Return a key as the constructor of a Lua table writes it: ``health`` or ``["near(s1)"]``."""
    return name if _is_identifier(name) else f"[{string_literal(name)}]"


def key_access(name: str) -> str:
    """Return the text that follows a table's name to access a key: ``.health`` or ``["near(s1)"]``."""
    return f".{name}" if _is_identifier(name) else table_key(name)


def _is_identifier(name: str) -> bool:
    return re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name) is not None and name not in KEYWORDS


def items_from_0(numbers: Sequence[float]) -> list[str]:
    """Return the items of a list of numbers whose first index is 0."""
    return [f"{'' if index else '[0] = '}{number!r}" for index, number in enumerate(numbers)]


def table_text(items: Sequence[str]) -> str:
    """Return the text of a list in Lua, with a line for each item; ``{}`` if there are no items."""
    return "{\n" + "".join(f"{LuaPrinter.INDENT}{item},\n" for item in items) + "}" if items else "{}"


def enum_tables(enums: Sequence[SignalEnum]) -> str:
    """Return the tables of the values of enums, and an empty line; an empty text if there are none."""
    if not enums:
        return ""
    lines = ["-- The values of enums, by the name of a signal without its arguments, and the name of the value."]
    lines.append("local VALUES = {")
    for enum in enums:
        values = ", ".join(f"{table_key(value)} = {number}" for number, value in enumerate(enum.values))
        lines.append(f"  {table_key(enum.base)} = {{ {values} }},")
    lines += ["}", "", "-- The same by the name of a signal.", "local SIGNAL_VALUES = {"]
    for enum in enums:
        lines += [f"  {table_key(signal)} = VALUES{key_access(enum.base)}," for signal in enum.signals]
    return "\n".join([*lines, "}", ""])
