"""Declarations that other files use are not reported as unused; the editor agrees with `tltlc
lint`."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.lsp.client import Client
from tltlc.core.source import SourceFile
from tltlc.interfaces.cli.main import main
from tltlc.interfaces.lsp.slow_analysis import Request, analyse

LIBRARY = """\
signal loud: bool
signal dark: bool
let hushed = G not loud
spec own = F dark
"""
MAIN = 'import "library.tltl"\nspec hush = hushed\n'


def unused(diagnostics: list[dict[str, object]]) -> list[object]:
    return [diagnostic["message"] for diagnostic in diagnostics if diagnostic["code"] in ("TLT0421", "TLT0422")]


def is_hushed_unused(diagnostics: list[dict[str, object]]) -> bool:
    return unused(diagnostics) == ["nothing uses the let `hushed`\nremove it, or use it"]


def write(folder: Path, **texts: str) -> None:
    (folder / "tltl.toml").write_text("", encoding="utf-8")
    for name, text in texts.items():
        (folder / f"{name}.tltl").write_text(text, encoding="utf-8")


def report_change(client: Client, file: Path, kind: int) -> None:
    client.tell("workspace/didChangeWatchedFiles", {"changes": [{"uri": file.as_uri(), "type": kind}]})


@pytest.mark.parametrize("main_text", [MAIN, "spec hush = true\n"], ids=["used", "unused"])
def test_the_editor_and_the_command_report_the_same(
    main_text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(tmp_path, library=LIBRARY, main=main_text)
    library = tmp_path / "library.tltl"
    findings = analyse(Request(SourceFile(str(library), LIBRARY), (), {}, {})).findings
    with pytest.raises(SystemExit):
        main(["lint", str(library)])
    printed = "".join(capsys.readouterr())
    titles = [finding.diagnostic.title for finding in findings]
    assert all(title in printed for title in titles)
    assert printed.count("TLT0421") == len(titles) == (main_text != MAIN)


def test_neighbouring_files_are_read_only_if_something_seems_unused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read(_: object) -> dict[Path, str]:
        raise AssertionError("it was read")

    monkeypatch.setattr("tltlc.interfaces.lsp.slow_analysis.neighbours", read)
    used = LIBRARY.replace("F dark", "F (dark and hushed)")
    assert analyse(Request(SourceFile(str(tmp_path / "library.tltl"), used), (), {}, {})).figures
    with pytest.raises(AssertionError, match="it was read"):
        analyse(Request(SourceFile(str(tmp_path / "library.tltl"), LIBRARY), (), {}, {}))


@pytest.mark.slow
def test_uses_in_unsaved_texts_count_as_uses(client: Client, tmp_path: Path) -> None:
    write(tmp_path, library=LIBRARY, main=MAIN)
    library = client.open(tmp_path / "library.tltl", LIBRARY)
    assert client.diagnostics(library) == []
    main_uri = client.open(tmp_path / "main.tltl", MAIN)
    # `hushed` becomes unused, and then used again; the library itself does not change.
    client.change(main_uri, MAIN.replace("= hushed", "= F dark"), 2)
    assert client.diagnostics(library, is_hushed_unused)
    client.change(main_uri, MAIN, 3)
    assert client.diagnostics(library, lambda diagnostics: not diagnostics) == []
    client.change(main_uri, "signal loud: bool\nspec hush = F loud\n", 4)
    assert client.diagnostics(library, is_hushed_unused)
    # Closing drops the unsaved text, so the saved file counts again.
    client.tell("textDocument/didClose", {"textDocument": {"uri": main_uri}})
    assert client.diagnostics(library, lambda diagnostics: not diagnostics) == []


def test_uses_in_a_new_unsaved_file_count(client: Client, tmp_path: Path) -> None:
    write(tmp_path, library=LIBRARY)
    library = client.open(tmp_path / "library.tltl", LIBRARY)
    assert client.diagnostics(library, is_hushed_unused)
    client.open(tmp_path / "main.tltl", MAIN)
    assert client.diagnostics(library, lambda diagnostics: not diagnostics) == []


def test_closed_files_that_are_created_and_deleted_count(client: Client, tmp_path: Path) -> None:
    write(tmp_path, library=LIBRARY)
    library = client.open(tmp_path / "library.tltl", LIBRARY)
    assert client.diagnostics(library, is_hushed_unused)
    write(tmp_path, main=MAIN)
    report_change(client, tmp_path / "main.tltl", 1)
    assert client.diagnostics(library, lambda diagnostics: not diagnostics) == []
    (tmp_path / "main.tltl").unlink()
    report_change(client, tmp_path / "main.tltl", 3)
    assert client.diagnostics(library, is_hushed_unused)


def test_an_import_that_another_file_relies_on_is_used(client: Client, tmp_path: Path) -> None:
    middle = 'import "library.tltl"\nsignal on: bool\nspec middle = F on\n'
    write(tmp_path, library=LIBRARY, middle=middle, main=MAIN.replace("library", "middle"))
    uri = client.open(tmp_path / "middle.tltl", middle)
    assert client.diagnostics(uri) == []
    assert client.diagnostics(uri) == []
    (tmp_path / "main.tltl").unlink()
    report_change(client, tmp_path / "main.tltl", 3)
    assert unused(client.diagnostics(uri, bool)) == [
        "nothing from `library.tltl` is used\nremove the import, or use it"
    ]
