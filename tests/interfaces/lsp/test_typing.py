"""What stays while a text is being written, and what is done again only where that is needed."""

from __future__ import annotations

from pathlib import Path

from tests.interfaces.lsp.client import Client
from tests.interfaces.lsp.test_server import SPEC, codes
from tests.interfaces.lsp.texts import ENDLESS, opened
from tltlc.interfaces.lsp.analysis import Request, analyse
from tltlc.interfaces.lsp.previous_diagnostics import kept

END = {"line": 9, "character": 0}
IDLE = "spec idle = G (alive or not alive)\n"


def titles(client: Client, uri: str) -> list[str]:
    lenses = client.ask("textDocument/codeLens", {"textDocument": {"uri": uri}})
    return [each["command"]["title"] for each in lenses]


def test_lenses_and_remarks_stay_while_the_text_is_broken(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "leave.tltl", SPEC + IDLE)
    (before,) = client.diagnostics(uri, bool)
    shown = titles(client, uri)
    assert shown == ["4 states, distance 2", "1 test passes", "1 state, distance 0"]
    client.change(uri, "signal (\n" + SPEC + IDLE, 2)
    found = client.diagnostics(uri, lambda found: len(found) > 1)
    (after,) = (each for each in found if each["code"] == "TLT0411")
    assert after["range"]["start"]["line"] == before["range"]["start"]["line"] + 1
    assert titles(client, uri) == shown
    # Of what is being edited, nothing is said that may not be so any more.
    client.change(uri, SPEC + IDLE.replace("idle", "idler"), 3)
    assert client.diagnostics(uri, lambda found: not found) == []
    assert codes(client.diagnostics(uri, bool)) == ["TLT0411"]


def test_a_remark_stays_with_its_words() -> None:
    text = "signal a: bool\nspec s = G (a or not a)\n// end\n"
    document, _, _ = opened(text)
    found = analyse(Request(document.source, (), {}, {}))
    (said,) = found.said
    place = document.source.slice(said.labels[0].span)
    for edited in ("// é\r\n" + text, text + "spec t = ", text.replace("bool", "ratio"), text):
        now, _, _ = opened(edited)
        (left,) = kept(document, found, now)
        assert left.labels[0].source == now.source
        assert now.source.slice(left.labels[0].span) == place
    for edited in (text.replace("s =", "st ="), text.replace("spec s", "spec  s"), ""):
        now, _, _ = opened(edited)
        assert kept(document, found, now) == ()


def test_a_file_that_is_saved_is_looked_at_no_more(client: Client, tmp_path: Path) -> None:
    common = tmp_path / "common.tltl"
    common.write_text("signal loud: bool\n", encoding="utf-8")
    uri = client.open(common, "signal loud: bool\n")
    main = client.open(tmp_path / "main.tltl", 'import "common.tltl"\nspec hush = G not loud\n')
    client.diagnostics(uri)
    client.diagnostics(main)
    client.diagnostics(main)
    while len(client.said_of(uri)) < 2:
        client.diagnostics(uri)
    assert titles(client, main) == ["2 states, distance 0"]
    common.write_text("signal loud: bool\n\n", encoding="utf-8")
    before = client.said_of(uri), client.said_of(main)
    client.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": uri, "type": 2}]})
    # What is said of a document that is opened after that comes behind what would be said of these.
    other = client.open(tmp_path / "other.tltl", IDLE.replace("alive", "true"))
    assert codes(client.diagnostics(other, bool)) == ["TLT0411"]
    assert (client.said_of(uri), client.said_of(main)) == before


def test_changes_of_files_matter_to_those_that_are_made_of_them(client: Client, tmp_path: Path) -> None:
    main = client.open(tmp_path / "main.tltl", 'import "common.tltl"\nspec hush = quiet\n')
    other = client.open(tmp_path / "other.tltl", "signal a: bool\nspec s = F a\n")
    assert codes(client.diagnostics(main, bool)) == ["TLT0010"]
    client.diagnostics(other)
    client.diagnostics(other)
    (tmp_path / "common.tltl").write_text("signal loud: bool\nlet quiet = G !loud\n", encoding="utf-8")
    client.tell(
        "workspace/didChangeWatchedFiles", {"changes": [{"uri": (tmp_path / "common.tltl").as_uri(), "type": 1}]}
    )
    assert client.diagnostics(main, lambda found: not found) == []
    assert len(client.said_of(other)) == 2


