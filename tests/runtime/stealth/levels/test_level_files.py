"""The names of a level's files, and what each file is."""

from __future__ import annotations

import pytest

from tltl_runtime.game.level_files import FileKind, file_kind, listed_name
from tltl_runtime.stealth.levels.file import load_level


@pytest.mark.parametrize(
    ("kind", "name"), [("level", "room.toml"), ("asset", "assets/guard.toml"), ("overlay", "overlays/overlays.toml")]
)
def test_the_name_of_a_file_shows_its_kind(kind: FileKind, name: str) -> None:
    assert listed_name(kind, name.rpartition("/")[2]) == name
    assert file_kind(name) == kind


def test_each_file_of_a_shipped_level_has_its_kind() -> None:
    kinds = {name: file_kind(name) for name, _ in load_level("navigation", "v2").files}
    assert kinds == {
        "navigation.toml": "level",
        "assets/corridor.toml": "asset",
        "overlays/corridor_shut.toml": "overlay",
    }
