"""What of a text can be folded: blocks, statements of several lines, comments and imports that follow each other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lsprotocol import types

from tltlc.core.source import Span
from tltlc.grammar.tree import Import, SpecDecl, TestDecl
from tltlc.interfaces.lsp.analysed_text import Document

_Lines = tuple[int, int]
"""The first line and the last one, from 1."""


def folds(document: Document) -> list[types.FoldingRange]:
    """The lines that can be folded, in order; of a block the last one, with its brace, stays to be seen."""
    module = document.module
    imports = [_lines(document, each.span) for each in module.declarations if isinstance(each, Import)]
    comments = [_lines(document, each.span) for each in module.comments if _is_alone(document, each.span)]
    found = [
        *(_fold(lines) for lines in _statements(document)),
        *(_fold(lines, types.FoldingRangeKind.Imports) for lines in _runs(imports)),
        *(_fold(lines, types.FoldingRangeKind.Comment) for lines in _runs(comments)),
    ]
    return sorted((each for each in found if each.start_line < each.end_line), key=lambda each: each.start_line)


def _fold(lines: _Lines, kind: types.FoldingRangeKind | None = None) -> types.FoldingRange:
    return types.FoldingRange(lines[0] - 1, lines[1] - 1, kind=kind)


def _statements(document: Document) -> Iterator[_Lines]:
    """The declarations but for imports, and the clauses in blocks."""
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
    """The lines of those that follow each other, together."""
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
