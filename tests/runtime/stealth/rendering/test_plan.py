"""Plans of levels: pictures of the right size that show what the level has, and are the same every time."""

from __future__ import annotations

from io import BytesIO
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from tltl_runtime.stealth.capabilities.reach import compute_reach
from tltl_runtime.stealth.enemies.grid import grid_of
from tltl_runtime.stealth.levels.file import level_names, load_level
from tltl_runtime.stealth.rendering.plan import draw_level, patrol_path


def pixels(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(BytesIO(png)).convert("RGB"))


def has(picture: np.ndarray, colour: tuple[int, int, int]) -> bool:
    return bool((picture == np.array(colour)).all(axis=2).any())


@pytest.mark.parametrize("name", level_names())
def test_a_plan_shows_what_a_level_has(name: str) -> None:
    level = load_level(name)
    reach = compute_reach(level)
    drawn = pixels(draw_level(level, reach))
    assert drawn.shape[1] > 500
    for colour in ((0xFA, 0xCC, 0x15), (0x16, 0xA3, 0x4A)):  # switches and exits; hidden ones are only in the legend
        things = level.switches if colour[0] == 0xFA else level.exits
        assert has(drawn, colour) == bool(things)
    assert not any(has(drawn, colour) for colour in ((0x25, 0x63, 0xEB), (0x93, 0x33, 0xEA)))  # states 0 and 1
    assert draw_level(level, reach) == draw_level(level, reach)


def test_a_plan_marks_unreachable_places() -> None:
    pictures = {}
    for variant in ("v0", "v2"):
        level = load_level("navigation", variant)
        drawn = pixels(draw_level(level, compute_reach(level))).astype(int)
        pictures[variant] = float((drawn[..., 0] - drawn[..., 2] > 40).mean())
    # In v0 only the outer walls are red, in v2 also everything behind the block.
    assert pictures["v0"] < 0.15 < 0.4 < pictures["v2"]


@pytest.mark.parametrize("name", ["branching", "cover_and_hide"])
def test_routes_are_drawn_around_obstacles(name: str) -> None:
    level = load_level(name)
    floor = grid_of(level).floor(range(len(level.barriers)))
    bends = 0
    for enemy in level.enemies:
        path = patrol_path(level, enemy)
        assert all(floor.is_clear(start, end) for start, end in pairwise(path))
        assert {point[:2] for point in enemy.route} <= set(path) and path[0] == path[-1]
        bends += len(path) - len(enemy.route) - 1
    assert bends > 0
