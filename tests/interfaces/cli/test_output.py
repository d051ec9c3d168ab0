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
    found = tltlc("check", "broken.tltl")
    assert found.out == ""
    assert found.err.count("error[TLT0201]") == 2
    assert "\x1b" not in found.err


def test_documents_go_to_standard_output(tltlc, broken: Path) -> None:  # type: ignore[no-untyped-def]
    for form in ("json", "sarif"):
        found = tltlc("check", "--format", form, "broken.tltl", "hide.tltl")
        assert (found.status, found.err) == (1, "")
        assert "TLT0201" in json.dumps(json.loads(found.out))
        clean = tltlc("check", "--format", form, "hide.tltl")
        assert (clean.status, clean.err) == (0, "")
        assert "TLT" not in json.dumps(json.loads(clean.out))
    workflow = tltlc("check", "--format", "github", "broken.tltl")
    assert workflow.out.count("::error ") == 2


def test_results_and_documents_do_not_mix(tltlc, broken: Path) -> None:  # type: ignore[no-untyped-def]
    Path("never.tltl").write_text("signal a: bool\nspec never = F a & G !a\n")
    found = tltlc("render", "never.tltl", "-t", "dot", "--format", "json")
    assert found.out.startswith("digraph")
    assert "TLT0410" in json.dumps(json.loads(found.err))


@pytest.mark.parametrize(
    ("environment", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False)]
)
def test_colour_only_on_a_terminal(environment: dict[str, str], coloured: bool, broken: Path) -> None:
    ours, theirs = pty.openpty()
    variables = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
    subprocess.run(
        [sys.executable, "-m", "tltlc", "check", "broken.tltl"],
        stderr=theirs,
        env={**variables, "TERM": "xterm", "PYTHONPATH": str(ROOT), **environment},
        timeout=HANG_S,
        check=False,
    )
    os.close(theirs)
    shown = os.read(ours, 10_000)
    os.close(ours)
    assert b"TLT0201" in shown
    assert (b"\x1b[" in shown) == coloured


def test_a_terminal_without_unicode(process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    drawn = process("render", EXAMPLE, "-t", "dot", PYTHONIOENCODING="ascii")
    assert drawn.status == 0
    Path("é.tltl").write_text("spec x = F ∧")
    assert process("check", "é.tltl", PYTHONIOENCODING="ascii").status == 1


def test_pictures(tltlc, process, inside: Path) -> None:  # type: ignore[no-untyped-def]
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
def test_no_output_takes_the_place_of_an_input(
    tltlc: Callable[..., Outcome], inside: Path, arguments: tuple[str, ...], input_: str
) -> None:
    (inside / "a.tltl").write_text("param most in [0, 5] = 1\nsignal x in [0, 9]\nspec a = F x > most\n")
    (inside / "uses.tltl").write_text('import "a.tltl"\nspec uses = F x > 2\n')
    tltlc("compile", "a.tltl", "-t", "json,hoa")
    (inside / "good").mkdir()
    (inside / "good" / "good.csv").write_text("x,seen\n1,0\n3,1\n")
    (inside / "bad.csv").write_text("x,seen\n1,0\n1,0\n")
    before = {path: path.read_bytes() for path in inside.rglob("*") if path.is_file()}
    done = tltlc(*arguments)
    assert done.status == 2
    assert f"`{input_}` would be written over: it is an input" in done.err
    assert before == {path: path.read_bytes() for path in inside.rglob("*") if path.is_file()}


def test_standard_input_from_a_file_is_an_input(process: Callable[..., Outcome], inside: Path) -> None:
    (inside / "a.tltl").write_text("param most in [0, 5] = 1\nsignal x in [0, 9]\nspec a = F x > most\n")
    process("compile", inside / "a.tltl", "-o", inside, "-t", "json")
    artefact = inside / "a.fspa.json"
    before = artefact.read_bytes()
    command = [sys.executable, "-m", "tltlc", "compile", "-", "-p", "most=3", "-t", "json"]
    with artefact.open("rb") as stdin:
        done = subprocess.run(command, stdin=stdin, capture_output=True, cwd=inside, text=True, check=False)
    assert done.returncode == 2
    assert "`a.fspa.json` would be written over: it is an input" in done.stderr
    assert artefact.read_bytes() == before


def test_an_input_that_would_not_change_may_be_written(tltlc: Callable[..., Outcome], inside: Path) -> None:
    tltlc("compile", "hide.tltl", "-t", "json")
    done = tltlc("compile", "hide.fspa.json", "-t", "json,dot")
    assert done.status == 0
    assert "1 file has not changed" in done.err


def test_conformance_writes_into_no_folder_of_others(tltlc: Callable[..., Outcome], inside: Path) -> None:
    done = tltlc("conformance", "-o", ".")
    assert done.status == 2 and "TLT0722" in done.err
    assert [path.name for path in inside.iterdir()] == ["hide.tltl"]
    assert tltlc("conformance", "-o", "corpus").status == 0
    (inside / "corpus" / "check.py").write_text("changed")
    assert tltlc("conformance", "-o", "corpus").status == 0
    assert (inside / "corpus" / "check.py").read_text() != "changed"
