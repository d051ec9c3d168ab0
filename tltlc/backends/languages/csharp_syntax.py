"""Print the program of a monitor, strings and documentation comments in C#."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Final

from tltlc.program import snippets
from tltlc.program.printer import Printer, comment_lines
from tltlc.program.tree import If, Table

KEYWORDS: Final = """
    abstract as base bool break byte case catch char checked class const continue decimal default delegate do double
    else enum event explicit extern false finally fixed float for foreach goto if implicit in int interface internal
    is lock long namespace new null object operator out override params private protected public readonly ref return
    sbyte sealed short sizeof stackalloc static string struct switch this throw true try typeof uint ulong unchecked
    unsafe ushort using virtual void volatile while
    add alias allows and args ascending async await by descending dynamic equals extension field file from get global
    group init into join let managed nameof nint not notnull nuint on or orderby partial record remove required scoped
    select set unmanaged value var when where with yield
""".split()
"""Words of C#, some of which are names in some places."""

_FUNCTIONS: Final = {
    "divide": "Divide",
    "sqrt": "Sqrt",
    "power": "Power",
    "exp": "Exp",
    "min": "Min",
    "max": "Max",
    "abs": "Math.Abs",
    "tanh": "Math.Tanh",
}


def table_name(name: str) -> str:
    """Return the name of a table in C#: ``EdgeTargets`` for ``edge_targets``."""
    return name.title().replace("_", "")


class CSharpPrinter(Printer):
    """Prints the program of a monitor (:mod:`tltlc.program`) as C# code, with each brace on its own line."""

    COMPOUND: ClassVar[bool] = True
    TABLES: ClassVar[dict[Table, str]] = {name: table_name(name) for name in Printer.TABLES}

    def branches(self, statement: If, depth: int) -> list[str]:
        """Return the lines of an ``if`` with all its cases and its ``else``."""
        indent = self.INDENT * depth
        lines: list[str] = []
        for index, (test, body) in enumerate(statement.cases):
            lines += [f"{indent}{'else ' if index else ''}if ({self.text(test)})", f"{indent}{{"]
            lines += [*self.lines(body, depth + 1), f"{indent}}}"]
        if statement.otherwise:
            lines += [f"{indent}else", f"{indent}{{", *self.lines(statement.otherwise, depth + 1), f"{indent}}}"]
        return lines

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """Return the text of a call of a numeric function: of the monitor, or of C#'s ``Math``."""
        return super().call(_FUNCTIONS[function], arguments)


def string_literal(text: str) -> str:
    """Return a string literal that has only ASCII characters."""
    return snippets.string_literal(text, _escape, snippets.is_plain_ascii)


def _escape(character: str) -> str:
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def summary_comment(text: str) -> list[str]:
    """Return the lines of a documentation comment."""
    comments = [_in_xml(line) for line in comment_lines(text)]
    if len(comments) == 1:
        return [f"/// <summary>{comments[0]}</summary>"]
    return ["/// <summary>", *(f"/// {line}" for line in comments), "/// </summary>"]


def _in_xml(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
