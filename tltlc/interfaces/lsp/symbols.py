"""List the declarations of a text, for outlines and for search by name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from lsprotocol import types

from tltlc.core.source import Span
from tltlc.grammar import tree
from tltlc.interfaces.lsp.declaration_text import declaration_text
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.positions import range_of

_KINDS: Final = {
    tree.SignalDecl: types.SymbolKind.Field,
    tree.ParamDecl: types.SymbolKind.Constant,
    tree.PredicateDecl: types.SymbolKind.Function,
    tree.LetDecl: types.SymbolKind.Function,
    tree.SpecDecl: types.SymbolKind.Class,
}


def symbols(document: Document, encoding: str) -> list[types.DocumentSymbol]:
    """Return the names that a document declares, in order, with the clauses of a spec as its children.

    Columns are counted in units of ``encoding``, such as ``utf-16``.
    """
    source = document.source
    outline = []
    for declaration in document.module.declarations:
        children = [_clause(clause, document, encoding) for clause in _clauses(declaration)]
        head = declaration_text(declaration, source, head=True)
        for name, kind, span, name_span in _outline_entries(declaration):
            outline.append(
                types.DocumentSymbol(
                    name,
                    kind,
                    range_of(source, span, encoding),
                    range_of(source, name_span, encoding),
                    detail=head if len(head) <= 80 else None,
                    children=children or None,
                )
            )
    return outline


def matching_symbols(document: Document, query: str, encoding: str, uri: str) -> list[types.WorkspaceSymbol]:
    """Return the declarations, except imports, whose names contain the letters of the query in order.

    Other letters may stand between them, and case does not matter: ``nr`` matches ``Near``. An empty
    query matches every name. ``uri`` is the URI of the document. Columns are counted in units of
    ``encoding``, such as ``utf-16``.
    """
    source = document.source
    return [
        types.WorkspaceSymbol(types.Location(uri, range_of(source, name_span, encoding)), name, kind)
        for declaration in document.module.declarations
        if not isinstance(declaration, tree.Import)
        for name, kind, _, name_span in _outline_entries(declaration)
        if _has_letters(name.lower(), query.lower())
    ]


def _has_letters(name: str, query: str) -> bool:
    remaining_letters = iter(name)
    return all(letter in remaining_letters for letter in query)


def _outline_entries(declaration: tree.Declaration) -> Iterator[tuple[str, types.SymbolKind, Span, Span]]:
    """Yield for each name in a declaration: the name, its kind, the span of the declaration, and the name's span."""
    match declaration:
        case tree.Import():
            yield declaration.target, types.SymbolKind.Module, declaration.span, declaration.target_span
        case tree.EntityDecl():
            for name in declaration.names:
                yield name.name, types.SymbolKind.EnumMember, name.span, name.span
        case tree.GroupDecl():
            yield declaration.name, types.SymbolKind.Enum, declaration.span, declaration.name_span
        case tree.TestDecl():
            yield declaration.title or "test", types.SymbolKind.Event, declaration.span, declaration.spec.span
        case tree.SignalDecl() | tree.ParamDecl() | tree.PredicateDecl() | tree.LetDecl() | tree.SpecDecl():
            yield declaration.name, _KINDS[type(declaration)], declaration.span, declaration.name_span


def _clauses(declaration: tree.Declaration) -> tuple[tree.Clause, ...]:
    return declaration.clauses if isinstance(declaration, tree.SpecDecl) and declaration.block else ()


def _clause(clause: tree.Clause, document: Document, encoding: str) -> types.DocumentSymbol:
    text = " ".join(document.source.slice(clause.span).split())
    return types.DocumentSymbol(
        text if len(text) <= 80 else f"{text[:79]}…",
        types.SymbolKind.Property,
        range_of(document.source, clause.span, encoding),
        range_of(document.source, clause.keyword_span, encoding),
    )
