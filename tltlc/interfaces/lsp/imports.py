"""Resolve the imports of a text to their files."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from lsprotocol import types

from tltlc.core.source import SourceFile, Span
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.positions import range_of


def targets(document: Document) -> Iterator[tuple[Span, SourceFile]]:
    """Yield each ``import`` that leads to a file: the span of the name or path in it, and the file."""
    for declaration, loaded in document.resolution.modules[-1].imports:
        yield declaration.target_span, loaded.module.source


def links(document: Document, encoding: str, uri_of: Callable[[SourceFile], str]) -> list[types.DocumentLink]:
    """Return the imports of a document as links to their files.

    Columns are counted in units of ``encoding``, such as ``utf-16``. ``uri_of`` returns the URI of a
    source.
    """
    return [
        types.DocumentLink(range_of(document.source, span, encoding), target=uri_of(source))
        for span, source in targets(document)
    ]
