"""Results that are kept while a text is being edited, and work that is not repeated."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.lsp.client import Client
from tests.interfaces.lsp.test_server import SPEC, codes
from tests.interfaces.lsp.texts import ENDLESS, open_text
from tltlc.interfaces.lsp.previous_diagnostics import previous_diagnostics
from tltlc.interfaces.lsp.slow_analysis import Request, analyse

END = {"line": 9, "character": 0}
IDLE = "spec idle = G (alive or not alive)\n"


def titles(client: Client, uri: str) -> list[str]:
    lenses = client.ask("textDocument/codeLens", {"textDocument": {"uri": uri}})
    return [lens["command"]["title"] for lens in lenses]


def test_lenses_and_diagnostics_stay_while_the_text_is_broken(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "leave.tltl", SPEC + IDLE)
    (before,) = client.diagnostics(uri, bool)
    lens_titles = titles(client, uri)
    assert lens_titles == ["4 states, distance 2", "1 test passes", "1 state, distance 0"]
    client.change(uri, "signal (\n" + SPEC + IDLE, 2)
    diagnostics = client.diagnostics(uri, lambda diagnostics: len(diagnostics) > 1)
    (after,) = (diagnostic for diagnostic in diagnostics if diagnostic["code"] == "TLT0411")
    assert after["range"]["start"]["line"] == before["range"]["start"]["line"] + 1
    assert titles(client, uri) == lens_titles
    # A diagnostic on edited code is dropped, since it may no longer be true.
    client.change(uri, SPEC + IDLE.replace("idle", "idler"), 3)
    assert client.diagnostics(uri, lambda diagnostics: not diagnostics) == []
    assert codes(client.diagnostics(uri, bool)) == ["TLT0411"]


def test_a_diagnostic_moves_with_its_words() -> None:
    text = "signal a: bool\nspec s = G (a or not a)\n// end\n"
    document, _, _ = open_text(text)
    analysis = analyse(Request(document.source, (), {}, {}))
    (diagnostic,) = analysis.diagnostics
    place = document.source.slice(diagnostic.labels[0].span)
    for edited in ("// é\r\n" + text, text + "spec t = ", text.replace("bool", "ratio"), text):
        now, _, _ = open_text(edited)
        (moved,) = previous_diagnostics(document, analysis, now)
        assert moved.labels[0].source == now.source
        assert now.source.slice(moved.labels[0].span) == place
    for edited in (text.replace("s =", "st ="), text.replace("spec s", "spec  s"), ""):
        now, _, _ = open_text(edited)
        assert previous_diagnostics(document, analysis, now) == ()


def test_saving_an_open_file_publishes_nothing(client: Client, tmp_path: Path) -> None:
    common = tmp_path / "common.tltl"
    common.write_text("signal loud: bool\n", encoding="utf-8")
    uri = client.open(common, "signal loud: bool\n")
    main = client.open(tmp_path / "main.tltl", 'import "common.tltl"\nspec hush = G not loud\n')
    client.diagnostics(uri)
    client.diagnostics(main)
    client.diagnostics(main)
    while len(client.published(uri)) < 2:
        client.diagnostics(uri)
    assert titles(client, main) == ["2 states, distance 0"]
    common.write_text("signal loud: bool\n\n", encoding="utf-8")
    before = client.published(uri), client.published(main)
    client.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": uri, "type": 2}]})
    # Diagnostics of a document that is opened now would arrive after any that were published for the others.
    other = client.open(tmp_path / "other.tltl", IDLE.replace("alive", "true"))
    assert codes(client.diagnostics(other, bool)) == ["TLT0411"]
    assert (client.published(uri), client.published(main)) == before


def test_a_changed_file_affects_only_its_importers(client: Client, tmp_path: Path) -> None:
    main = client.open(tmp_path / "main.tltl", 'import "common.tltl"\nspec hush = quiet\n')
    other = client.open(tmp_path / "other.tltl", "signal a: bool\nspec s = F a\n")
    assert codes(client.diagnostics(main, bool)) == ["TLT0010"]
    client.diagnostics(other)
    client.diagnostics(other)
    (tmp_path / "common.tltl").write_text("signal loud: bool\nlet quiet = G !loud\n", encoding="utf-8")
    client.tell(
        "workspace/didChangeWatchedFiles", {"changes": [{"uri": (tmp_path / "common.tltl").as_uri(), "type": 1}]}
    )
    assert client.diagnostics(main, lambda diagnostics: not diagnostics) == []
    assert len(client.published(other)) == 2


def test_a_renamed_folder_affects_its_importers(client: Client, tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared" / "common.tltl").write_text("signal loud: bool\n", encoding="utf-8")
    main = client.open(tmp_path / "main.tltl", 'import "shared/common.tltl"\nspec hush = G !loud\n')
    assert client.diagnostics(main) == []
    (tmp_path / "shared").rename(tmp_path / "common")
    files = [{"oldUri": (tmp_path / "shared").as_uri(), "newUri": (tmp_path / "common").as_uri()}]
    client.tell("workspace/didRenameFiles", {"files": files})
    assert codes(client.diagnostics(main, bool)) == ["TLT0010"]
    (tmp_path / "common").rename(tmp_path / "shared")
    client.tell("workspace/didDeleteFiles", {"files": [{"uri": (tmp_path / "common").as_uri()}]})
    assert client.diagnostics(main, lambda diagnostics: not diagnostics) == []


def test_project_files_of_several_folders_are_independent(client: Client, tmp_path: Path) -> None:
    """An error in one project file stays, whatever is changed beside another one."""
    (tmp_path / "inner").mkdir()
    outer = tmp_path / "tltl.toml"
    outer.write_text("libaries = []\n", encoding="utf-8")
    (tmp_path / "inner" / "tltl.toml").write_text("", encoding="utf-8")
    client.open(tmp_path / "a.tltl", "signal a: bool\n")
    assert codes(client.diagnostics(outer.as_uri())) == ["TLT0702"]
    inner = client.open(tmp_path / "inner" / "b.tltl", "signal b: bool\n")
    client.diagnostics(inner)
    client.change(inner, "signal c: bool\n")
    client.diagnostics(inner)
    assert [codes(diagnostics) for diagnostics in client.published(outer.as_uri())] == [["TLT0702"]]
    outer.unlink()
    client.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": outer.as_uri(), "type": 3}]})
    assert client.diagnostics(outer.as_uri()) == []


def test_edits_name_the_version_of_their_document(tmp_path: Path) -> None:
    client = Client(tmp_path, workspace={"workspaceEdit": {"documentChanges": True}})
    (tmp_path / "common.tltl").write_text("signal loud: bool\n", encoding="utf-8")
    text = 'import "common.tltl"\nspec hush = G !loud\n'
    uri = client.open(tmp_path / "main.tltl", text)
    client.change(uri, text + "\n", 7)
    changes = client.at("rename", uri, text, "loud", newName="noisy")["documentChanges"]
    assert sorted(
        (change["textDocument"]["uri"].rpartition("/")[2], change["textDocument"]["version"]) for change in changes
    ) == [
        ("common.tltl", None),
        ("main.tltl", 7),
    ]
    client.change(uri, text.replace("loud", "luod"), 8)
    (diagnostic,) = client.diagnostics(uri, bool)
    params = {"textDocument": {"uri": uri}, "range": diagnostic["range"], "context": {"diagnostics": [diagnostic]}}
    (action,) = client.ask("textDocument/codeAction", params)
    (change,) = action["edit"]["documentChanges"]
    assert (change["textDocument"]["version"], change["edits"][0]["newText"]) == (8, "loud")
    params["context"]["only"] = ["source.fixAll"]
    assert client.ask("textDocument/codeAction", params) is None
    params["context"]["only"] = ["quickfix"]
    assert len(client.ask("textDocument/codeAction", params)) == 1
    assert client.close() == 0


def test_added_folders_are_searched(client: Client, tmp_path: Path) -> None:
    added = tmp_path.parent / f"{tmp_path.name}_added"
    added.mkdir()
    (tmp_path / "common.tltl").write_text("signal loud: bool\n", encoding="utf-8")
    text = f'import "../{tmp_path.name}/common.tltl"\nspec hush = G !loud\n'
    (added / "main.tltl").write_text(text, encoding="utf-8")
    uri = client.open(tmp_path / "common.tltl", "signal loud: bool\n")
    assert set(client.at("rename", uri, "signal loud: bool\n", "loud", newName="noisy")["changes"]) == {uri}
    folder = {"uri": added.as_uri(), "name": "added"}
    client.tell("workspace/didChangeWorkspaceFolders", {"event": {"added": [folder], "removed": []}})
    changes = client.at("rename", uri, "signal loud: bool\n", "loud", newName="noisy")["changes"]
    assert set(changes) == {uri, (added / "main.tltl").as_uri()}
    client.tell("workspace/didChangeWorkspaceFolders", {"event": {"added": [], "removed": [folder]}})
    assert set(client.at("rename", uri, "signal loud: bool\n", "loud", newName="noisy")["changes"]) == {uri}


def test_tests_that_could_not_run_are_reported(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "leave.tltl", SPEC)
    request = {"command": "tltlc.runTests", "arguments": [uri, "leave"]}
    client.start("workspace/executeCommand", request)
    client.change(uri, SPEC + "\n", 2)
    text = client.message("window/showMessage")["message"]
    assert text == "the tests of `leave` did not run: a text changed, or its automata take more than 60 s"


@pytest.mark.slow
def test_a_long_analysis_gives_way_to_the_edited_document(client: Client, tmp_path: Path) -> None:
    slow = client.open(tmp_path / "slow.tltl", ENDLESS)
    assert client.diagnostics(slow) == []
    uri = client.open(tmp_path / "main.tltl", "signal a: bool\n")
    assert client.diagnostics(uri) == []
    assert client.diagnostics(uri) == []
    for version in (2, 3):
        # It starts again after each analysis to which it gave way.
        client.wait_for_analyses(version - 1)
        client.change(uri, f"signal a{version}: bool\nspec s = G (a{version} or not a{version})\n", version)
        assert client.diagnostics(uri) == []
        assert codes(client.diagnostics(uri)) == ["TLT0411"]
    text = "signal a: bool\nspec t = G (a or not a)\n"
    client.change(slow, text, 2)
    assert codes(client.diagnostics(slow, bool)) == ["TLT0411"]


def test_hints_follow_the_clock_of_another_file(tmp_path: Path) -> None:
    client = Client(tmp_path, workspace={"inlayHint": {"refreshSupport": True}})
    common = client.open(tmp_path / "common.tltl", "clock 20 Hz\nsignal a: bool\n")
    main = client.open(tmp_path / "main.tltl", 'import "common.tltl"\nspec s = F within 2 s a\n')
    params = {"textDocument": {"uri": main}, "range": {"start": {"line": 0, "character": 0}, "end": END}}

    def hints() -> list[tuple[int, str]]:
        return [(hint["position"]["character"], hint["label"]) for hint in client.ask("textDocument/inlayHint", params)]

    def wait_for_refresh() -> None:
        client._next(lambda message: message.get("method") == "workspace/inlayHint/refresh")

    assert hints() == [(21, "= 40 steps")]
    wait_for_refresh()
    wait_for_refresh()
    client.change(common, "clock 10 Hz\nsignal a: bool\n")
    wait_for_refresh()
    assert hints() == [(21, "= 20 steps")]
    assert client.close() == 0
