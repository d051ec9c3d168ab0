"""Plans of levels: pictures of the right size, with the path in them, the same every time."""

from __future__ import annotations

from io import BytesIO
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from tltl_runtime.stealth.enemies.grid import grid_of
from tltl_runtime.stealth.levels.file import level_names, load_level
from tltl_runtime.stealth.pictures.plan import _patrol, draw
from tltl_runtime.stealth.supply.reach import reachable


def pixels(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(BytesIO(png)).convert("RGB"))


def has(picture: np.ndarray, colour: tuple[int, int, int]) -> bool:
    return bool((picture == np.array(colour)).all(axis=2).any())


@pytest.mark.parametrize("name", level_names())
def test_a_plan_shows_walls_and_the_path_by_state(name: str) -> None:
    level = load_level(name)
    x, y, z = level.start.position
    path = [(x + step / 10, y, z) for step in range(20)]
    plain, drawn = pixels(draw(level)), pixels(draw(level, path, [0] * 10 + [1] * 10))
    assert plain.shape == drawn.shape and plain.shape[1] > 500
    assert has(plain, (0x47, 0x55, 0x69))  # walls
    for colour in ((0x25, 0x63, 0xEB), (0x93, 0x33, 0xEA)):  # states 0 and 1
        assert has(drawn, colour) and not has(plain, colour)
    assert draw(level, path) == draw(level, path)


def test_a_plan_shows_what_nobody_reaches() -> None:
    pictures = {}
    for variant in ("v0", "v2"):
        level = load_level("navigation", variant)
        drawn = pixels(draw(level, reach=reachable(level))).astype(int)
        assert drawn.shape == pixels(draw(level)).shape
        pictures[variant] = float((drawn[..., 0] - drawn[..., 2] > 40).mean())
    # The outer walls alone, and all that lies behind the block.
    assert pictures["v0"] < 0.15 < 0.4 < pictures["v2"]


def test_each_point_needs_a_state() -> None:
    with pytest.raises(ValueError, match="2 points need as many states, not 1"):
        draw(load_level("navigation"), [(0, 0, 0), (1, 0, 0)], [0])


@pytest.mark.parametrize("name", ["branching", "cover_and_hide"])
def test_routes_are_drawn_past_what_stands_in_the_way(name: str) -> None:
    level = load_level(name)
    floor = grid_of(level).floor(range(len(level.barriers)))
    bends = 0
    for enemy in level.enemies:
        way = _patrol(level, enemy)
        assert all(floor.clear(here, there) for here, there in pairwise(way))
        assert {point[:2] for point in enemy.route} <= set(way) and way[0] == way[-1]
        bends += len(way) - len(enemy.route) - 1
    assert bends > 0
