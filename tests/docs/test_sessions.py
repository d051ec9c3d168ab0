"""Pages are run from the first to the last line: the shown output is the tool's output."""

from __future__ import annotations

import os
import re
from importlib.util import find_spec
from pathlib import Path
from shutil import which

import pytest

from tests.docs.blocks import DOCS, blocks
from tests.docs.sessions import Shell, run_page
from tests.interfaces.cli.test_readme import texts_and_colours

PAGE = DOCS / "tutorial.md"
LEVEL = "## Played in a level\n"
"""The heading of the section that needs the physics of the game."""

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the pages speak to a POSIX shell")


def test_the_tutorial_runs(tmp_path: Path) -> None:
    shell = Shell(tmp_path)
    text = PAGE.read_text(encoding="utf-8")
    if find_spec("pybullet") is None:
        start = text.index(LEVEL)
        text = text[:start] + text[text.index("\n## ", start) :]
    assert run_page(text, shell) >= 24

    spec = next(block.text for block in blocks(PAGE) if block.kind == "tltl")
    assert (shell.folder / "first_level.tltl").read_text(encoding="utf-8") == spec
    pictures = shell.folder / "first_level.svg", DOCS / "images" / "leave_with_key.svg"
    assert len({tuple(texts_and_colours(picture.read_text(encoding="utf-8"))) for picture in pictures}) == 1


def test_the_guide_to_automata_of_other_tools_runs(tmp_path: Path) -> None:
    assert run_page((DOCS / "guides" / "hoa.md").read_text(encoding="utf-8"), Shell(tmp_path)) == 1


@pytest.mark.parametrize(
    ("page", "tool", "commands"),
    [
        ("unreal", "g++", 6),
        ("web", "node", 6),
        ("love", "lua5.4", 7),
        ("unity", "mcs", 6),
        ("rust", "rustc", 6),
        ("godot", "godot3-server", 6),
    ],
)
def test_the_guides_to_engines_run(page: str, tool: str, commands: int, tmp_path: Path) -> None:
    if which(tool) is None:
        pytest.skip(f"{tool} is not installed")
    assert run_page((DOCS / "guides" / f"{page}.md").read_text(encoding="utf-8"), Shell(tmp_path)) == commands


def test_the_guide_to_many_members_runs(tmp_path: Path) -> None:
    missing = [tool for tool in ("gcc", "mcs", "godot3-server", "node", "lua5.4", "rustc") if which(tool) is None]
    if missing:
        pytest.skip(f"{missing[0]} is not installed")
    assert run_page((DOCS / "guides" / "many.md").read_text(encoding="utf-8"), Shell(tmp_path)) == 8


def test_the_guide_to_frame_times_runs(tmp_path: Path) -> None:
    assert run_page((DOCS / "guides" / "frame-times.md").read_text(encoding="utf-8"), Shell(tmp_path)) == 4


def test_the_guide_to_linting_runs(tmp_path: Path) -> None:
    assert run_page((DOCS / "guides" / "linting.md").read_text(encoding="utf-8"), Shell(tmp_path)) == 2


def test_the_guide_to_explaining_runs(tmp_path: Path) -> None:
    assert run_page((DOCS / "guides" / "explaining.md").read_text(encoding="utf-8"), Shell(tmp_path)) == 4


def test_the_guide_to_recorded_play_runs(tmp_path: Path) -> None:
    assert run_page((DOCS / "guides" / "recorded-play.md").read_text(encoding="utf-8"), Shell(tmp_path)) == 17


def test_the_guide_to_play_without_an_end_runs(tmp_path: Path) -> None:
    assert run_page((DOCS / "guides" / "infinite.md").read_text(encoding="utf-8"), Shell(tmp_path)) >= 8


class _SteadyShell(Shell):
    """A shell in which every game is equally fast."""

    def run(self, command: str) -> str:
        return re.sub(r"[\d,]+ steps a second", "90,000 steps a second", super().run(command))


def test_the_environment_of_the_readme_runs_with_the_files_of_the_page_on_games(tmp_path: Path) -> None:
    pytest.importorskip("gymnasium")
    shell = Shell(tmp_path)
    for block in blocks(DOCS / "games.md"):
        if name := re.match(r"(?:#|//) (lake\S+)\n", block.text):
            (tmp_path / name[1]).write_text(block.text)
    program = next(block.text for block in blocks(DOCS / "guides" / "environments.md") if "TltlEnv" in block.text)
    (tmp_path / "program.py").write_text(program)
    assert shell.run("python program.py") == "F at_goal & G !in_hole 0.0\n"


def test_the_page_on_games_runs(tmp_path: Path) -> None:
    pytest.importorskip("gymnasium")
    assert run_page((DOCS / "games.md").read_text(encoding="utf-8"), _SteadyShell(tmp_path)) == 2
