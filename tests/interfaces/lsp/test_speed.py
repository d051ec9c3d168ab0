"""The cost of a keystroke in a file of 500 lines, compared with a parse of it; and the cost of long
lines."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from lsprotocol import types

from tests.calls import calls
from tests.interfaces.lsp.client import Client
from tests.interfaces.lsp.texts import open_text
from tests.waiting import printed
from tltlc.core.source import SourceFile
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import EntityDecl
from tltlc.interfaces.lsp import occurrences, symbols
from tltlc.interfaces.lsp.diagnostics import protocol_diagnostic
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.paths import uri_of
from tltlc.interfaces.lsp.positions import UTF_16, offset, range_of
from tltlc.interfaces.lsp.references import rename
from tltlc.interfaces.lsp.tokens import tokens
from tltlc.interfaces.lsp.workspace import Workspace

SPEC = """
/// The two switches, then the exit.
spec s%d {
    limit 400 steps
    reach near(s1) then near(s2) then near(exit)
    keep covered or near(s1, close = 3 m)
    avoid health < 20 %% and seen
    require always (seen implies eventually within 20 steps hidden)
}

test "t%d" for s%d {
    step covered, near(s1)
    expect pending
}
"""
TEXT = "import stealth\nentity s1, s2, exit\n" + "".join(SPEC % (i, i, i) for i in range(36))
MOST_PARSES = 6.0
"""The measured value is 2.4."""


def test_a_keystroke_costs_a_few_parses(tmp_path: Path) -> None:
    assert TEXT.count("\n") > 500
    workspace = Workspace()
    uri = (tmp_path / "many.tltl").as_uri()
    versions = iter(range(1, 1000))

    def keystroke() -> None:
        version = next(versions)
        workspace.put(uri, version, TEXT + f"// {version}")
        document = workspace.document(uri)
        assert document is not None
        assert [
            protocol_diagnostic(diagnostic, document, "utf-16", uri_of) for diagnostic in document.diagnostics
        ] == []

    keystroke()  # Warm up: read the libraries.
    parse(SourceFile("many.tltl", TEXT))  # Warm up: read the tables of the grammar.
    assert calls(keystroke) < MOST_PARSES * calls(lambda: parse(SourceFile("many.tltl", TEXT)))


def test_an_editor_gets_diagnostics_after_each_change(client: Client, tmp_path: Path) -> None:
    """This includes the process, the protocol and the pause in which changes are collected."""
    uri = client.open(tmp_path / "many.tltl", TEXT)
    client.diagnostics(uri)
    for version in range(2, 9):
        client.change(uri, TEXT + f"spec wrong{version} = neer\n", version)
        (diagnostic,) = client.diagnostics(uri, bool)
        assert "`neer`" in diagnostic["message"]


LONG_LINE = "signal a: bool let b = □ %sa"
BROKEN = "signal (\n%s"


def _tokens(document: Document, _: Workspace) -> object:
    return tokens(document, UTF_16)


def _ranges(document: Document, _: Workspace) -> object:
    return [range_of(document.source, occurrence.span, UTF_16) for occurrence in document.names]


def _offsets(document: Document, _: Workspace) -> object:
    return [offset(document.source, types.Position(0, column)) for column in range(0, len(document.names), 10)]


def _diagnostics(document: Document, _: Workspace) -> object:
    return document.diagnostics


def _rename(document: Document, workspace: Workspace) -> object:
    return rename(document.names[0].symbol, "renamed", workspace)


WORK: dict[str, tuple[Callable[[Document, Workspace], object], str, str]] = {
    "semantic tokens": (_tokens, LONG_LINE, "a & "),
    "highlights": (_ranges, LONG_LINE, "a & "),
    "offsets": (_offsets, LONG_LINE, "a & "),
    "messages on a broken text": (_diagnostics, BROKEN, "let x# = missing#\n"),
    "renaming": (_rename, LONG_LINE, "a & "),
}


@pytest.mark.parametrize(("work", "text", "piece"), WORK.values(), ids=WORK)
def test_the_work_is_linear_in_the_text(work: Callable[..., object], text: str, piece: str) -> None:
    def cost(count: int) -> int:
        document, _, workspace = open_text(text % "".join(piece.replace("#", str(number)) for number in range(count)))
        assert document.resolution
        return calls(lambda: work(document, workspace))

    cost(1)  # Warm up: read the tables of the grammar.
    assert cost(800) < 3 * cost(400)


def test_symbols_read_each_declaration_once(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[object] = []

    def recording(declaration: Any, *arguments: Any, **options: Any) -> str:
        read.append(declaration)
        return original(declaration, *arguments, **options)

    original: Callable[..., str] = vars(symbols)["declaration_text"]
    monkeypatch.setattr(symbols, "declaration_text", recording)
    document, _, _ = open_text(f"entity {', '.join(f'e{i}' for i in range(50))}")
    assert len(symbols.symbols(document, UTF_16)) == 50
    assert [type(declaration) for declaration in read] == [EntityDecl]


def test_the_label_of_a_state_is_parsed_on_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    sizes: list[int] = []

    def recording(source: SourceFile) -> Any:
        sizes.append(len(source.text))
        return parse_formula(source)

    parse_formula = vars(occurrences)["parse_formula"]
    monkeypatch.setattr(occurrences, "parse_formula", recording)
    label = 'step a\n    expect state "F a"\n'
    document, _, _ = open_text(f'signal a: bool\nspec s = F a\ntest "t" for s {{\n{label * 30}}}')
    spans = [occurrence.span for occurrence in document.names if occurrence.symbol.name == "a"]
    assert {document.source.slice(span) for span in spans} == {"a"}
    assert len(spans) == 2 + 2 * 30
    assert set(sizes) == {len("F a")}


def test_a_long_word_is_completed_in_linear_time() -> None:
    program = (
        "from tltlc.interfaces.lsp.cursor import cursor; from tltlc.core.source import SourceFile\n"
        "text = '// ' + 'a' * 1_000_000 + ' '\n"
        "print(cursor(SourceFile('long.tltl', text), len(text)))"
    )
    assert printed(program).strip() == b"None"