def test_a_folder_with_an_imported_file_is_renamed(client: Client, tmp_path: Path) -> None:
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
    assert client.diagnostics(main, lambda found: not found) == []


def test_project_files_of_several_folders(client: Client, tmp_path: Path) -> None:
    """One that is wrong stays so, whatever is written beside another one."""
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
    assert [codes(each) for each in client.said_of(outer.as_uri())] == [["TLT0702"]]
    outer.unlink()
    client.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": outer.as_uri(), "type": 3}]})
    assert client.diagnostics(outer.as_uri()) == []


def test_edits_are_for_the_version_that_they_were_made_for(tmp_path: Path) -> None:
    client = Client(tmp_path, workspace={"workspaceEdit": {"documentChanges": True}})
    (tmp_path / "common.tltl").write_text("signal loud: bool\n", encoding="utf-8")
    text = 'import "common.tltl"\nspec hush = G !loud\n'
    uri = client.open(tmp_path / "main.tltl", text)
    client.change(uri, text + "\n", 7)
    changes = client.at("rename", uri, text, "loud", newName="noisy")["documentChanges"]
    assert sorted(
        (each["textDocument"]["uri"].rpartition("/")[2], each["textDocument"]["version"]) for each in changes
    ) == [
        ("common.tltl", None),
        ("main.tltl", 7),
    ]
    client.change(uri, text.replace("loud", "luod"), 8)
    (found,) = client.diagnostics(uri, bool)
    where = {"textDocument": {"uri": uri}, "range": found["range"], "context": {"diagnostics": [found]}}
    (action,) = client.ask("textDocument/codeAction", where)
    (change,) = action["edit"]["documentChanges"]
    assert (change["textDocument"]["version"], change["edits"][0]["newText"]) == (8, "loud")
    where["context"]["only"] = ["source.fixAll"]
    assert client.ask("textDocument/codeAction", where) is None
    where["context"]["only"] = ["quickfix"]
    assert len(client.ask("textDocument/codeAction", where)) == 1
    assert client.close() == 0


def test_folders_that_are_added_are_looked_through(client: Client, tmp_path: Path) -> None:
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


def test_tests_that_could_not_run(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "leave.tltl", SPEC)
    request = {"command": "tltlc.runTests", "arguments": [uri, "leave"]}
    client.start("workspace/executeCommand", request)
    client.change(uri, SPEC + "\n", 2)
    text = client.message("window/showMessage")["message"]
    assert text == "the tests of `leave` did not run: a text changed, or its automata take over 60 s"


def test_what_takes_long_gives_way_to_what_is_being_written(client: Client, tmp_path: Path) -> None:
    slow = client.open(tmp_path / "slow.tltl", ENDLESS)
    assert client.diagnostics(slow) == []
    uri = client.open(tmp_path / "main.tltl", "signal a: bool\n")
    assert client.diagnostics(uri) == []
    assert client.diagnostics(uri) == []
    for version in (2, 3):
        # It is begun anew after each analysis that it gave way to.
        client.until_it_analyses(version - 1)
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
    asked = {"textDocument": {"uri": main}, "range": {"start": {"line": 0, "character": 0}, "end": END}}

    def hints() -> list[tuple[int, str]]:
        return [(each["position"]["character"], each["label"]) for each in client.ask("textDocument/inlayHint", asked)]

    def refreshed() -> None:
        client._next(lambda message: message.get("method") == "workspace/inlayHint/refresh")

    assert hints() == [(21, "= 40 steps")]
    refreshed()
    refreshed()
    client.change(common, "clock 10 Hz\nsignal a: bool\n")
    refreshed()
    assert hints() == [(21, "= 20 steps")]
    assert client.close() == 0
