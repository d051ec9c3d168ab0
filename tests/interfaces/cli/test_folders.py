"""Folders as arguments, and files that are not source texts."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from tests import pipes
from tests.interfaces.cli.conftest import HIDE, Outcome
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.files import files_below
from tltlc.pipeline import load

Command = Callable[..., Outcome]


@pytest.fixture
def levels(inside: Path) -> Path:
    """A folder with a spec, a library and a spec in a subfolder, and a hidden file with an error."""
    for name, text in {
        "levels/hide.tltl": HIDE,
        "levels/deep/dash.tltl": "import sounds\nspec dash = F loud\n",
        "levels/deep/sounds.tltl": "signal noise: ratio\nlet loud = noise > 50 %\n",
        "levels/.old/wrong.tltl": "spec",
    }.items():
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(text)
    return inside


def test_check_counts_the_files_of_a_folder(tltlc: Command, levels: Path) -> None:
    outcome = tltlc("check", "levels")
    assert (outcome.status, outcome.out, outcome.err) == (0, "", "3 files: nothing to report\n")
    Path("levels/hide.tltl").write_text("spec hide = G !seen\n")
    Path("levels/never.tltl").write_text("signal a: bool\nspec never = F a & G !a\nspec ever = F (a | !a)\n")
    outcome = tltlc("check", "levels")
    assert outcome.status == 1
    assert "levels/hide.tltl:1:" in outcome.err
    assert outcome.err.endswith("\n4 files: 1 error, 2 warnings\n")


@pytest.mark.parametrize("command", ["check", "lint", "test", "fmt"])
def test_without_arguments_the_current_folder_is_used(
    command: str, tltlc: Command, levels: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    named = tltlc(command, ".", *(["--check"] if command == "fmt" else []))
    assert tltlc(command, *(["--check"] if command == "fmt" else [])) == named
    assert named.status == (command == "fmt")
    monkeypatch.chdir("levels/deep")
    Path("sounds.tltl").write_text("signal")
    assert tltlc(command).status == 1
    monkeypatch.chdir("../.old")
    Path("wrong.tltl").unlink()
    outcome = tltlc(command)
    assert (outcome.status, "there is no .tltl file in `.`" in outcome.err) == (2, True)


def test_a_folder_with_one_file_is_counted(tltlc: Command, inside: Path) -> None:
    assert tltlc("check").err == "1 file: nothing to report\n"
    Path("hide.tltl").write_text("spec hide = G !seen\n")
    assert tltlc("check").err.endswith("\n1 file: 1 error\n")


def test_files_given_by_name_have_their_own_lines(tltlc: Command, levels: Path) -> None:
    outcome = tltlc("check", "levels/hide.tltl", "levels", "hide.tltl")
    expected_lines = ["levels/hide.tltl: 1 spec, nothing to report", "hide.tltl: 1 spec, nothing to report"]
    assert outcome.err.splitlines() == [*expected_lines, "4 files: nothing to report"]
    assert tltlc("check", "hide.tltl:hide", "hide.tltl").err.endswith("1 file: nothing to report\n")


def test_an_error_in_a_shared_import_is_reported_once(tltlc: Command, levels: Path) -> None:
    Path("levels/deep/sounds.tltl").write_text("signal noise: ratios\nlet loud = noise > 50 %\n")
    outcome = tltlc("check", "levels", "--format", "json")
    assert (outcome.status, len(json.loads(outcome.out)["diagnostics"])) == (1, 1)
    assert tltlc("check", "levels").err.endswith("3 files: 1 error\n")


def test_explain_takes_all_specs_of_a_folder(tltlc: Command, levels: Path) -> None:
    outcome = tltlc("explain", "levels", "--format", "json")
    assert [spec["name"] for spec in json.loads(outcome.out)["specs"]] == ["dash", "hide"]
    Path("levels/hide.tltl").write_text("spec")
    partly = tltlc("explain", "levels", "--format", "json")
    assert (partly.status, [spec["name"] for spec in json.loads(partly.out)["specs"]]) == (1, ["dash"])
    assert tltlc("explain", "levels/hide.tltl", "--format", "json").out == ""


def test_compile_takes_all_specs_of_a_folder(tltlc: Command, levels: Path) -> None:
    outcome = tltlc("compile", "levels", "-t", "json", "-o", "build")
    assert (outcome.status, "no spec" in outcome.err) == (0, False)
    assert sorted(load(path).name for path in Path("build").iterdir()) == ["dash", "hide"]
    assert "no spec" in tltlc("compile", "levels/deep/sounds.tltl", "-t", "json", "-o", "build").err


@pytest.mark.parametrize("command", ["check", "compile", "explain", "fmt", "lint", "test"])
def test_a_folder_without_sources_is_rejected(command: str, tltlc: Command, inside: Path) -> None:
    Path("empty").mkdir()
    outcome = tltlc(command, "empty")
    assert (outcome.status, outcome.err.splitlines()[0]) == (2, "error[TLT0722]: there is no .tltl file in `empty`")


def test_the_tests_of_other_arguments_run_after_a_folder_without_sources(tltlc: Command, inside: Path) -> None:
    Path("empty").mkdir()
    Path("a.tltl").write_text(
        'signal a: bool\nspec s { reach a }\ntest "a" for s { step a  expect satisfied }\n', encoding="utf-8"
    )
    outcome = tltlc("test", "empty", "a.tltl")
    assert (outcome.status, outcome.out.splitlines()[-1]) == (2, "1 passed, 0 failed"), outcome.out + outcome.err


@pytest.mark.parametrize("command", ["fmt", "lint", "test"])
def test_an_artefact_is_rejected_as_a_source(command: str, tltlc: Command, inside: Path) -> None:
    tltlc("compile", "hide.tltl", "-t", "json")
    before = Path("hide.fspa.json").read_bytes()
    outcome = tltlc(command, "hide.fspa.json")
    title = "error[TLT0722]: `hide.fspa.json` is an artefact: it contains an automaton and no source text"
    assert (outcome.status, outcome.err.splitlines()[0]) == (2, title)
    assert Path("hide.fspa.json").read_bytes() == before


def test_an_artefact_is_rejected_as_a_library(tltlc: Command, inside: Path) -> None:
    tltlc("compile", "hide.tltl", "-t", "json,hoa")
    Path("play.csv").write_text("seen\n0\n")
    for arguments in (("import", "hide.hoa"), ("mine", "play.csv")):
        outcome = tltlc(*arguments, "--predicates", "hide.fspa.json")
        assert (outcome.status, "error[TLT0722]: `hide.fspa.json` is an artefact" in outcome.err) == (2, True)


@pytest.mark.parametrize("command", ["check", "fmt", "lint", "test"])
def test_an_automaton_of_another_tool_is_rejected_as_a_source(command: str, tltlc: Command, inside: Path) -> None:
    Path("hide.hoa").write_text("HOA: v1\n")
    assert "error[TLT0652]: `hide.hoa` is an automaton in the Hanoi format" in tltlc(command, "hide.hoa").err


def test_the_help_for_an_automaton_on_standard_input_names_standard_input(process: Command) -> None:
    assert "`tltlc import - --predicates LIB.tltl`" in process("check", "-", stdin=b"HOA: v1\n").err


@pytest.mark.skipif(os.name == "nt", reason="Windows has no named pipes in folders")
@pytest.mark.parametrize(
    "arguments",
    [
        ("check", "."),
        ("lint", "."),
        ("fmt", "--check", "."),
        ("test", "."),
        ("compile", ".", "-o", "out"),
        ("explain", "."),
        ("list", "predicates", "--library", "."),
        ("lint", "hide.tltl"),
        ("explain", "seek"),
    ],
)
def test_pipes_and_devices_in_a_folder_are_not_read(
    arguments: tuple[str, ...], tltlc: Command, inside: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tltlc(*arguments)
    expected = tltlc(*arguments)
    pipes.put_beside(inside / "pipe.tltl")
    pipes.put_beside(inside / "pipe.fspa.json")
    pipes.forbid(monkeypatch)
    assert tltlc(*arguments) == expected


@pytest.mark.skipif(os.name == "nt", reason="Windows has no named pipes in folders")
def test_a_folder_with_only_pipes_has_no_source(tltlc: Command, inside: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("hide.tltl").unlink()
    pipes.put_beside(inside / "pipe.tltl")
    pipes.forbid(monkeypatch)
    outcome = tltlc("check", ".")
    assert (outcome.status, "there is no .tltl file in `.`" in outcome.err) == (2, True)


def test_a_dangling_link_is_reported(tltlc: Command, inside: Path) -> None:
    Path("gone.tltl").symlink_to("nowhere")
    outcome = tltlc("check", ".")
    assert (outcome.status, "it is a link, and its target does not exist" in outcome.err) == (3, True)


def test_a_folder_that_cannot_be_read_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a.tltl").write_text("spec a = true\n")
    (tmp_path / "inside").mkdir()
    scandir = os.scandir

    def refused(path: str) -> object:
        if Path(path).name == "inside":
            raise PermissionError(13, "Permission denied", path)
        return scandir(path)

    monkeypatch.setattr(os, "scandir", refused)
    with pytest.raises(TltlError, match=r"TLT0001: cannot read `.*inside`: permission denied"):
        files_below(tmp_path)
