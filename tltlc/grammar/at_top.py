"""Where a new declaration goes: on a line of its own, behind the imports or before everything else."""

from __future__ import annotations

from tltlc.diagnostics.diagnostic import Edit
from tltlc.grammar.tree import Import, Module
from tltlc.source import SourceFile, Span


def at_top(module: Module, line: str) -> Edit:
    """The edit that adds a line behind the imports, or before the first declaration and its documentation."""
    source = module.source
    newline = "\r\n" if "\r\n" in source.text else "\n"
    imports = [each for each in module.declarations if isinstance(each, Import)]
    if imports:
        start = imports[-1].span.end
        end = _line_end(source, start)
        if source.text[start:end].lstrip().startswith("//") or not source.text[start:end].strip():
            return Edit(Span(end, end), f"{newline}{line}")
        # The line goes on, perhaps with a spec of several lines.
        return Edit(Span(start, start), f"{newline}{line}{newline}")
    first = min((each.span.start for each in module.declarations), default=len(source.text))
    number, column = source.position(first)
    start = first - column + 1
    while number > 1 and source.line(number - 1).lstrip().startswith("///"):
        number -= 1
        start = source.text.rfind("\n", 0, start - 1) + 1
    return Edit(Span(start, start), f"{line}{newline}")


def _line_end(source: SourceFile, offset: int) -> int:
    """Return the offset at which the line of ``offset`` ends."""
    number, column = source.position(offset)
    return offset - column + 1 + len(source.line(number))
