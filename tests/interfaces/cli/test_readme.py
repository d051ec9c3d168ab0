"""What the README shows is what the tool does."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

from tests.interfaces.cli.conftest import ROOT
from tltlc.interfaces.cli.command_line import BUILT_IN

README = (ROOT / "README.md").read_text()


def test_its_specs_compile(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    specs = re.findall(r"```tltl\n(.*?)```", README, re.DOTALL)
    assert len(specs) == 2
    for text in specs:
        Path("readme.tltl").write_text(text)
        checked = tltlc("check", "readme.tltl")
        assert (checked.status, "nothing to report" in checked.err) == (0, True), checked.err
        assert tltlc("test", "readme.tltl").status == 0


def test_its_message_is_the_one(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    shown = re.search(r"```\n(error.*?)```", README, re.DOTALL)
    assert shown
    before = "import stealth\nentity s1\n\n\n\n\n\nspec near_it {\n"
    Path("sneak.tltl").write_text(before + "    keep near(s1, close = 3 s)\n}\n")
    assert tltlc("check", "sneak.tltl").err == shown[1]


def test_its_python_runs(capsys, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(ROOT)
    program = re.search(r"```python\n(.*?)```", README, re.DOTALL)
    assert program
    exec(program[1], {})
    assert capsys.readouterr().out.startswith("3 ['")


def test_it_names_every_command() -> None:
    for command in BUILT_IN:
        assert f"`tltlc {command} " in README


def test_its_picture_is_up_to_date(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    drawn = tltlc("render", ROOT / "examples" / "cover_and_hide.tltl", "-t", "svg").out
    assert said((ROOT / "docs/images/cover_and_hide.svg").read_text()) == said(drawn)


def said(picture: str) -> list[tuple[str, ...]]:
    """Each text and title of an SVG with its colour: where they stand depends on the fonts of a machine."""
    return [
        (each.tag, each.text or "", each.get("fill", ""), each.get("stroke", ""))
        for each in ElementTree.fromstring(picture).iter()
    ]
