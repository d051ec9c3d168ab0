"""What has changed since a baseline without being named."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.regression.made import ROOM, reference
from tltl_runtime.regression.suite.suite import Suite, read_suite
from tltl_runtime.regression.suite.unnamed_changes import unnamed
from tltl_runtime.regression.verdict.baseline import Reference
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.levels.made_for import LEVELS

SUITE = """[[case]]
level = "room.toml"
policy = "navigation"

[[case]]
level = "branching"
"""


@pytest.fixture(name="suite")
def _suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Suite:
    monkeypatch.chdir(tmp_path)
    Path("game.toml").write_text(SUITE, encoding="utf-8")
    Path("room.toml").write_text(ROOM, encoding="utf-8")
    return read_suite(Path("game.toml"))


def recorded() -> tuple[Reference, ...]:
    """What a baseline has of the levels as they are now."""
    room, shipped = load_level("room.toml"), load_level("branching")
    return (
        reference(level="room", files=room.files, place="room.toml"),
        reference(level="branching", files=shipped.files),
    )


def test_what_differs_is_told_with_its_cases(suite: Suite) -> None:
    references = recorded()
    assert unnamed(suite, suite.cases, references) == {}
    Path("room.toml").write_text(ROOM + "# later\n", encoding="utf-8")
    assert unnamed(suite, suite.cases, references) == {"room.toml": ("room:v0",)}
    assert unnamed(suite, suite.cases[1:], references) == {}, "the others are played"
    assert unnamed(suite, suite.cases, ()) == {}


@pytest.mark.parametrize("text", ["# later\n", "[[", "\0"])
def test_an_asset_takes_the_place_of_the_packages(suite: Suite, text: str) -> None:
    references = recorded()
    Path("assets").mkdir()
    guard = Path("assets/guard.toml")
    guard.write_text((LEVELS / "assets" / "guard.toml").read_text(encoding="utf-8"), encoding="utf-8", newline="\r\n")
    assert unnamed(suite, suite.cases, references) == {}
    guard.write_text(guard.read_text(encoding="utf-8") + text, encoding="utf-8")
    assert unnamed(suite, suite.cases, references) == {"assets/guard.toml": ("room:v0",)}


def test_a_level_that_is_gone_has_changed(suite: Suite) -> None:
    references = recorded()
    Path("room.toml").unlink()
    assert unnamed(suite, suite.cases, references) == {"room.toml": ("room:v0",)}
