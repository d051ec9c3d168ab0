from __future__ import annotations

import json
import os
import pty
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import EXAMPLE, ROOT, Outcome
from tests.waiting import HANG_S


@pytest.fixture
def broken(inside: Path) -> Path:
    Path("broken.tltl").write_text("signal a: bool\nspec never = F a & G !a\nspec x = F b\nspec y = F c\n")
    return inside


def test_text_goes_to_standard_error(tltlc, broken: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("check", "broken.tltl")
    assert outcome.out == ""
    assert outcome.err.count("error[TLT0201]") == 2
    assert "\x1b" not in outcome.err


def test_documents_go_to_standard_output(tltlc, broken: Path) -> None:  # type: ignore[no-untyped-def]
    for form in ("json", "sarif"):
        outcome = tltlc("check", "--format", form, "broken.tltl", "hide.tltl")
        assert (outcome.status, outcome.err) == (1, "")
        assert "TLT0201" in json.dumps(json.loads(outcome.out))
        clean = tltlc("check", "--format", form, "hide.tltl")
        assert (clean.status, clean.err) == (0, "")
        assert "TLT" not in json.dumps(json.loads(clean.out))
    workflow = tltlc("check", "--format", "github", "broken.tltl")
    assert workflow.out.count("::error ") == 2


def test_results_and_documents_go_to_different_streams(tltlc, broken: Path) -> None:  # type: ignore[no-untyped-def]
    Path("never.tltl").write_text("signal a: bool\nspec never = F a & G !a\n")
    outcome = tltlc("render", "never.tltl", "-t", "dot", "--format", "json")
    assert outcome.out.startswith("digraph")
    assert "TLT0410" in json.dumps(json.loads(outcome.err))


@pytest.mark.parametrize(
    ("environment", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False)]
)
def test_colour_is_used_on_a_terminal_only(environment: dict[str, str], coloured: bool, broken: Path) -> None:
    terminal, terminal_end = pty.openpty()
    variables = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
    subprocess.run(
        [sys.executable, "-m", "tltlc", "check", "broken.tltl"],
        stderr=terminal_end,
        env={**variables, "TERM": "xterm", "PYTHONPATH": str(ROOT), **environment},
        timeout=HANG_S,
        check=False,
    )
    os.close(terminal_end)
    output = os.read(terminal, 10_000)
    os.close(terminal)
    assert b"TLT0201" in output
    assert (b"\x1b[" in output) == coloured


def test_an_encoding_without_unicode_is_no_error(process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    drawn = process("render", EXAMPLE, "-t", "dot", PYTHONIOENCODING="ascii")
    assert drawn.status == 0
    Path("é.tltl").write_text("spec x = F ∧")
    assert process("check", "é.tltl", PYTHONIOENCODING="ascii").status == 1


def test_pictures_are_written(tltlc, process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("render", EXAMPLE, "-o", "a.svg").err == "wrote a.svg\n"
    assert "<svg" in Path("a.svg").read_text()
    assert tltlc("render", EXAMPLE, "-o", "a.PNG").status == 0
    assert Path("a.PNG").read_bytes().startswith(b"\x89PNG")
    assert tltlc("render", EXAMPLE, "-t", "mermaid").out.startswith("stateDiagram-v2")
    assert "G alive" in tltlc("render", EXAMPLE, "-t", "dot", "--notation", "ascii").out
    assert "□alive" in tltlc("render", EXAMPLE, "-t", "dot").out


@pytest.mark.parametrize(
    ("arguments", "input_"),
    [
        (("render", "a.tltl", "-o", "a.tltl", "-t", "dot"), "a.tltl"),
        (("render", "uses.tltl", "-o", "a.tltl", "-t", "dot"), "a.tltl"),
        (("compile", "a.fspa.json", "-p", "most=3", "-t", "json"), "a.fspa.json"),
        (("mine", "good", "--against", "bad.csv", "-o", "good/good.csv"), "good/good.csv"),
        (("mine", "good", "--against", "bad.csv", "-o", "bad.csv"), "bad.csv"),
        (("mine", "good", "--predicates", "uses.tltl", "-o", "a.tltl"), "a.tltl"),
    ],
)
def test_no_output_overwrites_an_input(
    tltlc: Callable[..., Outcome], inside: Path, arguments: tuple[str, ...], input_: str
) -> None:
    (inside / "a.tltl").write_text("param most in [0, 5] = 1\nsignal x in [0, 9]\nspec a = F x > most\n")
    (inside / "uses.tltl").write_text('import "a.tltl"\nspec uses = F x > 2\n')
    tltlc("compile", "a.tltl", "-t", "json,hoa")
    (inside / "good").mkdir()
    (inside / "good" / "good.csv").write_text("x,seen\n1,0\n3,1\n")
    (inside / "bad.csv").write_text("x,seen\n1,0\n1,0\n")
    before = {path: path.read_bytes() for path in inside.rglob("*") if path.is_file()}
    outcome = tltlc(*arguments)
    assert outcome.status == 2
    assert f"`{input_}` would be overwritten, but it is an input" in outcome.err
    assert before == {path: path.read_bytes() for path in inside.rglob("*") if path.is_file()}


def test_a_file_on_standard_input_is_not_overwritten(process: Callable[..., Outcome], inside: Path) -> None:
    (inside / "a.tltl").write_text("param most in [0, 5] = 1\nsignal x in [0, 9]\nspec a = F x > most\n")
    process("compile", inside / "a.tltl", "-o", inside, "-t", "json")
    artefact = inside / "a.fspa.json"
    before = artefact.read_bytes()
    command = [sys.executable, "-m", "tltlc", "compile", "-", "-p", "most=3", "-t", "json"]
    with artefact.open("rb") as stdin:
        completed = subprocess.run(command, stdin=stdin, capture_output=True, cwd=inside, text=True, check=False)
    assert completed.returncode == 2
    assert "`a.fspa.json` would be overwritten, but it is an input" in completed.stderr
    assert artefact.read_bytes() == before


def test_an_unchanged_input_may_be_written(tltlc: Callable[..., Outcome], inside: Path) -> None:
    tltlc("compile", "hide.tltl", "-t", "json")
    outcome = tltlc("compile", "hide.fspa.json", "-t", "json,dot")
    assert outcome.status == 0
    assert "1 file has not changed" in outcome.err


def test_conformance_writes_into_no_other_folder(tltlc: Callable[..., Outcome], inside: Path) -> None:
    """It does write into the folder of an earlier run, which ``test_corpus.py`` tests."""
    outcome = tltlc("conformance", "-o", ".")
    assert outcome.status == 2 and "TLT0722" in outcome.err
    assert [path.name for path in inside.iterdir()] == ["hide.tltl"]
