from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import ROOT

LIBRARY = """\
import stealth
entity post_1, post_2
exclusive near(post_1), near(post_2)
"""
AGAIN = """\
HOA: v1
name: "G F \\"post 1\\""
States: 1
Start: 0
AP: 1 "near(post_1)"
acc-name: Buchi
Acceptance: 1 Inf(0)
--BODY--
State: 0
[0] 0 {0}
[!0] 0
--END--
"""


@pytest.fixture
def files(inside: Path) -> Path:
    (inside / "game.tltl").write_text(LIBRARY)
    (inside / "again.hoa").write_text(AGAIN)
    return inside


def artefact(path: str) -> dict[str, object]:
    document: dict[str, object] = json.loads(Path(path).read_text())
    return document


def test_the_default_targets_are_written(tltlc, files: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("import", "again.hoa", "--predicates", "game.tltl", "-o", "build")
    assert (outcome.status, outcome.out) == (0, "")
    names = ["again.dot", "again.fspa.json", "again_monitor.py"]
    assert sorted(path.name for path in Path("build").iterdir()) == names
    assert [f"wrote {Path('build', name)}\n" in outcome.err for name in names] == [True] * 3
    document = artefact("build/again.fspa.json")
    assert document["semantics"] == "infinite"
    assert document["spec"] == {
        "name": "again",
        "doc": "",
        "formula": dict.fromkeys(("ascii", "unicode", "english"), 'G F "post 1"'),
        "limit_steps": None,
        "judge": "limit",
        "level": None,
        "tags": [],
        "clock_s": None,
    }
    assert document["acceptance"] == {"pairs": [{"fin": [], "inf": [1]}]}
    assert [atom["name"] for atom in document["atoms"]] == ["near(post_1)"]  # type: ignore[attr-defined]
    assert tltlc("render", "build/again.fspa.json", "-o", "again.svg").status == 0


def test_options_supply_what_the_file_does_not_define(tltlc, files: Path) -> None:  # type: ignore[no-untyped-def]
    (files / "again.hoa").write_text(AGAIN.replace("near(post_1)", "p0"))
    options = ("--name", "patrol", "--level", "branching", "--limit", "200", "--judge", "goal", "-t", "json")
    outcome = tltlc("import", "again.hoa", "--predicates", "game.tltl", "--atom", "p0=near(post_2)", *options)
    assert outcome.status == 0
    document = artefact("patrol.fspa.json")
    spec = document["spec"]
    assert isinstance(spec, dict)
    assert [spec[key] for key in ("name", "level", "limit_steps", "judge")] == ["patrol", "branching", 200, "goal"]
    assert [atom["name"] for atom in document["atoms"]] == ["near(post_2)"]  # type: ignore[attr-defined]


def test_an_automaton_is_read_from_standard_input(process, files: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = process("import", "-", "--predicates", "game.tltl", "-t", "json", stdin=AGAIN.encode())
    assert outcome.status == 0
    assert artefact("automaton.fspa.json")["format"] == "fspa"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["again.hoa"], "missing option '--predicates'"),
        (["again.hoa", "--predicates", "game.tltl", "--name", "no word"], "`no word` is not a name: use ASCII letters"),
        (["again.hoa", "--predicates", "game.tltl", "--atom", "near(post_1)"], "is not of the form AP=PREDICATE"),
        (["again.hoa", "--predicates", "game.tltl", "-t", "jsn"], "did you mean `json`?"),
        (["agin.hoa", "--predicates", "game.tltl"], "did you mean `again.hoa`?"),
        (["again.hoa", "--predicates", "gme.tltl"], "did you mean `game.tltl`?"),
    ],
)
def test_wrong_usage_is_rejected(tltlc, files: Path, arguments: list[str], message: str) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("import", *arguments)
    assert outcome.status in (2, 3)
    assert message in outcome.err
    assert sorted(path.name for path in files.iterdir()) == ["again.hoa", "game.tltl", "hide.tltl"]


def test_an_input_is_not_overwritten(tltlc, files: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("import", "again.hoa", "--predicates", "game.tltl", "-t", "hoa")
    assert outcome.status == 2
    assert "`again.hoa` would be overwritten" in outcome.err
    assert (files / "again.hoa").read_text() == AGAIN
    assert tltlc("import", "again.hoa", "--predicates", "game.tltl", "-t", "hoa", "-o", "build").status == 0


def test_other_commands_suggest_the_import(tltlc, files: Path) -> None:  # type: ignore[no-untyped-def]
    (files / "late.hoa").write_text(f"/* late */ {AGAIN}")
    for name in ("again.hoa", "late.hoa"):
        outcome = tltlc("check", name)
        assert outcome.status == 1
        assert f"help: make an artefact of it with `tltlc import {name} --predicates LIB.tltl`" in outcome.err


@pytest.mark.skipif(os.name == "nt", reason="a shell is asked to close standard input")
def test_closed_standard_input_exits_with_3(files: Path) -> None:
    command = f'"{sys.executable}" -m tltlc import - --predicates game.tltl <&-'
    completed = subprocess.run(
        ["/bin/sh", "-c", command], capture_output=True, check=False, env=environment(), text=True
    )
    assert (completed.returncode, "cannot read standard input: it is closed" in completed.stderr) == (3, True)


def environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def test_nothing_is_written_if_the_automaton_is_invalid(tltlc, files: Path) -> None:  # type: ignore[no-untyped-def]
    (files / "again.hoa").write_text(AGAIN.replace("[!0] 0\n", ""))
    outcome = tltlc("import", "again.hoa", "--predicates", "game.tltl")
    assert outcome.status == 1
    assert "TLT0654" in outcome.err
    assert sorted(path.name for path in files.iterdir()) == ["again.hoa", "game.tltl", "hide.tltl"]


def test_a_trivial_automaton_has_a_warning(tltlc, files: Path) -> None:  # type: ignore[no-untyped-def]
    for number, (condition, code, phrase) in enumerate(
        (("f", "TLT0410", "accepts no trace"), ("t", "TLT0411", "accepts every trace"))
    ):
        (files / "again.hoa").write_text(AGAIN.replace("1 Inf(0)", f"1 {condition}"))
        outcome = tltlc("import", "again.hoa", "--predicates", "game.tltl", "--name", f"s{number}", "-t", "json")
        assert outcome.status == 0
        assert f"warning[{code}]: `again.hoa` {phrase}" in outcome.err
