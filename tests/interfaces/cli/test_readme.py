"""The examples of the README match the behaviour of the tool."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

from tests.interfaces.cli.conftest import ROOT
from tltlc.interfaces.cli.command_line import BUILT_IN

README = (ROOT / "README.md").read_text()


def test_specs_of_the_readme_compile_and_pass(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    specs = re.findall(r"```tltl\n(.*?)```", README, re.DOTALL)
    assert len(specs) == 2
    for text in specs:
        Path("readme.tltl").write_text(text)
        outcome = tltlc("check", "readme.tltl")
        assert (outcome.status, "nothing to report" in outcome.err) == (0, True), outcome.err
        assert tltlc("test", "readme.tltl").status == 0


def test_the_error_message_of_the_readme_is_current(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    example = re.search(r"```\n(error.*?)```", README, re.DOTALL)
    assert example
    before = "import stealth\nentity chest\n\n\n\n\n\nspec near_it {\n"
    Path("sneak.tltl").write_text(before + "    keep near(chest, close = 3 s)\n}\n")
    assert tltlc("check", "sneak.tltl").err == example[1]


def test_the_python_example_of_the_readme_runs(capsys, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(ROOT)
    program = re.search(r"```python\n(.*?)```", README, re.DOTALL)
    assert program
    exec(program[1], {})
    assert capsys.readouterr().out.startswith("3 ['")


def test_the_readme_names_every_built_in_command() -> None:
    for command in BUILT_IN:
        assert re.search(rf"`tltlc {command}[ `]", README), command


def test_the_picture_of_the_readme_is_current(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    spec = re.search(r"```tltl\n(.*?)```", README, re.DOTALL)
    assert spec
    Path("hall.tltl").write_text(spec[1])
    drawn = tltlc("render", "hall.tltl", "-t", "svg").out
    assert texts_and_colours((ROOT / "docs/images/leave.svg").read_text()) == texts_and_colours(drawn)


def texts_and_colours(picture: str) -> list[tuple[str, ...]]:
    """The texts and titles of an SVG with their colours. Positions are left out, because they
    depend on the machine's fonts."""
    return [
        (element.tag, element.text or "", element.get("fill", ""), element.get("stroke", ""))
        for element in ElementTree.fromstring(picture).iter()
    ]
