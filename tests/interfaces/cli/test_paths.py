"""`-` as the path of an output is standard output, or is refused: no command makes a file of that name."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import click
import pytest

from tests.interfaces.cli.conftest import EXAMPLE
from tltlc.interfaces.cli.command_line import BUILT_IN, OF_THE_RUNTIME, cli
from tltlc.interfaces.cli.paths import OutputPath

READ: Final = {"library", "pyodide", "resume", "config", "demonstrations", "policy", "suite", "baseline", "libraries"}
"""Parameters whose paths are read."""


def commands() -> Iterator[tuple[str, click.Command]]:
    context = click.Context(cli)
    for name in (*BUILT_IN, *OF_THE_RUNTIME):
        try:
            command = cli.get_command(context, name)
        except Exception:
            continue  # an extra is not installed
        assert command is not None
        yield name, command
    try:
        from tltl_runtime.cli.support.levels import command as levels
    except ModuleNotFoundError:
        return
    yield "check --level", levels


def _paths() -> list[tuple[str, click.Parameter]]:
    parameters = ((name, each) for name, command in commands() for each in command.params)
    return [(name, each) for name, each in parameters if isinstance(each.type, click.Path) and each.name not in READ]


@pytest.mark.parametrize(("command", "parameter"), _paths(), ids=str)
def test_every_output_knows_what_a_hyphen_means(command: str, parameter: click.Parameter) -> None:
    kind = parameter.type
    assert isinstance(kind, OutputPath)
    if kind.stdout:
        assert kind.convert("-", parameter, None) == Path("-")
        assert kind.convert("./-", parameter, None) == Path.cwd() / "-"
    else:
        with pytest.raises(click.BadParameter, match="is needed, and `-` is none"):
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
def test_folders_are_refused(arguments: tuple[str, ...], tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    found = tltlc(*arguments)
    assert (found.status, found.out) == (2, "")
    assert "a folder is needed, and `-` is none (`./-` is one of that name)" in found.err
    assert [path.name for path in inside.iterdir()] == ["hide.tltl"]


def test_a_picture_on_standard_output(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("render", EXAMPLE, "-t", "dot", "-o", "-") == tltlc("render", EXAMPLE, "-t", "dot")
    assert [path.name for path in inside.iterdir()] == ["hide.tltl"]
    assert tltlc("render", "hide.tltl", "-t", "dot", "-o", "./-").status == 0
    assert Path("-").read_text(encoding="utf-8").startswith("digraph")


def test_proposals_on_standard_output(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("good.csv").write_text("seen\n0\n0\n", encoding="utf-8")
    Path("bad.csv").write_text("seen\n0\n1\n", encoding="utf-8")
    mine = ("mine", "good.csv", "--against", "bad.csv", "--top", "1", "-o")
    assert tltlc(*mine, "mined.tltl").status == 0
    found = tltlc(*mine, "-")
    assert (found.status, found.out) == (0, Path("mined.tltl").read_text(encoding="utf-8"))
    assert not Path("-").exists()
    both = tltlc(*mine, "-", "--json")
    assert (both.status, both.out) == (2, "")
    assert "--json and `-o -` both print" in both.err
