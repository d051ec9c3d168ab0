"""The description of the changed keys of a file."""

from __future__ import annotations

import pytest

from tltl_runtime.regression.suite.changed_keys import ChangedKeys, changed_keys

GUARD = """doc = "A guard."
type = "enemy"
sight_range = 8.0
walk_speed = 1.6
branches = []
[look]
tilt = 5
"""
ROOM = """[[solid]]
name = "block_1"
at = [1.0, 0.0, 0.0]
[[solid]]
name = "block_2"
at = [4.0, 0.0, 0.0]
[[use]]
asset = "crates"
[[use]]
asset = "crates"
at = [0.0, 0.0, 0.0]
"""


@pytest.mark.parametrize(
    ("old", "new", "description"),
    [
        ("walk_speed = 1.6", "walk_speed = 2.6", "`walk_speed` 1.6 → 2.6"),
        ('type = "enemy"', 'type = "part"', '`type` "enemy" → "part"'),
        ("branches = []", "branches = []\nhears = true", "`hears` new: true"),
        ("sight_range = 8.0\n", "", "`sight_range` removed"),
        ("[look]\ntilt = 5", "[look]\ntilt = 7", "`look.tilt` 5 → 7"),
        ("[look]\ntilt = 5", "look = 5", '`look` {"tilt": 5} → 5'),
    ],
)
def test_changed_keys_are_listed_with_their_values(old: str, new: str, description: str) -> None:
    assert old in GUARD
    assert changed_keys(GUARD, GUARD.replace(old, new)).text == description


@pytest.mark.parametrize(
    ("old", "new", "description"),
    [
        ("at = [4.0, 0.0", "at = [4.0, 1.5", "`solid.block_2.at` [4.0, 0.0, 0.0] → [4.0, 1.5, 0.0]"),
        ("block_2", "block_3", "`solid.block_3` new, `solid.block_2` removed"),
        ('"crates"\nat', '"boxes"\nat', '`use.2.asset` "crates" → "boxes"'),
        ('"block_2"', '"block_1"', '`solid.2.name` "block_2" → "block_1"'),
    ],
)
def test_tables_in_lists_are_identified_by_name_or_position(old: str, new: str, description: str) -> None:
    assert old in ROOM
    assert changed_keys(ROOM, ROOM.replace(old, new)).text == description


def test_long_values_and_more_than_three_keys_are_not_shown() -> None:
    assert changed_keys('doc = "A guard."', f'doc = "{"A guard that walks. " * 3}"').text == "`doc`"
    old, new = ("".join(f"key_{row} = {row + offset}\n" for row in range(7)) for offset in (0, 1))
    assert changed_keys(old, new).text == "`key_0` 0 → 1, `key_1` 1 → 2, `key_2` 2 → 3 and 4 more"


def test_a_change_of_layout_alone_is_reported() -> None:
    assert changed_keys(GUARD, f"# Slow.\n{GUARD.replace(' = ', '=')}").text == "its layout"


def test_invalid_toml_gives_no_description() -> None:
    assert changed_keys(GUARD, "walk_speed = ") == changed_keys("?", GUARD) == ChangedKeys("")


def test_the_parts_of_the_named_keys_are_listed() -> None:
    moved = ROOM.replace("at = [4.0", "at = [5.0")
    assert changed_keys(ROOM, moved).parts == ("solid", "block_2", "at")
    old, new = ("".join(f"key_{row} = {row + offset}\n" for row in range(7)) for offset in (0, 1))
    assert changed_keys(old, new).parts == ("key_0", "key_1", "key_2")
