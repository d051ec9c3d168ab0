"""What a keystroke costs: syntax and names of a file of 500 lines, beside a bare parse of it."""

from __future__ import annotations

from pathlib import Path

from tests.calls import calls
from tests.lsp.client import Client
from tltlc.grammar.parser import parse
from tltlc.lsp.paths import uri_of
from tltlc.lsp.remarks import remark
from tltlc.lsp.workspace import Workspace
from tltlc.source import SourceFile

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
"""Measured: 2.4."""


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
        assert [remark(each, document, "utf-16", uri_of) for each in document.said] == []

    keystroke()  # the libraries are read
    parse(SourceFile("many.tltl", TEXT))  # the tables of the grammar are read
    assert calls(keystroke) < MOST_PARSES * calls(lambda: parse(SourceFile("many.tltl", TEXT)))


def test_an_editor_gets_its_answers(client: Client, tmp_path: Path) -> None:
    """With the process, the protocol and the pause in which changes are gathered."""
    uri = client.open(tmp_path / "many.tltl", TEXT)
    client.diagnostics(uri)
    for version in range(2, 9):
        client.change(uri, TEXT + f"spec wrong{version} = neer\n", version)
        (said,) = client.diagnostics(uri, bool)
        assert "`neer`" in said["message"]
