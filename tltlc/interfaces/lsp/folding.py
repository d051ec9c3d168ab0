"""Find the lines that an editor can fold: blocks, long statements, and runs of comments or imports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lsprotocol import types

from tltlc.core.source import Span
from tltlc.grammar.tree import Import, SpecDecl, TestDecl
from tltlc.interfaces.lsp.document import Document

_Lines = tuple[int, int]
"""The first and the last line, counted from 1."""


def folds(document: Document) -> list[types.FoldingRange]:
    """Return the ranges of lines that an editor can fold, in order.

    The last line of a block, with its brace, stays visible.
    """
    module = document.module
    imports = [
        _lines(document, declaration.span) for declaration in module.declarations if isinstance(declaration, Import)
    ]
    comments = [_lines(document, comment.span) for comment in module.comments if _is_alone(document, comment.span)]
    ranges = [
        *(_fold(lines) for lines in _statements(document)),
        *(_fold(lines, types.FoldingRangeKind.Imports) for lines in _runs(imports)),
        *(_fold(lines, types.FoldingRangeKind.Comment) for lines in _runs(comments)),
    ]
    return sorted((fold for fold in ranges if fold.start_line < fold.end_line), key=lambda fold: fold.start_line)


def _fold(lines: _Lines, kind: types.FoldingRangeKind | None = None) -> types.FoldingRange:
    return types.FoldingRange(lines[0] - 1, lines[1] - 1, kind=kind)


def _statements(document: Document) -> Iterator[_Lines]:
    """Yield the first and last line of each declaration except imports, and of each clause in a block."""
    for declaration in document.module.declarations:
        if isinstance(declaration, Import):
            continue
        first, last = _lines(document, declaration.span)
        is_block = isinstance(declaration, TestDecl) or (isinstance(declaration, SpecDecl) and declaration.block)
        yield first, last - 1 if is_block else last
        if is_block and isinstance(declaration, SpecDecl):
            yield from (_lines(document, clause.span) for clause in declaration.clauses)


def _lines(document: Document, span: Span) -> _Lines:
    return document.source.position(span.start)[0], document.source.position(span.end)[0]


def _is_alone(document: Document, span: Span) -> bool:
    line, column = document.source.position(span.start)
    return not document.source.line(line)[: column - 1].strip()


def _runs(pieces: Iterable[_Lines]) -> Iterator[_Lines]:
    """Merge ranges of lines that follow each other without a gap; yield the merged ranges."""
    run: _Lines | None = None
    for first, last in pieces:
        if run is not None and first <= run[1] + 1:
            run = run[0], last
            continue
        if run is not None:
            yield run
        run = first, last
    if run is not None:
        yield run
