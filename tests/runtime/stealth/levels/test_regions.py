"""Regions of a level: those that it declares, and the parts that it uses."""

from __future__ import annotations

from pathlib import Path

import pytest

from tltl_runtime.stealth.level import Box, Region
from tltl_runtime.stealth.levels.file import level_names, load_level
from tltl_runtime.stealth.levels.identity import level_hash
from tltlc.diagnostics.diagnostic import TltlError

ROOM = """doc = "A room."
[bounds]
at = [5.0, 5.0, -0.5]
size = [10.0, 10.0, 4.5]
[start]
at = [2.0, 2.0, 0.0]
"""
REGION = '[[region]]\nname = "dark corner"\nat = [8.0, 8.0, 0.0]\nsize = [3.0, 2.0, 3.0]\n'
USE = '[[use]]\nasset = "lift"\nname = "old_lift"\nat = [4.0, 4.0, 0.0]\n'
LIFT = """doc = "A block, and a slab that goes up and down beside it."
type = "part"
[[low]]
at = [1.0, 0.0, 0.0]
size = [1.0, 1.0, 1.0]
[[mover]]
name = "slab"
size = [1.0, 1.0, 0.2]
path = [[-1.0, 0.0, 0.5], [-1.0, 0.0, 2.5]]
speed = 1.0
"""


def room(folder: Path, text: str) -> str:
    (folder / "assets").mkdir(exist_ok=True)
    (folder / "assets" / "lift.toml").write_text(LIFT, encoding="utf-8")
    (folder / "room.toml").write_text(ROOM + text, encoding="utf-8")
    return str(folder / "room.toml")


def test_declared_regions_and_parts_are_regions(tmp_path: Path) -> None:
    named, part = load_level(room(tmp_path, USE + REGION)).regions
    assert named == Region("dark corner", Box((6.5, 7.0, 0.0), (9.5, 9.0, 3.0)))
    assert part.name == "old_lift"
    low, high = part.box.low, part.box.high
    assert low == pytest.approx((2.5, 3.5, 0.0))
    assert high[:2] == pytest.approx((5.5, 4.5))
    assert 2.5 < high[2] < 2.8, "the mover is in it wherever it goes"


def test_regions_do_not_change_the_level_hash(tmp_path: Path) -> None:
    plain = load_level(room(tmp_path, USE))
    named = load_level(room(tmp_path, USE + REGION))
    assert plain.regions != named.regions
    assert level_hash(plain) == level_hash(named)


@pytest.mark.parametrize(
    ("text", "code", "title"),
    [
        (REGION + "colour = 3\n", "TLT0802", "`[[region]]` has no key `colour`"),
        (REGION.replace('name = "dark corner"\n', ""), "TLT0803", "`[[region]]` lacks `name`"),
        (REGION.replace("3.0, 2.0", "0.0, 2.0"), "TLT0803", "wrong value for `size`: [0.0, 2.0, 3.0]"),
        ("region = 3\n", "TLT0802", "`[start]` has no key `region`"),
    ],
)
def test_invalid_regions_are_rejected(tmp_path: Path, text: str, code: str, title: str) -> None:
    with pytest.raises(TltlError) as error:
        load_level(room(tmp_path, text))
    assert (code, title) in [(diagnostic.code, diagnostic.title) for diagnostic in error.value.diagnostics]


@pytest.mark.parametrize("name", level_names())
def test_shipped_levels_have_named_regions(name: str) -> None:
    level = load_level(name)
    names = [region.name for region in level.regions]
    assert len(set(names)) == len(names) >= 4
    (x0, y0, _), (x1, y1, _) = level.bounds.low, level.bounds.high
    for region in level.regions:
        assert x0 <= region.box.low[0] < region.box.high[0] <= x1
        assert y0 <= region.box.low[1] < region.box.high[1] <= y1
