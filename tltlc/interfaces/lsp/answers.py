"""Handle the editor's requests: find the document, and call the module that computes the answer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from lsprotocol import types

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Edit
from tltlc.grammar.tree import SpecDecl
from tltlc.interfaces.lsp import (
    actions,
    completion,
    durations,
    file_renames,
    folding,
    formatting,
    hover,
    imports,
    lenses,
    references,
    symbols,
    tokens,
)
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.edits import text_edit
from tltlc.interfaces.lsp.occurrences import Occurrence, Symbol
from tltlc.interfaces.lsp.paths import location_at
from tltlc.interfaces.lsp.positions import offset, range_of
from tltlc.interfaces.lsp.session import EditorSession
from tltlc.interfaces.lsp.worker import LONGEST_S


def _complete(server: EditorSession, params: types.CompletionParams) -> types.CompletionList | None:
    document, at = _place(server, params)
    if document is None:
        return None
    return types.CompletionList(is_incomplete=False, items=completion.completions(document, at, server.encoding))


def _hover(server: EditorSession, params: types.HoverParams) -> types.Hover | None:
    document, at = _place(server, params)
    return hover.hover(document, at, server.analysis(document), server.encoding) if document else None


def _definition(server: EditorSession, params: types.DefinitionParams) -> types.Location | None:
    document, at = _place(server, params)
    if document is None:
        return None
    name = document.name_at(at)
    if name is not None:
        symbol = name.symbol
        return types.Location(server.texts.uri(symbol.source), range_of(symbol.source, symbol.span, server.encoding))
    for span, source in imports.targets(document):
        if span.start <= at <= span.end:
            return types.Location(server.texts.uri(source), range_of(source, Span(0, 0), server.encoding))
    return None


def _links(server: EditorSession, params: types.DocumentLinkParams) -> list[types.DocumentLink] | None:
    document = server.texts.document(params.text_document.uri)
    return imports.links(document, server.encoding, server.texts.uri) if document else None


async def _references(server: EditorSession, params: types.ReferenceParams) -> list[types.Location] | None:
    name = await _name_everywhere(server, params, references.may_have_references)
    if name is None:
        return None
    return [
        types.Location(server.texts.uri(document.source), range_of(document.source, place.span, server.encoding))
        for document, places in references.references(name.symbol, server.texts)
        for place in places
        if params.context.include_declaration or not place.declares
    ]


def _highlight(server: EditorSession, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight] | None:
    document, at = _place(server, params)
    name = document.name_at(at) if document else None
    if document is None or name is None:
        return None
    return [
        types.DocumentHighlight(
            range_of(document.source, occurrence.span, server.encoding),
            types.DocumentHighlightKind.Write if occurrence.declares else types.DocumentHighlightKind.Read,
        )
        for occurrence in document.names
        if occurrence.symbol.is_same(name.symbol)
    ]


async def _prepare_rename(
    server: EditorSession, params: types.PrepareRenameParams
) -> types.PrepareRenamePlaceholder | None:
    name = await _name_everywhere(server, params, references.may_have_references)
    document = server.texts.document(params.text_document.uri)
    if document is None or name is None:
        return None
    references.check_renamable(name.symbol, server.texts)
    return types.PrepareRenamePlaceholder(range_of(document.source, name.span, server.encoding), name.symbol.name)


async def _rename(server: EditorSession, params: types.RenameParams) -> types.WorkspaceEdit | None:
    name = await _name_everywhere(server, params, references.may_refuse_rename)
    if name is None:
        return None
    return _workspace_edit(server, references.rename(name.symbol, params.new_name, server.texts))


async def _move_files(server: EditorSession, params: types.RenameFilesParams) -> types.WorkspaceEdit:
    await server.texts.parse(file_renames.may_import)
    renames = [(location_at(file.old_uri), location_at(file.new_uri)) for file in params.files]
    return _workspace_edit(server, file_renames.edits_of_moves(renames, server.texts))


def _format(server: EditorSession, params: types.DocumentFormattingParams) -> list[types.TextEdit] | None:
    document = server.texts.document(params.text_document.uri)
    return formatting.formatting(document, server.encoding) if document else None


def _actions(server: EditorSession, params: types.CodeActionParams) -> list[types.CodeAction] | None:
    document = server.texts.document(params.text_document.uri)
    requested_kinds = params.context.only
    if document is None or (
        requested_kinds is not None and not {"", types.CodeActionKind.QuickFix}.intersection(requested_kinds)
    ):
        return None
    analysis = server.analysis(document)
    findings = analysis.findings if analysis else ()
    place = _span(server, document, params.range)
    return actions.actions(document, place, findings, server.encoding, server.texts.uri, server.workspace_edit)


def _lenses(server: EditorSession, params: types.CodeLensParams) -> list[types.CodeLens]:
    uri = params.text_document.uri
    document = server.texts.document(uri)
    # Show the last lenses, even if outdated, so the lines of the text do not jump with each key.
    analysis = server.last_analysis(document) if document else None
    return lenses.lenses(document, uri, analysis, server.encoding) if document and analysis else []


def _hints(server: EditorSession, params: types.InlayHintParams) -> list[types.InlayHint] | None:
    document = server.texts.document(params.text_document.uri)
    return durations.hints(document, _span(server, document, params.range), server.encoding) if document else None


def _folding(server: EditorSession, params: types.FoldingRangeParams) -> list[types.FoldingRange] | None:
    document = server.texts.document(params.text_document.uri)
    return folding.folds(document) if document else None


def _tokens(server: EditorSession, params: types.SemanticTokensParams) -> types.SemanticTokens | None:
    document = server.texts.document(params.text_document.uri)
    return types.SemanticTokens(tokens.tokens(document, server.encoding)) if document else None


def _symbols(server: EditorSession, params: types.DocumentSymbolParams) -> list[types.DocumentSymbol] | None:
    document = server.texts.document(params.text_document.uri)
    return symbols.symbols(document, server.encoding) if document else None


async def _find_symbols(server: EditorSession, params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
    await server.texts.parse(lambda text: True)
    return [
        symbol
        for document in server.texts.all()
        for symbol in symbols.matching_symbols(
            document, params.query, server.encoding, server.texts.uri(document.source)
        )
    ]


async def run_tests(server: EditorSession, uri: str, spec: str) -> None:
    """Show the user how many tests of a spec pass, or why they did not run.

    ``uri`` is the URI of the document that declares the spec, and ``spec`` the spec's name.
    """
    analysis = await server.analysis_of(uri)
    figures = next((entry for entry in analysis.figures if entry.spec == spec), None) if analysis else None
    document = server.texts.document(uri)
    if figures is not None:
        text = f"{spec}: {lenses.tests_text(figures)}"
    elif document is None or not any(
        isinstance(declaration, SpecDecl) and declaration.name == spec for declaration in document.module.declarations
    ):
        text = f"there is no spec `{spec}`, so there are no tests to run"
    elif analysis is None and document.is_clean:
        text = f"the tests of `{spec}` did not run: a text changed, or its automata take more than {LONGEST_S:g} s"
    else:
        text = f"the tests of `{spec}` did not run: its file, or a file that it imports, has errors"
    kind = types.MessageType.Info if figures is not None and not figures.failed else types.MessageType.Warning
    server.window_show_message(types.ShowMessageParams(kind, text))


def _workspace_edit(server: EditorSession, changes: list[tuple[Document, list[Edit]]]) -> types.WorkspaceEdit:
    edits = {
        server.texts.uri(document.source): [
            text_edit(document.source, edit, server.encoding) for edit in document_edits
        ]
        for document, document_edits in changes
    }
    return server.workspace_edit(edits)


def _place(server: EditorSession, params: Any) -> tuple[Document | None, int]:
    """Return the document of a request, and the character offset in it.

    If there is no such document, return None and 0.
    """
    document = server.texts.document(params.text_document.uri)
    return document, offset(document.source, params.position, server.encoding) if document else 0


def _span(server: EditorSession, document: Document, requested: types.Range) -> Span:
    start, end = (offset(document.source, end_point, server.encoding) for end_point in (requested.start, requested.end))
    return Span(start, max(start, end))


def _name(server: EditorSession, params: Any) -> Occurrence | None:
    document, at = _place(server, params)
    return document.name_at(at) if document else None


async def _name_everywhere(
    server: EditorSession, params: Any, is_needed: Callable[[Symbol, str], bool]
) -> Occurrence | None:
    """Parse all texts that may use the name at the position of a request, then return this name.

    ``is_needed(symbol, text)`` says whether ``text`` must be parsed because it may use ``symbol``.
    Return None if there is no name at the position.
    """
    name = _name(server, params)
    if name is not None:
        await server.texts.parse(lambda text: is_needed(name.symbol, text))
    # The text may have changed while other files were parsed.
    return _name(server, params)


FILES_AND_FOLDERS: Final = types.FileOperationRegistrationOptions(
    [
        types.FileOperationFilter(types.FileOperationPattern(glob, kind), "file")
        for glob, kind in (
            ("**", types.FileOperationPatternKind.Folder),
            ("**/*.tltl", types.FileOperationPatternKind.File),
        )
    ]
)
"""The files and folders whose renaming and deletion the editor reports to the server."""

ANSWERS: Final[tuple[tuple[str, Callable[[EditorSession, Any], Any], Any], ...]] = (
    (types.TEXT_DOCUMENT_COMPLETION, _complete, types.CompletionOptions(trigger_characters=[".", '"', "("])),
    (types.TEXT_DOCUMENT_HOVER, _hover, None),
    (types.TEXT_DOCUMENT_DEFINITION, _definition, None),
    (types.TEXT_DOCUMENT_DOCUMENT_LINK, _links, types.DocumentLinkOptions()),
    (types.TEXT_DOCUMENT_REFERENCES, _references, None),
    (types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, _highlight, None),
    (types.TEXT_DOCUMENT_PREPARE_RENAME, _prepare_rename, None),
    (types.TEXT_DOCUMENT_RENAME, _rename, types.RenameOptions(prepare_provider=True)),
    (types.WORKSPACE_WILL_RENAME_FILES, _move_files, FILES_AND_FOLDERS),
    (types.TEXT_DOCUMENT_FORMATTING, _format, None),
    (
        types.TEXT_DOCUMENT_CODE_ACTION,
        _actions,
        types.CodeActionOptions(code_action_kinds=[types.CodeActionKind.QuickFix]),
    ),
    (types.TEXT_DOCUMENT_CODE_LENS, _lenses, types.CodeLensOptions(resolve_provider=False)),
    (types.TEXT_DOCUMENT_INLAY_HINT, _hints, types.InlayHintOptions(resolve_provider=False)),
    (types.TEXT_DOCUMENT_FOLDING_RANGE, _folding, None),
    (types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, _tokens, tokens.LEGEND),
    (types.TEXT_DOCUMENT_DOCUMENT_SYMBOL, _symbols, None),
    (types.WORKSPACE_SYMBOL, _find_symbols, None),
)
"""The requests of the protocol with their handlers and options."""
