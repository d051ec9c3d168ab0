"""Fuzzing: for any text at any time, the server answers every request for the current text of the
editor."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from lsprotocol import types

from tests.interfaces.lsp.texts import EXAMPLES, open_text
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Edit, TltlError
from tltlc.interfaces.lsp import (
    actions,
    completion,
    folding,
    formatting,
    hover,
    imports,
    lenses,
    references,
    symbols,
    tokens,
)
from tltlc.interfaces.lsp.cursor import cursor, quoted_text
from tltlc.interfaces.lsp.diagnostics import label_in, protocol_diagnostic
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.edits import apply_edits
from tltlc.interfaces.lsp.paths import uri_of
from tltlc.interfaces.lsp.positions import offset, position, range_of
from tltlc.interfaces.lsp.slow_analysis import DocumentAnalysis, SpecFigures
from tltlc.interfaces.lsp.workspace import Workspace

PIECES = (
    "(", ")", "{", "}", "[", "]", ",", ":", "=", '"', "//", "///", "\r\n", "\n", "\t", ".", "-",
    "𝒰", "é", "\ud800", "\x0c", "\u2028", "\0", "1e999", "0.5.5", "x.y.z", "F[2,3]", "spec", "test", "entity",
    " then ", " all x in (s1, s2): ", " 3 m ", " within 3 s ", "import ", 'import "', "let p(q) = q ", 'expect state "',
    " limit limit ", " judge at ", " step 3x ", "when a: b otherwise: c",
)  # fmt: skip
NOTHING = DocumentAnalysis((), (), (SpecFigures("branching", 6, 4, 1, 0),))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_random_edits_keep_all_answers_consistent(path: Path) -> None:
    generator = random.Random(path.stem)
    whole = path.read_text(encoding="utf-8")
    for _ in range(4):
        document, _, workspace = open_text(whole, path.parent)
        uri, text = uri_of(document.source), whole
        for version in range(2, 2 + generator.randint(1, 5)):
            text = random_edit(text, generator)
            workspace.put(uri, version, text)
            changed = workspace.document(uri)
            assert changed is not None
            assert (changed.source.text, workspace.version(uri)) == (text, version)
            ask_everything(changed, workspace, generator)
        reparsed, _, _ = open_text(text, path.parent)
        assert (changed.diagnostics, changed.names, changed.module) == (
            reparsed.diagnostics,
            reparsed.names,
            reparsed.module,
        )


def random_edit(text: str, generator: random.Random) -> str:
    """Return a text after a random edit, as by typing."""
    start = generator.randint(0, len(text))
    end = min(len(text), start + generator.choice((0, 0, 1, 3, 20, 300)))
    words = text.split()
    new = generator.choice((*PIECES, "", "", generator.choice(words) if words else "", text[start : start + 80]))
    return text[:start] + new + text[end:]


def ask_everything(document: Document, workspace: Workspace, generator: random.Random) -> None:
    source = document.source
    encoding = generator.choice(("utf-8", "utf-16", "utf-32"))
    check_diagnostics(document, encoding)
    check_symbols(document, encoding)
    links = imports.links(document, encoding, uri_of)
    targets = [source.slice(span) for span, _ in imports.targets(document)]
    assert [text_at(document, link.range, encoding) for link in links] == targets
    check_folds(document)
    check_tokens(document, encoding)
    lenses.lenses(document, "file:///x", NOTHING, encoding)
    formatting.formatting(document, encoding)
    for occurrence in document.names:
        assert source.slice(occurrence.span) == occurrence.symbol.name
    for _ in range(8):
        at = generator.randint(0, len(source.text))
        back = offset(source, position(source, at, encoding), encoding)
        assert back == at or source.text[at - 1 : at + 1] == "\r\n"
        cursor(source, at)
        quoted_text(source, at)
        completion.completions(document, at, encoding)
        hover.hover(document, at, NOTHING, encoding)
        named = document.name_at(at)
        if named is not None and generator.random() < 0.2:
            references.references(named.symbol, workspace)
            try:
                changed = references.rename(named.symbol, "brand_new", workspace)
            except TltlError as error:
                assert error.diagnostics[0].code in ("TLT0770", "TLT0771")
            else:
                check_rename(document, changed)
    if generator.random() < 0.3:
        at = generator.randint(0, len(source.text))
        actions.actions(document, Span(at, at), (), encoding, uri_of, types.WorkspaceEdit)
    range_of(source, Span(0, len(source.text) + 5), encoding)


def text_at(document: Document, where: types.Range, encoding: str) -> str:
    """Return the text at a range of the editor."""
    start, end = (offset(document.source, position_, encoding) for position_ in (where.start, where.end))
    assert start <= end
    return document.source.text[start:end]


def check_diagnostics(document: Document, encoding: str) -> None:
    """Assert that the diagnostics are at the compiler's positions, in columns of the editor."""
    for diagnostic in document.diagnostics:
        label = label_in(diagnostic, document)
        lsp_diagnostic = protocol_diagnostic(diagnostic, document, encoding, uri_of)
        assert lsp_diagnostic.message.startswith(diagnostic.title)
        if label is not None:
            source, span = document.source, label.span
            assert text_at(document, lsp_diagnostic.range, encoding) == text_at(
                document, range_of(source, span), "utf-16"
            )


def check_symbols(document: Document, encoding: str) -> None:
    """Assert that the name of a declaration is within its range, and that a search finds it."""
    declared = symbols.symbols(document, encoding)
    for symbol in declared:
        own = text_at(document, symbol.selection_range, encoding)
        assert own in text_at(document, symbol.range, encoding)
        assert own == symbol.name or symbol.kind in (types.SymbolKind.Module, types.SymbolKind.Event)
    names = {symbol.name for symbol in symbols.matching_symbols(document, "", encoding, "file:///x")}
    assert names == {symbol.name for symbol in declared if symbol.kind != types.SymbolKind.Module}


def check_rename(document: Document, changed: list[tuple[Document, list[Edit]]]) -> None:
    for other, edits in changed:
        text = apply_edits(other.source.text, edits)
        assert text.count("brand_new") >= len(edits)


def check_folds(document: Document) -> None:
    last, _ = document.source.position(len(document.source.text))
    for fold in folding.folds(document):
        assert 0 <= fold.start_line < fold.end_line < last


def check_tokens(document: Document, encoding: str) -> None:
    """Assert that the tokens are in order and at the positions of the names."""
    numbers = tokens.tokens(document, encoding)
    line = column = 0
    for at, name in zip(range(0, len(numbers), 5), document.names, strict=True):
        down, right, length, kind, modifiers = numbers[at : at + 5]
        line, column = line + down, (0 if down else column) + right
        start = offset(document.source, types.Position(line, column), encoding)
        assert document.source.text[start : start + length] == name.symbol.name
        assert kind < len(tokens.LEGEND.token_types)
        assert modifiers < 1 << len(tokens.LEGEND.token_modifiers)
