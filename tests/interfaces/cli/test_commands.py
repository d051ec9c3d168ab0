from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tltlc.diagnostics.code_pages import codes
from tltlc.interfaces.cli.command_line import BUILT_IN


@pytest.mark.parametrize("command", BUILT_IN)
def test_help_has_examples(command: str, tltlc) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc(command, "--help")
    assert outcome.status == 0
    assert f"tltlc {command}" in outcome.out.split("Options:", 1)[1] or command == "completion"
    # The summary in `tltlc --help` is there, too.
    assert BUILT_IN[command] in tltlc("--help").out


def test_version_is_printed(tltlc) -> None:  # type: ignore[no-untyped-def]
    import tltlc as package

    assert tltlc("--version").out == f"tltlc {package.__version__}\n"


def test_predicates_are_listed(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    rows = json.loads(tltlc("list", "predicates", "--json").out)
    near = next(row for row in rows if row["name"] == "near")
    assert near["library"] == "spatial"
    assert near["signature"] == "near(target: entity, close: length = 1 m, far: length = level_size)"
    assert near["doc"].startswith("Closeness to `target`")
    assert {row["library"] for row in rows} == {"core", "spatial", "stealth"}
    Path("mine").mkdir()
    Path("mine/dash.tltl").write_text("signal v: speed in [0, 9]\n/// Quick.\npredicate fast in [0, 1] = v / 9\n")
    assert "dash\tfast\tQuick.\n" in tltlc("list", "predicates", "--library", "mine").out


def test_targets_and_codes_are_listed(tltlc) -> None:  # type: ignore[no-untyped-def]
    names = {row["name"] for row in json.loads(tltlc("list", "targets", "--json").out)}
    assert names >= {"json", "dot", "hoa", "python", "mermaid", "svg", "png"}
    assert "TLT0001\ta file cannot be read\n" in tltlc("list", "codes").out


@pytest.mark.parametrize("code", ["TLT0001", "tlt0001", "0001"])
def test_a_code_is_explained(code: str, tltlc) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("explain", code).out.startswith("# TLT0001: a file cannot be read\n")


def test_an_unknown_code_gets_suggestions(tltlc) -> None:  # type: ignore[no-untyped-def]
    unused = next(code for code in (f"TLT{number:04}" for number in range(1, 1000)) if code not in codes())
    suggested = re.findall(r"`(TLT\d{4})`", tltlc("explain", unused).err.partition("did you mean ")[2])
    assert len(suggested) == 3
    assert set(suggested) <= set(codes())
    assert "`TLT0201`" in tltlc("explain", "TLT2001").err
    assert "`TLT0942`" in tltlc("explain", "TLT9999").err


@pytest.mark.parametrize("beginning", ["TLT04", "04"])
def test_the_beginning_of_codes_lists_a_family(beginning: str, tltlc) -> None:  # type: ignore[no-untyped-def]
    lines = tltlc("explain", beginning).out.splitlines()
    assert lines[0] == "TLT0401\tthe range of a predicate could not be proved"
    assert {line[:5] for line in lines} == {"TLT04"}


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shell_completion_lists_commands(shell: str, tltlc, process) -> None:  # type: ignore[no-untyped-def]
    assert "_TLTLC_COMPLETE" in tltlc("completion", shell).out
    words = {"COMP_WORDS": "tltlc comp", "COMP_CWORD": "1" if shell != "fish" else "comp"}
    outcome = process(_TLTLC_COMPLETE=f"{shell}_complete", **words)
    assert "compile" in outcome.out
    assert "completion" in outcome.out
    assert "render" not in outcome.out


def test_a_new_project_compiles_and_passes(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("new", "my game").status == 0
    files = {path.name: path.read_text() for path in Path("my game").iterdir()}
    assert sorted(files) == ["README.md", "first_level.csv", "first_level.tltl", "tltl.toml"]
    assert tltlc("check", "my game/first_level.tltl").status == 0
    assert tltlc("compile", "my game/first_level.tltl", "-o", "build").status == 0
    assert tltlc("test", "my game").status == 0
    assert tltlc("monitor", "my game/first_level.tltl", "my game/first_level.csv").status == 0
    assert tltlc("new", "my game").status == 2
    assert {path.name: path.read_text() for path in Path("my game").iterdir()} == files
    Path("empty").mkdir()
    assert tltlc("new", "empty").status == 0
    assert tltlc("new", "hide.tltl").status == 2


def test_the_commands_under_start_here_succeed(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    lines = tltlc("--help").out.split("Start here:\n")[1].split("\n\n")[0].splitlines()
    commands = [line.strip().split("  ")[0].split() for line in lines]
    assert len(commands) == 3
    for program, *arguments in commands:
        assert program == "tltlc"
        # `serve` runs until Ctrl-C; the tests of the playground start it.
        assert arguments[0] == "serve" or tltlc(*arguments).status == 0


def test_levels_are_listed(tltlc) -> None:  # type: ignore[no-untyped-def]
    pytest.importorskip("gymnasium")
    rows = {(row["name"], row["variant"]): row["doc"] for row in json.loads(tltlc("list", "levels", "--json").out)}
    assert rows["navigation", "v2"].startswith("The middle block of the corridor is stretched")
    assert (
        rows["branching", "v1"].startswith("The bars also rise and sink")
        and "The guard sees" in rows["branching", "v1"]
    )
    assert rows["cover_and_hide", "v0"].startswith("Press the button on the left")
