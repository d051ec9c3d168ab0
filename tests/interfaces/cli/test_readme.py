"""The examples of the README, and of the pages on commands and on Python, match the behaviour of the tool."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

from tests.interfaces.cli.conftest import ROOT
from tltlc.interfaces.cli.command_line import BUILT_IN

README = (ROOT / "README.md").read_text()
SPEC = re.findall(r"```tltl\n(.*?)```", README, re.DOTALL)[0]


def test_the_spec_of_the_readme_is_right(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("leave.tltl").write_text(SPEC)
    for command in ("check", "lint"):
        outcome = tltlc(command, "leave.tltl")
        assert (outcome.status, "nothing to report" in outcome.err) == (0, True), outcome.err


def test_the_signals_in_the_text_of_the_readme_can_be_declared(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    declared = re.findall(r"`(signal [^`]+)`", README)
    assert len(declared) == 3
    rule = "spec s {\n    avoid phase is menu and coins > 3 and health > 50\n}\n"
    Path("signals.tltl").write_text("".join(f"{declaration}\n" for declaration in declared) + rule)
    assert tltlc("check", "signals.tltl").status == 0


def test_the_verdict_of_the_readme_is_current(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("leave.tltl").write_text(SPEC)
    recording, verdict = re.findall(r"```text\n(.*?)```", README, re.DOTALL)
    Path("run.csv").write_text(recording)
    assert tltlc("monitor", "leave.tltl", "run.csv").err == verdict


def test_no_table_of_the_readme_has_more_than_ten_rows() -> None:
    tables = re.findall(r"(?:^\|.*\n)+", README, re.MULTILINE)
    assert tables
    assert max(table.count("\n") - 2 for table in tables) <= 10


def test_the_python_example_runs(capsys, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(ROOT)
    program = re.search(r"```python\n(.*?)```", (ROOT / "docs" / "python.md").read_text(), re.DOTALL)
    assert program
    exec(program[1], {})
    assert capsys.readouterr().out.startswith("3 ['")


def test_the_page_on_commands_names_every_built_in_command() -> None:
    page = (ROOT / "docs" / "commands.md").read_text()
    for command in BUILT_IN:
        assert re.search(rf"`tltlc {command}[ `]", page), command


def test_the_picture_of_the_readme_is_current(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("hall.tltl").write_text(SPEC)
    drawn = tltlc("render", "hall.tltl", "--notation", "english", "-t", "svg").out
    assert texts_and_colours((ROOT / "docs/images/leave.svg").read_text()) == texts_and_colours(drawn)


def texts_and_colours(picture: str) -> list[tuple[str, ...]]:
    """The texts and titles of an SVG with their colours. Positions are left out, because they
    depend on the machine's fonts."""
    return [
        (element.tag, element.text or "", element.get("fill", ""), element.get("stroke", ""))
        for element in ElementTree.fromstring(picture).iter()
    ]
