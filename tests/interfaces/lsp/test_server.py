"""The server as a process, over its standard input and output."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from tests.interfaces.lsp.client import Client, RefusedError, place
from tests.interfaces.lsp.test_fuzz import random_edit
from tests.interfaces.lsp.texts import ENDLESS, EXAMPLES

SPEC = """\
import stealth
entity s1, exit

/// The switch, then the exit.
spec leave {
    limit 400 steps
    reach near(s1) then near(exit)
    keep alive
}

test "in order" for leave {
    step alive, near(s1)
    step alive, near(exit)
    expect holding
}
"""


def codes(diagnostics: list[dict[str, object]]) -> list[object]:
    return [diagnostic["code"] for diagnostic in diagnostics]


def test_a_diagnostic_is_fixed_by_its_action(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "leave.tltl", SPEC)
    assert client.diagnostics(uri) == []
    client.change(uri, SPEC.replace("near(exit)", "neer(exit)", 1), 2)
    (diagnostic,) = client.diagnostics(uri, bool)
    assert diagnostic["code"] == "TLT0201"
    assert diagnostic["range"] == {"start": {"line": 6, "character": 24}, "end": {"line": 6, "character": 28}}
    assert "did you mean `near`" in diagnostic["message"]
    params = {"textDocument": {"uri": uri}, "range": diagnostic["range"], "context": {"diagnostics": [diagnostic]}}
    (action,) = client.ask("textDocument/codeAction", params)
    assert action["title"] == "Write `near`"
    (edit,) = action["edit"]["changes"][uri]
    assert (edit["range"], edit["newText"]) == (diagnostic["range"], "near")
    client.change(uri, SPEC, 3)
    assert client.diagnostics(uri, lambda diagnostic: not diagnostic) == []
    assert client.close() == 0


def test_automata_and_tests_are_reported_later(client: Client, tmp_path: Path) -> None:
    text = SPEC.replace("expect holding", "expect violated") + "spec idle = G (alive or not alive)\n"
    uri = client.open(tmp_path / "leave.tltl", text)
    diagnostics = client.diagnostics(uri, lambda diagnostics: "TLT0640" in codes(diagnostics))
    assert "TLT0411" in codes(diagnostics)
    lenses = client.ask("textDocument/codeLens", {"textDocument": {"uri": uri}})
    assert [lens["command"]["title"] for lens in lenses] == [
        "4 states, distance 2",
        "1 of 1 test fails",
        "1 state, distance 0",
    ]
    client.ask(
        "workspace/executeCommand", {"command": "tltlc.runTests", "arguments": lenses[1]["command"]["arguments"]}
    )
    assert client.message("window/showMessage")["message"] == "leave: 1 of 1 test fails"
    hover = client.at("hover", uri, text, "leave {")
    assert "4 states, distance 2." in hover["contents"]["value"]


def test_fixes_of_rules_are_offered(client: Client, tmp_path: Path) -> None:
    text = SPEC.replace("    keep alive\n", "    keep alive\n    keep alive\n")
    uri = client.open(tmp_path / "leave.tltl", text)
    diagnostic = next(candidate for candidate in client.diagnostics(uri, bool) if candidate["code"] == "TLT0425")
    params = {"textDocument": {"uri": uri}, "range": diagnostic["range"], "context": {"diagnostics": [diagnostic]}}
    (action,) = client.ask("textDocument/codeAction", params)
    (edit,) = action["edit"]["changes"][uri]
    assert edit["newText"] == ""
    assert edit["range"]["start"]["line"] in (7, 8)


def test_unsaved_texts_count_where_they_are_imported(client: Client, tmp_path: Path) -> None:
    (tmp_path / "common.tltl").write_text("signal loud: bool\nlet quiet = G !loud\n", encoding="utf-8")
    main = client.open(tmp_path / "main.tltl", 'import "common.tltl"\nspec hush = quiet\n')
    assert client.diagnostics(main) == []
    common = client.open(tmp_path / "common.tltl", "signal loud: bool\nlet hushed = G !loud\n")
    assert codes(client.diagnostics(main, bool)) == ["TLT0201"]
    client.tell("textDocument/didClose", {"textDocument": {"uri": common}})
    assert client.diagnostics(main, lambda diagnostics: not diagnostics) == []
    place_of = client.ask(
        "textDocument/definition", {"textDocument": {"uri": main}, "position": {"line": 1, "character": 14}}
    )
    assert place_of == {
        "uri": common,
        "range": {"start": {"line": 1, "character": 4}, "end": {"line": 1, "character": 9}},
    }


def test_errors_in_an_imported_file_are_shown_at_the_import(client: Client, tmp_path: Path) -> None:
    (tmp_path / "common.tltl").write_text("signal loud: bol\n", encoding="utf-8")
    main = client.open(tmp_path / "main.tltl", 'import "common.tltl"\nspec hush = G !loud\n')
    diagnostic = client.diagnostics(main, bool)[0]
    assert diagnostic["range"]["start"] == {"line": 0, "character": 7}
    (related,) = diagnostic["relatedInformation"]
    assert related["location"]["uri"] == (tmp_path / "common.tltl").as_uri()
    assert related["location"]["range"]["start"] == {"line": 0, "character": 13}


def test_too_many_imported_names_are_an_error_at_the_import(client: Client, tmp_path: Path) -> None:
    for number in range(30):
        both = f"import m{number + 1} as x\nimport m{number + 1} as y\n"
        (tmp_path / f"m{number}.tltl").write_text(both, encoding="utf-8")
    (tmp_path / "m30.tltl").write_text("signal loud: bool\n", encoding="utf-8")
    main = client.open(tmp_path / "main.tltl", "import m0\nsignal a: bool\nspec hush = G !a\n")
    (diagnostic,) = client.diagnostics(main, bool)
    assert (diagnostic["code"], diagnostic["range"]["start"]) == ("TLT0012", {"line": 0, "character": 7})


def test_created_and_deleted_files_are_noticed(client: Client, tmp_path: Path) -> None:
    main = client.open(tmp_path / "main.tltl", 'import "common.tltl"\nspec hush = quiet\n')
    assert codes(client.diagnostics(main)) == ["TLT0010"]
    file = tmp_path / "common.tltl"
    file.write_text("signal loud: bool\nlet quiet = G !loud\n", encoding="utf-8")
    changes = {"changes": [{"uri": file.as_uri(), "type": 1}]}
    client.tell("workspace/didChangeWatchedFiles", changes)
    assert client.diagnostics(main, lambda diagnostics: not diagnostics) == []
    file.unlink()
    client.tell("workspace/didChangeWatchedFiles", changes)
    assert codes(client.diagnostics(main, bool)) == ["TLT0010"]


def test_the_project_file_applies(client: Client, tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    (tmp_path / "shared" / "common.tltl").write_text("signal loud: bool\n", encoding="utf-8")
    project = tmp_path / "tltl.toml"
    project.write_text('libraries = ["shared"]\n[style]\nformatting = "letters"\n', encoding="utf-8")
    main = client.open(tmp_path / "main.tltl", "import common\nspec hush = always not loud\n")
    assert client.diagnostics(main) == []
    request = {"textDocument": {"uri": main}, "options": {"tabSize": 4, "insertSpaces": True}}
    (edit,) = client.ask("textDocument/formatting", request)
    assert edit["newText"] == "G !"
    project.write_text('libaries = ["shared"]\n', encoding="utf-8")
    client.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": project.as_uri(), "type": 2}]})
    assert codes(client.diagnostics(project.as_uri(), bool)) == ["TLT0702"]
    project.write_text('libraries = ["shared"]\n', encoding="utf-8")
    client.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": project.as_uri(), "type": 2}]})
    assert client.diagnostics(project.as_uri()) == []


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
def test_characters_beyond_the_bmp_have_correct_positions(encoding: str, tmp_path: Path) -> None:
    client = Client(tmp_path, encodings=(encoding,))
    assert client.capabilities["positionEncoding"] == encoding
    text = "signal a: bool\nspec s = a 𝒰 (a 𝒰 neer)\n"
    uri = client.open(tmp_path / "a.tltl", text)
    (diagnostic,) = client.diagnostics(uri)
    start = text.index("neer")
    assert diagnostic["range"] == {"start": place(text, start, encoding), "end": place(text, start + 4, encoding)}
    second = {"textDocument": {"uri": uri}, "position": place(text, text.index("a 𝒰 neer"), encoding)}
    assert client.ask("textDocument/hover", second)["range"]["start"] == second["position"]
    assert client.close() == 0


def test_windows_line_ends_are_kept(client: Client, tmp_path: Path) -> None:
    text = SPEC.replace("keep alive", "keep alive and neer").replace("\n", "\r\n")
    uri = client.open(tmp_path / "leave.tltl", text)
    (diagnostic,) = client.diagnostics(uri)
    assert diagnostic["range"]["start"] == {"line": 7, "character": 19}
    client.change(uri, "signal a:bool\r\nspec s=G a\r\n")
    request = {"textDocument": {"uri": uri}, "options": {"tabSize": 4, "insertSpaces": True}}
    (edit,) = client.ask("textDocument/formatting", request)
    assert "\r\n" in edit["newText"]


def test_unsaved_documents_are_checked(client: Client) -> None:
    uri = client.open("untitled:Untitled-1", "import stealth\nspec hide = G hiden\n")
    (diagnostic,) = client.diagnostics(uri)
    assert "did you mean `hidden`" in diagnostic["message"]
    (main,) = client.ask("textDocument/documentSymbol", {"textDocument": {"uri": uri}})[1:]
    assert main["name"] == "hide"


def test_a_rejected_rename_has_a_readable_message(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "leave.tltl", SPEC)
    with pytest.raises(RefusedError, match=r"`near` is declared in .*spatial.tltl.* \(TLT0770\)"):
        client.at("rename", uri, SPEC, "near(s1) then", newName="close")
    changed = client.at("rename", uri, SPEC, "leave {", newName="flee")["changes"][uri]
    assert [edit["newText"] for edit in changed] == ["flee", "flee"]


def test_a_long_analysis_is_abandoned_when_the_text_changes(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "slow.tltl", ENDLESS)
    assert client.diagnostics(uri) == []
    client.wait_for_analyses()
    client.change(uri, "signal a: bool\nspec s = G (a or not a)\n", 2)
    assert codes(client.diagnostics(uri, bool)) == ["TLT0411"]
    assert client.close() == 0


def test_tests_run_on_demand_while_automata_are_built(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "leave.tltl", SPEC)
    request = {"command": "tltlc.runTests", "arguments": [uri, "leave"]}
    for _ in range(3):
        client.ask("workspace/executeCommand", request)
    assert client.message("window/showMessage")["message"] == "leave: 1 test passes"
    client.change(uri, SPEC.replace("keep alive", "keep alife"))
    client.ask("workspace/executeCommand", request)
    message = client.message("window/showMessage")["message"]
    assert message == "the tests of `leave` did not run: its file, or a file that it imports, has errors"


def test_fast_random_edits_end_in_the_same_state_as_a_new_server(client: Client, tmp_path: Path) -> None:
    """After random edits without pauses, the server gives the same results as a new server for the
    final text."""
    generator = random.Random(7)
    whole = EXAMPLES[0].read_text(encoding="utf-8")
    uri = client.open(tmp_path / "typed.tltl", whole)
    version = 1
    for _ in range(15):
        text = whole
        for _ in range(6):
            text, version = random_edit(text, generator), version + 1
            client.change(uri, text, version)
        at = place(text, generator.randint(0, len(text)))
        for method in ("hover", "completion", "definition"):
            client.ask(f"textDocument/{method}", {"textDocument": {"uri": uri}, "position": at})
    client.change(uri, whole.replace("reach", "raech", 1), version + 1)
    # Diagnostics for intermediate texts may come first.
    assert client.diagnostics(
        uri, lambda diagnostics: any("raech" in diagnostic["message"] for diagnostic in diagnostics)
    )
    final = f"{whole}spec idle = G (alive or not alive)\n"
    client.change(uri, final, version + 2)
    fresh = Client(tmp_path)
    assert fresh.open(tmp_path / "typed.tltl", final) == uri
    expected = fresh.diagnostics(uri, bool)
    assert codes(expected) == ["TLT0411"]
    assert client.diagnostics(uri, lambda diagnostics: diagnostics == expected)
    for method in ("semanticTokens/full", "documentSymbol", "foldingRange", "codeLens"):
        params = {"textDocument": {"uri": uri}}
        assert client.ask(f"textDocument/{method}", params) == fresh.ask(f"textDocument/{method}", params)
    assert fresh.close() == 0


def test_a_big_file_is_answered(client: Client, tmp_path: Path) -> None:
    uri = client.open(tmp_path / "big.tltl", "signal a: bool\n" * 90_000)
    assert codes(client.diagnostics(uri))
    client.change(uri, "signal a: bool\nspec s = G neer\n")
    assert codes(client.diagnostics(uri, lambda diagnostics: "TLT0201" in codes(diagnostics)))
