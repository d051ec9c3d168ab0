"""`-` as an output path is standard output or an error; no command creates a file of that name."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import click
import pytest

from tests.interfaces.cli.conftest import EXAMPLE
from tltlc.interfaces.cli.command_line import BUILT_IN, RUNTIME_COMMANDS, cli
from tltlc.interfaces.cli.paths import OutputPath

READ: Final = {
    "library",
    "pyodide",
    "resume",
    "config",
    "demonstrations",
    "policy",
    "suite",
    "baseline",
    "now",
    "libraries",
}
"""Parameters whose paths are read, not written."""


def commands() -> Iterator[tuple[str, click.Command]]:
    context = click.Context(cli)
    for name in (*BUILT_IN, *RUNTIME_COMMANDS):
        try:
            command = cli.get_command(context, name)
        except Exception:
            continue  # an extra is not installed
        assert command is not None
        yield name, command
    try:
        from tltl_runtime.cli.support.level_check import command as levels
    except ModuleNotFoundError:
        return
    yield "check --level", levels


def _paths() -> list[tuple[str, click.Parameter]]:
    parameters = ((name, parameter) for name, command in commands() for parameter in command.params)
    return [
        (name, parameter)
        for name, parameter in parameters
        if isinstance(parameter.type, click.Path) and parameter.name not in READ
    ]


@pytest.mark.parametrize(("command", "parameter"), _paths(), ids=str)
def test_every_output_handles_a_hyphen(command: str, parameter: click.Parameter) -> None:
    kind = parameter.type
    assert isinstance(kind, OutputPath)
    if kind.stdout:
        assert kind.convert("-", parameter, None) == Path("-")
        assert kind.convert("./-", parameter, None) == Path.cwd() / "-"
    else:
        with pytest.raises(click.BadParameter, match=r"expected a .*, found `-`"):
            kind.convert("-", parameter, None)


@pytest.mark.parametrize(
    "arguments",
    [
        ("compile", "hide.tltl", "-o", "-"),
        ("witness", "hide.tltl", "-o", "-"),
        ("conformance", "-o", "-"),
        ("serve", "--static", "-"),
        ("new", "-"),
    ],
    ids=" ".join,
)
def test_a_hyphen_is_rejected_as_a_folder(arguments: tuple[str, ...], tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc(*arguments)
    assert (outcome.status, outcome.out) == (2, "")
    assert "expected a folder, found `-` (write `./-` for a folder with this name)" in outcome.err
    assert [path.name for path in inside.iterdir()] == ["hide.tltl"]


def test_a_picture_is_written_to_standard_output(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("render", EXAMPLE, "-t", "dot", "-o", "-") == tltlc("render", EXAMPLE, "-t", "dot")
    assert [path.name for path in inside.iterdir()] == ["hide.tltl"]
    assert tltlc("render", "hide.tltl", "-t", "dot", "-o", "./-").status == 0
    assert Path("-").read_text(encoding="utf-8").startswith("digraph")


def test_proposals_are_written_to_standard_output(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("good.csv").write_text("seen\n0\n0\n", encoding="utf-8")
    Path("bad.csv").write_text("seen\n0\n1\n", encoding="utf-8")
    mine = ("mine", "good.csv", "--against", "bad.csv", "--top", "1", "-o")
    assert tltlc(*mine, "mined.tltl").status == 0
    outcome = tltlc(*mine, "-")
    assert (outcome.status, outcome.out) == (0, Path("mined.tltl").read_text(encoding="utf-8"))
    assert not Path("-").exists()
    both = tltlc(*mine, "-", "--json")
    assert (both.status, both.out) == (2, "")
    assert "--json and `-o -` both write to standard output" in both.err
