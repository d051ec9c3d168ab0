"""Neovim with the settings of the guide, from the first key to the end of all processes."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.editors.neovim import PROGRAM, Neovim
from tests.editors.test_grammar import SOURCES
from tests.waiting import HANG_S, until
from tltlc.core.source import SourceFile
from tltlc.grammar.keywords import CLAUSES, DECLARATIONS
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.tables import load

pytest.importorskip("pygls", reason="the extra `lsp` is not installed")
pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="Neovim, `nvim`, is not installed"),
    pytest.mark.skipif(sys.platform == "win32", reason="what stands in for `tltlc` is a shell script"),
]

COMMON = """\
import stealth
entity s1, exit
let leave = eventually near(exit)
"""
MAIN = """\
import "common.tltl"

/// The switch, then the exit.
spec escape {
    limit 400 steps
    reach near(s1)
    require leave
    keep alive
}

test "in order" for escape {
    step alive, near(s1)
    step alive, near(exit)
    expect holding
}
"""


@pytest.fixture
def editor(tmp_path: Path) -> Iterator[Neovim]:
    folder = tmp_path / "game"
    folder.mkdir()
    (folder / "tltl.toml").touch()
    (folder / "common.tltl").write_text(COMMON, encoding="utf-8")
    (folder / "main.tltl").write_text(MAIN, encoding="utf-8")
    started = Neovim(tmp_path / "home", folder)
    yield started
    started.end()


@pytest.mark.slow
def test_an_editing_session_works_from_its_first_to_its_last_key(editor: Neovim) -> None:
    editor.keys(":edit main.tltl<CR>")
    editor.until(lambda: editor.lua("vim.bo.filetype") == "tltl", "the file")
    lenses = editor.until(lambda: wait_for_lenses(editor), "lenses")
    assert [lens["command"]["title"] for lens in lenses] == ["5 states, distance 1", "1 test passes"]

    # A misspelt word is marked while it is typed, and a quick fix corrects it.
    editor.keys(":lua vim.ui.select = function(items, _, choose) choose(items[1], 1) end<CR>")
    editor.keys("/near(s1)<CR>cwneer<Esc>")
    messages = editor.until(editor.diagnostics, "a diagnostic")
    assert messages == ["no predicate `neer` here: did you mean `near` (from common.tltl)?"]
    editor.keys(":lua vim.lsp.buf.code_action()<CR>")
    editor.until(lambda: editor.lines() == MAIN.splitlines(), "the quick fix")
    editor.until(lambda: not editor.diagnostics(), "no diagnostic")

    # Completion offers the names that are known at the cursor.
    editor.keys("/keep<CR>oavoid see<C-x><C-o>")
    menu = editor.until(lambda: editor.lua('vim.fn.complete_info({"items"}).items'), "names")
    assert "seen" in [item["word"] for item in menu]
    editor.keys("<C-e><Esc>u")

    editor.keys("/near(s1)<CR>:lua vim.lsp.buf.hover()<CR>")
    hover_text = editor.until(lambda: floating_text(editor), "what a name means")
    assert "Closeness to `target`" in hover_text

    # Rename a symbol in both files.
    editor.keys('/leave<CR>:lua vim.lsp.buf.rename("get_out")<CR>')
    editor.until(lambda: "    require get_out" in editor.lines(), "the new name")
    editor.keys(":silent wall<CR>:edit common.tltl<CR>")
    editor.until(lambda: "let get_out = eventually near(exit)" in editor.lines(), "the other file")
    editor.keys(":edit main.tltl<CR>")

    editor.keys("/alive<CR>Oavoid    seen<Esc>:lua (vim.lsp.buf.format or vim.lsp.buf.formatting_sync)()<CR>")
    editor.until(lambda: "    avoid seen" in editor.lines(), "the layout")

    editor.keys(":write<CR>/near(s1)<CR>:lua vim.lsp.buf.definition()<CR>")
    editor.until(lambda: editor.lua("vim.api.nvim_buf_get_name(0)").endswith("spatial.tltl"), "the library")
    editor.until(lambda: editor.lua("vim.api.nvim_get_current_line()").startswith("predicate near("), "its line")

    editor.keys(":qall!<CR>")
    assert editor.process.wait(timeout=HANG_S) == 0
    assert "Error" not in editor.errors()
    assert_all_processes_ended(editor)


def test_a_killed_editor_ends_the_server(editor: Neovim) -> None:
    editor.keys(":edit main.tltl<CR>")
    editor.until(lambda: wait_for_lenses(editor), "lenses")
    editor.process.kill()
    editor.process.wait()
    assert_all_processes_ended(editor)


def test_words_have_their_colours(editor: Neovim) -> None:
    for path in SOURCES:
        editor.keys(f":edit! {path}<CR>")
        editor.until(lambda: editor.lua("vim.api.nvim_buf_get_name(0)") == str(path), path.name)  # noqa: B023
        # The groups are queried column by column, as they are drawn: a unit depends on the number before it.
        groups = editor.lua(
            "vim.tbl_map(function(line) return vim.tbl_map("
            "function(column) return vim.fn.synIDattr(vim.fn.synID(line, column, 1), 'name') end,"
            " vim.fn.range(1, #vim.fn.getline(line))) end, vim.fn.range(1, vim.fn.line('$')))"
        )
        text = path.read_text(encoding="utf-8")
        source = SourceFile(path.name, text)
        for token in tokenize(text).tokens[:-1]:
            if token.type != "NAME" and token.text not in load().soft:
                line, column = source.position(token.start)
                before = source.line(line)[: column - 1]
                group = groups[line - 1][len(before.encode())]
                assert group in GROUPS.get(token.type, ("tltlOperator",)), (path.name, line, token.text)


GROUPS = {
    **dict.fromkeys(map(str.upper, DECLARATIONS), ("tltlDeclaration",)),
    **dict.fromkeys([*map(str.upper, CLAUSES), "ALL", "ANY", "WHEN", "OTHERWISE"], ("tltlClause",)),
    **dict.fromkeys(["TRUE", "FALSE"], ("tltlConstant",)),
    **dict.fromkeys(["COLON", "COMMA", "LPAR", "RPAR", "LBRACE", "RBRACE", "LSQB", "RSQB"], ("",)),
    "NUMBER": ("tltlNumber",),
    "UNIT": ("tltlUnit",),
    "STRING": ("tltlString",),
}
"""The highlight groups of each terminal. All other terminals are operators."""


def wait_for_lenses(editor: Neovim) -> object:
    # If the lenses are requested before the client is initialized, some versions never ask again.
    if not editor.lua("#vim.tbl_filter(function(client) return client.initialized end, vim.lsp.get_active_clients())"):
        return None
    editor.keys(":lua vim.lsp.codelens.refresh()<CR>")
    return editor.lua("vim.lsp.codelens.get(vim.api.nvim_get_current_buf())")


def floating_text(editor: Neovim) -> str:
    """The text of the floating window, if there is one."""
    lines: list[str] = editor.lua(
        "vim.tbl_flatten(vim.tbl_map(function(window) return vim.api.nvim_win_get_config(window).relative ~= ''"
        " and vim.api.nvim_buf_get_lines(vim.api.nvim_win_get_buf(window), 0, -1, true) or {} end,"
        " vim.api.nvim_list_wins()))"
    )
    return "\n".join(lines)


def assert_all_processes_ended(editor: Neovim) -> None:
    until(lambda: not editor.running_processes(), "the end of all processes that Neovim started")
