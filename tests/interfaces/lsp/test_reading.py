"""Aids for reading: semantic colours, folds, links, hints, and the search for symbols."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from lsprotocol import types

from tests.interfaces.lsp.client import Client
from tests.interfaces.lsp.texts import EXAMPLES, open_text
from tltlc.core.source import Span
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.durations import hints
from tltlc.interfaces.lsp.folding import folds
from tltlc.interfaces.lsp.positions import offset
from tltlc.interfaces.lsp.symbols import matching_symbols
from tltlc.interfaces.lsp.tokens import LEGEND, tokens

TEXT = """\
import stealth
import core as c

// One door,
// and a switch.
entity s1, door
param most: ratio = 10 %
signal noise: ratio
let calm(limit_of, x: entity) =
    noise < limit_of
    and not near(x)
/// Leave.
spec leave {
    limit 400 steps
    reach all place in (s1, door): near(place)
        then near(door)
    require calm(most, door)
}

test "t" for leave {
    step near(s1)
    expect pending
}
"""


def decode_tokens(document: Document, numbers: list[int]) -> list[tuple[str, str, set[str]]]:
    """Return the names with their token types and modifiers, decoded as an editor does."""
    names = []
    line = column = 0
    for at in range(0, len(numbers), 5):
        down, right, length, kind, bits = numbers[at : at + 5]
        line, column = line + down, (0 if down else column) + right
        start = offset(document.source, types.Position(line, column))
        modifiers = {modifier for bit, modifier in enumerate(LEGEND.token_modifiers) if bits >> bit & 1}
        names.append((document.source.text[start : start + length], LEGEND.token_types[kind], modifiers))
    return names


def test_names_are_coloured_by_their_kind() -> None:
    document, _, _ = open_text(TEXT)
    names = decode_tokens(document, tokens(document, "utf-16"))
    for expected in (
        ("door", "enumMember", {"declaration"}),
        ("most", "variable", {"declaration", "readonly"}),
        ("noise", "property", {"declaration"}),
        ("calm", "function", {"declaration"}),
        ("limit_of", "parameter", {"declaration"}),
        ("limit_of", "parameter", set()),
        ("near", "function", {"defaultLibrary"}),
        ("leave", "class", {"declaration"}),
        ("place", "parameter", {"declaration"}),
        ("place", "parameter", set()),
        ("most", "variable", {"readonly"}),
        ("leave", "class", set()),
    ):
        assert expected in names
    assert len(names) == len(document.names)


def test_blocks_statements_comments_and_imports_fold() -> None:
    document, _, _ = open_text(TEXT)
    lines = TEXT.splitlines()
    folded = [(lines[fold.start_line], lines[fold.end_line], fold.kind) for fold in folds(document)]
    assert folded == [
        ("import stealth", "import core as c", types.FoldingRangeKind.Imports),
        ("// One door,", "// and a switch.", types.FoldingRangeKind.Comment),
        ("let calm(limit_of, x: entity) =", "    and not near(x)", None),
        ("spec leave {", "    require calm(most, door)", None),
        ("    reach all place in (s1, door): near(place)", "        then near(door)", None),
        ('test "t" for leave {', "    expect pending", None),
    ]


def test_the_valid_part_of_a_broken_text_folds() -> None:
    document, _, _ = open_text(TEXT.replace("entity s1", "entity (s1"))
    assert document.is_broken
    assert len(folds(document)) == 6


def test_symbols_are_found_by_their_letters() -> None:
    document, _, _ = open_text(TEXT)
    assert [symbol.name for symbol in matching_symbols(document, "LV", "utf-16", "")] == ["leave"]
    assert [symbol.name for symbol in matching_symbols(document, "", "utf-16", "")] == [
        *("s1", "door", "most", "noise", "calm", "leave", "t"),
    ]


def test_an_editor_gets_tokens_folds_links_and_symbols(client: Client, tmp_path: Path) -> None:
    (tmp_path / "common.tltl").write_text("signal loud: bool\n", encoding="utf-8")
    text = 'import "common.tltl"\nspec hush {\n    keep not loud\n}\n'
    uri = client.open(tmp_path / "main.tltl", text)
    here = {"textDocument": {"uri": uri}}
    assert client.capabilities["semanticTokensProvider"]["legend"]["tokenTypes"] == LEGEND.token_types
    assert client.ask("textDocument/semanticTokens/full", here)["data"] == [1, 5, 4, 4, 1, 1, 13, 4, 0, 0]
    assert client.ask("textDocument/foldingRange", here) == [{"startLine": 1, "endLine": 2}]
    (link,) = client.ask("textDocument/documentLink", here)
    assert link["target"] == (tmp_path / "common.tltl").as_uri()
    assert link["range"] == {"start": {"line": 0, "character": 7}, "end": {"line": 0, "character": 20}}
    assert [symbol["name"] for symbol in client.ask("workspace/symbol", {"query": "u"})] == ["hush", "loud"]


def test_every_name_of_the_examples_has_a_colour() -> None:
    for path in EXAMPLES:
        document, _, _ = open_text(path.read_text(encoding="utf-8"), path.parent)
        names = decode_tokens(document, tokens(document, "utf-16"))
        assert [name for name, _, _ in names] == [occurrence.symbol.name for occurrence in document.names]


TIMES = """\
signal a: bool
let soon = eventually within 150 ms a
spec s {
    limit 1 min
    reach a
    require always (not a implies F[1 s, 30] a) and next after 0.05 s a and G[5, 20] a
}
"""


def hints_with_units(document: Document, span: Span) -> list[tuple[str, str]]:
    """Return the hints in a part of a document, each with the unit before it."""
    units_and_labels = []
    for hint in hints(document, span, "utf-16"):
        before = document.source.text[: offset(document.source, hint.position)]
        units_and_labels.append((before.split()[-1], str(hint.label)))
    return units_and_labels


def test_times_are_shown_in_steps() -> None:
    document, _, _ = open_text(f"clock 20 Hz\n{TIMES}")
    whole = Span(0, len(document.source.text))
    assert hints_with_units(document, whole) == [
        ("ms", "= 3 steps"),
        ("min", "= 1200 steps"),
        ("s", "= 20 steps"),
        ("s", "= 1 step"),
    ]
    limit = document.source.text.index("limit")
    assert hints_with_units(document, Span(limit, limit + 12)) == [("min", "= 1200 steps")]
    without_clock, _, _ = open_text(TIMES)
    assert hints_with_units(without_clock, whole) == []


def test_the_client_finds_diagnostics_that_came_before_an_answer(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "plan.tltl", "signal a: boolean")
    client.message("textDocument/publishDiagnostics")
    assert client.ask("workspace/symbol", {"query": "a"})
    assert client.diagnostics(uri, bool)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_named_pipe_blocks_nothing(client: Client, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.tltl")
    (tmp_path / "link.tltl").symlink_to("pipe.tltl")
    (tmp_path / "plain.tltl").write_text("signal noise: ratio\n", encoding="utf-8")
    assert [symbol["name"] for symbol in client.ask("workspace/symbol", {"query": "n"})] == ["noise"]
    for name in ("pipe.tltl", "link.tltl"):
        uri = (tmp_path / name).as_uri()
        assert client.ask("textDocument/documentSymbol", {"textDocument": {"uri": uri}}) is None
    # A document opened in the editor is an ordinary text, whatever its file is.
    uri = client.open(tmp_path / "pipe.tltl", 'import "link.tltl"\nsignal noisy: bool\n')
    assert [symbol["name"] for symbol in client.ask("workspace/symbol", {"query": "noisy"})] == ["noisy"]
    (diagnostic,) = client.diagnostics(uri, bool)
    assert "link.tltl" in diagnostic["message"]
