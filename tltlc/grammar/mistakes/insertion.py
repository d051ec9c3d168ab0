"""Find the place for a new declaration: on its own line, after the imports or before everything else."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Edit
from tltlc.grammar.module import Comment, Module
from tltlc.grammar.tree import Import


def declaration_edit(module: Module, line: str) -> Edit:
    """Return the edit that adds ``line`` to a module, after its last import.

    If there are no imports, the edit adds the line before the first declaration and its documentation
    comment.
    """
    source = module.source
    newline = "\r\n" if "\r\n" in source.text else "\n"
    imports = [declaration for declaration in module.declarations if isinstance(declaration, Import)]
    if imports:
        start = imports[-1].span.end
        end = _line_end(source, start)
        if source.text[start:end].lstrip().startswith("//") or not source.text[start:end].strip():
            return Edit(Span(end, end), f"{newline}{line}")
        # Another statement follows on the line; it may be a spec of several lines.
        return Edit(Span(start, start), f"{newline}{line}{newline}")
    first = min((declaration.span.start for declaration in module.declarations), default=len(source.text))
    _, column = source.position(documentation_start(source, first, module.comments))
    start = documentation_start(source, first, module.comments) - column + 1
    return Edit(Span(start, start), f"{line}{newline}")


def documentation_start(source: SourceFile, start: int, comments: Sequence[Comment]) -> int:
    """Return the offset where the ``///`` comment of the declaration at ``start`` begins, or ``start`` without one.

    Other comments may stand between the ``///`` comment and the declaration.
    """
    first = start
    for index in reversed(range(bisect_right(comments, start, key=lambda comment: comment.span.end))):
        comment = comments[index]
        if source.text[comment.span.end : start].strip():
            break
        start = comment.span.start
        if comment.text.startswith("///"):
            first = start
    return first


def _line_end(source: SourceFile, offset: int) -> int:
    """Return the offset of the end of the line that contains ``offset``."""
    number, column = source.position(offset)
    return offset - column + 1 + len(source.line(number))
