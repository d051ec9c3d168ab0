"""What helps to read a text: colours by what names stand for, folds, links, and names that are looked for."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from lsprotocol import types

from tests.interfaces.lsp.client import Client
from tests.interfaces.lsp.texts import EXAMPLES, opened
from tltlc.core.source import Span
from tltlc.interfaces.lsp.analysed_text import Document
from tltlc.interfaces.lsp.durations import hints
from tltlc.interfaces.lsp.folding import folds
from tltlc.interfaces.lsp.positions import offset
from tltlc.interfaces.lsp.symbols import found
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


def coloured(document: Document, numbers: list[int]) -> list[tuple[str, str, set[str]]]:
    """The names with their types and modifiers, as an editor reads the numbers."""
    names = []
    line = column = 0
    for at in range(0, len(numbers), 5):
        down, right, length, kind, bits = numbers[at : at + 5]
        line, column = line + down, (0 if down else column) + right
        start = offset(document.source, types.Position(line, column))
        modifiers = {each for bit, each in enumerate(LEGEND.token_modifiers) if bits >> bit & 1}
        names.append((document.source.text[start : start + length], LEGEND.token_types[kind], modifiers))
    return names


def test_names_are_coloured_by_what_they_stand_for() -> None:
    document, _, _ = opened(TEXT)
    names = coloured(document, tokens(document, "utf-16"))
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
    document, _, _ = opened(TEXT)
    lines = TEXT.splitlines()
    shown = [(lines[each.start_line], lines[each.end_line], each.kind) for each in folds(document)]
    assert shown == [
        ("import stealth", "import core as c", types.FoldingRangeKind.Imports),
        ("// One door,", "// and a switch.", types.FoldingRangeKind.Comment),
        ("let calm(limit_of, x: entity) =", "    and not near(x)", None),
        ("spec leave {", "    require calm(most, door)", None),
        ("    reach all place in (s1, door): near(place)", "        then near(door)", None),
        ('test "t" for leave {', "    expect pending", None),
    ]


def test_what_can_be_read_of_a_broken_text_folds() -> None:
    document, _, _ = opened(TEXT.replace("entity s1", "entity (s1"))
    assert document.is_broken
    assert len(folds(document)) == 6


def test_names_are_looked_for_by_their_letters() -> None:
    document, _, _ = opened(TEXT)
    assert [each.name for each in found(document, "LV", "utf-16", "")] == ["leave"]
    assert [each.name for each in found(document, "", "utf-16", "")] == [
        *("s1", "door", "most", "noise", "calm", "leave", "t"),
    ]


def test_an_editor_gets_them(client: Client, tmp_path: Path) -> None:
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
    assert [each["name"] for each in client.ask("workspace/symbol", {"query": "u"})] == ["hush", "loud"]


def test_every_name_of_the_examples_has_a_colour() -> None:
    for path in EXAMPLES:
        document, _, _ = opened(path.read_text(encoding="utf-8"), path.parent)
        names = coloured(document, tokens(document, "utf-16"))
        assert [name for name, _, _ in names] == [each.symbol.name for each in document.names]


TIMES = """\
signal a: bool
let soon = eventually within 150 ms a
spec s {
    limit 1 min
    reach a
    require always (not a implies F[1 s, 30] a) and next after 0.05 s a and G[5, 20] a
}
"""


def steps_behind(document: Document, span: Span) -> list[tuple[str, str]]:
    """The hints of a part of a document, and the unit in front of each."""
    found = []
    for hint in hints(document, span, "utf-16"):
        before = document.source.text[: offset(document.source, hint.position)]
        found.append((before.split()[-1], str(hint.label)))
    return found


def test_times_are_shown_in_steps() -> None:
    document, _, _ = opened(f"clock 20 Hz\n{TIMES}")
    whole = Span(0, len(document.source.text))
    assert steps_behind(document, whole) == [
        ("ms", "= 3 steps"),
        ("min", "= 1200 steps"),
        ("s", "= 20 steps"),
        ("s", "= 1 step"),
    ]
    limit = document.source.text.index("limit")
    assert steps_behind(document, Span(limit, limit + 12)) == [("min", "= 1200 steps")]
    without_clock, _, _ = opened(TIMES)
    assert steps_behind(without_clock, whole) == []


def test_the_client_of_these_tests_finds_diagnostics_that_came_before_an_answer(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "plan.tltl", "signal a: boolean")
    client.message("textDocument/publishDiagnostics")
    assert client.ask("workspace/symbol", {"query": "a"})
    assert client.diagnostics(uri, bool)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_a_named_pipe_keeps_nobody_waiting(client: Client, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.tltl")
    (tmp_path / "link.tltl").symlink_to("pipe.tltl")
    (tmp_path / "plain.tltl").write_text("signal noise: ratio\n", encoding="utf-8")
    assert [each["name"] for each in client.ask("workspace/symbol", {"query": "n"})] == ["noise"]
    for name in ("pipe.tltl", "link.tltl"):
        uri = (tmp_path / name).as_uri()
        assert client.ask("textDocument/documentSymbol", {"textDocument": {"uri": uri}}) is None
    # In the editor it is a text like any other.
    uri = client.open(tmp_path / "pipe.tltl", 'import "link.tltl"\nsignal noisy: bool\n')
    assert [each["name"] for each in client.ask("workspace/symbol", {"query": "noisy"})] == ["noisy"]
    (said,) = client.diagnostics(uri, bool)
    assert "link.tltl" in said["message"]
