"""Files that have changed since the baseline but are not named as changed."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.regression.handmade import ROOM, reference
from tltl_runtime.regression.suite.suite import Suite, read_suite
from tltl_runtime.regression.verdict.baseline import Reference
from tltl_runtime.regression.verdict.unnamed_changes import unnamed_changes
from tltl_runtime.stealth.levels.default_spec import LEVELS
from tltl_runtime.stealth.levels.file import load_level

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
    """References that match the levels as they are now."""
    room, shipped = load_level("room.toml"), load_level("branching")
    return (
        reference(level="room", files=room.files, place="room.toml"),
        reference(level="branching", files=shipped.files),
    )


def test_changed_files_are_reported_with_their_cases(suite: Suite) -> None:
    references = recorded()
    assert unnamed_changes(suite, suite.cases, references) == {}
    Path("room.toml").write_text(ROOM + "# later\n", encoding="utf-8")
    assert unnamed_changes(suite, suite.cases, references) == {"room.toml": ("room:v0",)}
    assert unnamed_changes(suite, suite.cases[1:], references) == {}, "the others are played"
    assert unnamed_changes(suite, suite.cases, ()) == {}


@pytest.mark.parametrize("text", ["# later\n", "[[", "\0"])
def test_an_asset_that_replaces_a_shipped_one_is_reported(suite: Suite, text: str) -> None:
    references = recorded()
    Path("assets").mkdir()
    guard = Path("assets/guard.toml")
    guard.write_text((LEVELS / "assets" / "guard.toml").read_text(encoding="utf-8"), encoding="utf-8", newline="\r\n")
    assert unnamed_changes(suite, suite.cases, references) == {}
    guard.write_text(guard.read_text(encoding="utf-8") + text, encoding="utf-8")
    assert unnamed_changes(suite, suite.cases, references) == {"assets/guard.toml": ("room:v0",)}


def test_a_deleted_level_counts_as_changed(suite: Suite) -> None:
    references = recorded()
    Path("room.toml").unlink()
    assert unnamed_changes(suite, suite.cases, references) == {"room.toml": ("room:v0",)}
