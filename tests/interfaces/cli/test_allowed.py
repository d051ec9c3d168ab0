"""Findings that comments or projects allow are reported by no command."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome

Command = Callable[..., Outcome]

ALLOW = "// tltlc: allow"
ODD = "signal seen: bool\nspec odd = F (seen or not seen)"
JUMPY = "signal x in [0, 9]\npredicate p in [-1, 1] = when x < 5: x / 9 - 1 otherwise: 1"
COMMANDS = (("check",), ("compile", "-o", "build"), ("render",), ("explain",), ("witness",), ("test",), ("lint",))


@pytest.mark.parametrize("command", COMMANDS)
def test_a_comment_silences_a_warning_in_every_command(tltlc: Command, inside: Path, command: tuple[str, ...]) -> None:
    Path("odd.tltl").write_text(f"{ODD}\n")
    Path("allowed.tltl").write_text(f"{ODD}  {ALLOW} TLT0411 as it is\n")
    name, *options = command
    assert "warning[TLT0411]" in tltlc(name, "odd.tltl", *options).err
    assert "TLT04" not in tltlc(name, "allowed.tltl", *options).err


def test_a_comment_applies_to_its_own_file(tltlc: Command, inside: Path) -> None:
    Path("jumpy.tltl").write_text(f"{JUMPY}\n")
    Path("game.tltl").write_text(f"{ALLOW} TLT0402\nimport jumpy\nspec s = F p\n")
    assert "warning[TLT0402]" in tltlc("check", "game.tltl").err
    Path("jumpy.tltl").write_text(f"{JUMPY}  {ALLOW} TLT0402\n")
    assert tltlc("check", "game.tltl").err == "game.tltl: 1 spec, nothing to report\n"


def test_comments_apply_beside_errors(tltlc: Command, inside: Path) -> None:
    Path("bad.tltl").write_text(f"{ALLOW} TLT0201, TLT0411\n{ODD}\nspec s = F nobody\n")
    for command in ("check", "lint"):
        outcome = tltlc(command, "bad.tltl")
        assert outcome.status == 1
        assert "error[TLT0201]" in outcome.err and "TLT0411" not in outcome.err


@pytest.mark.parametrize("command", ["check", "compile", "lint", "lint --fix", "import"])
def test_levels_of_the_project_apply_beside_errors(tltlc: Command, inside: Path, command: str) -> None:
    head = 'HOA: v1\nname: "again"\nStates: 1\nStart: 0\nAP: 2 "p" "q"\nacc-name: Buchi\nAcceptance: 1 Inf(0)\n'
    Path("again.hoa").write_text(f"{head}--BODY--\nState: 0\n[0&1] 0 {{0}}\n[!0|!1] 0\n--END--\n")
    Path("bad.tltl").write_text(f"{JUMPY}\npredicate q in [-1, 1] = x\nspec s = F (p & q)\n")
    name, *options = command.split()
    files = ("again.hoa", "--predicates", "bad.tltl") if name == "import" else ("bad.tltl",)
    assert "warning[TLT0402]" in tltlc(name, *files, *options).err
    Path("tltl.toml").write_text('[lint]\nallow = ["TLT0402"]\n')
    outcome = tltlc(name, *files, *options)
    assert outcome.status == 1
    assert "error[TLT0306]" in outcome.err and "TLT0402" not in outcome.err


def test_only_lint_reports_an_unused_comment(tltlc: Command, inside: Path) -> None:
    Path("a.tltl").write_text(f"signal seen: bool\nspec s = F seen  {ALLOW} TLT0411\n")
    assert "TLT" not in tltlc("check", "a.tltl").err
    assert "warning[TLT0427]" in tltlc("lint", "a.tltl").err


def test_the_predicates_of_an_imported_automaton_are_checked(tltlc: Command, inside: Path) -> None:
    head = 'HOA: v1\nname: "again"\nStates: 1\nStart: 0\nAP: 1 "p"\nacc-name: Buchi\nAcceptance: 1 Inf(0)\n'
    Path("again.hoa").write_text(f"{head}--BODY--\nState: 0\n[0] 0 {{0}}\n[!0] 0\n--END--\n")
    command = ("import", "again.hoa", "--predicates", "jumpy.tltl", "-o", "build")
    Path("jumpy.tltl").write_text(f"{JUMPY}\n")
    assert "warning[TLT0402]" in tltlc(*command).err
    Path("jumpy.tltl").write_text(f"{JUMPY}  {ALLOW} TLT0402\n")
    assert "TLT0402" not in tltlc(*command).err
    Path("jumpy.tltl").write_text(f"{JUMPY}\n")
    Path("tltl.toml").write_text('[lint]\nallow = ["TLT0402"]\n')
    assert "TLT0402" not in tltlc(*command).err
    Path("tltl.toml").write_text('[lint]\nerror = ["TLT0402"]\n')
    assert tltlc(*command).status == 1


@pytest.mark.parametrize("level", ["allow", "note", "warning", "error"])
def test_levels_of_the_project_apply_to_warnings(tltlc: Command, inside: Path, level: str) -> None:
    Path("odd.tltl").write_text(f"{ODD}\n")
    Path("tltl.toml").write_text(f'[lint]\n{level} = ["TLT0411"]\n')
    outcome = tltlc("check", "odd.tltl")
    assert outcome.status == (1 if level == "error" else 0)
    assert (f"{level}[TLT0411]" in outcome.err) == (level != "allow")
    compiled = tltlc("compile", "odd.tltl", "-o", "build")
    # At the level `error`, nothing is written.
    assert (compiled.status, Path("build").exists()) == ((1, False) if level == "error" else (0, True))
