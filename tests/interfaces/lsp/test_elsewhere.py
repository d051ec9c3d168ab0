"""What other files use is not unused: the editor says what `tltlc lint` says."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.lsp.client import Client
from tltlc.core.source import SourceFile
from tltlc.interfaces.cli.main import main
from tltlc.interfaces.lsp.analysis import Request, analyse

LIBRARY = """\
signal loud: bool
signal dark: bool
let hushed = G not loud
spec own = F dark
"""
MAIN = 'import "library.tltl"\nspec hush = hushed\n'


def unused(found: list[dict[str, object]]) -> list[object]:
    return [each["message"] for each in found if each["code"] in ("TLT0421", "TLT0422")]


def is_one(found: list[dict[str, object]]) -> bool:
    return unused(found) == ["nothing uses the let `hushed`\nremove it, or use it"]


def write(folder: Path, **texts: str) -> None:
    (folder / "tltl.toml").write_text("", encoding="utf-8")
    for name, text in texts.items():
        (folder / f"{name}.tltl").write_text(text, encoding="utf-8")


def watched(client: Client, file: Path, kind: int) -> None:
    client.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": file.as_uri(), "type": kind}]})


@pytest.mark.parametrize("main_text", [MAIN, "spec hush = true\n"], ids=["used", "unused"])
def test_the_command_says_the_same(main_text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(tmp_path, library=LIBRARY, main=main_text)
    library = tmp_path / "library.tltl"
    found = analyse(Request(SourceFile(str(library), LIBRARY), (), {}, {})).findings
    with pytest.raises(SystemExit):
        main(["lint", str(library)])
    told = "".join(capsys.readouterr())
    titles = [each.diagnostic.title for each in found]
    assert all(title in told for title in titles)
    assert told.count("TLT0421") == len(titles) == (main_text != MAIN)


def test_files_around_are_read_where_something_seems_unused_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read(_: object) -> dict[Path, str]:
        raise AssertionError("it was read")

    monkeypatch.setattr("tltlc.interfaces.lsp.analysis.neighbours", read)
    used = LIBRARY.replace("F dark", "F (dark and hushed)")
    assert analyse(Request(SourceFile(str(tmp_path / "library.tltl"), used), (), {}, {})).figures
    with pytest.raises(AssertionError, match="it was read"):
        analyse(Request(SourceFile(str(tmp_path / "library.tltl"), LIBRARY), (), {}, {}))


def test_a_text_that_is_not_saved_counts(client: Client, tmp_path: Path) -> None:
    write(tmp_path, library=LIBRARY, main=MAIN)
    library = client.open(tmp_path / "library.tltl", LIBRARY)
    assert client.diagnostics(library) == []
    main_uri = client.open(tmp_path / "main.tltl", MAIN)
    # It is used no more, and then again; the library itself stays as it is.
    client.change(main_uri, MAIN.replace("= hushed", "= F dark"), 2)
    assert client.diagnostics(library, is_one)
    client.change(main_uri, MAIN, 3)
    assert client.diagnostics(library, lambda found: not found) == []
    client.change(main_uri, "signal loud: bool\nspec hush = F loud\n", 4)
    assert client.diagnostics(library, is_one)
    # What is not saved is dropped: the file counts again.
    client.tell("textDocument/didClose", {"textDocument": {"uri": main_uri}})
    assert client.diagnostics(library, lambda found: not found) == []


def test_a_new_file_counts_before_it_is_saved(client: Client, tmp_path: Path) -> None:
    write(tmp_path, library=LIBRARY)
    library = client.open(tmp_path / "library.tltl", LIBRARY)
    assert client.diagnostics(library, is_one)
    client.open(tmp_path / "main.tltl", MAIN)
    assert client.diagnostics(library, lambda found: not found) == []


def test_closed_files_that_come_and_go_count(client: Client, tmp_path: Path) -> None:
    write(tmp_path, library=LIBRARY)
    library = client.open(tmp_path / "library.tltl", LIBRARY)
    assert client.diagnostics(library, is_one)
    write(tmp_path, main=MAIN)
    watched(client, tmp_path / "main.tltl", 1)
    assert client.diagnostics(library, lambda found: not found) == []
    (tmp_path / "main.tltl").unlink()
    watched(client, tmp_path / "main.tltl", 3)
    assert client.diagnostics(library, is_one)


def test_an_import_that_others_pass_on_is_used(client: Client, tmp_path: Path) -> None:
    middle = 'import "library.tltl"\nsignal on: bool\nspec middle = F on\n'
    write(tmp_path, library=LIBRARY, middle=middle, main=MAIN.replace("library", "middle"))
    uri = client.open(tmp_path / "middle.tltl", middle)
    assert client.diagnostics(uri) == []
    assert client.diagnostics(uri) == []
    (tmp_path / "main.tltl").unlink()
    watched(client, tmp_path / "main.tltl", 3)
    assert unused(client.diagnostics(uri, bool)) == ["nothing of `library.tltl` is used\nremove the import, or use it"]
