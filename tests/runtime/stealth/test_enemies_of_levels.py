"""The enemies of the shipped levels patrol, and find a player."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest

from tests.runtime.stealth.enemies.test_grid import distance_to_boxes
from tltl_runtime.stealth.enemies.enemy import Enemies, PlayerView
from tltl_runtime.stealth.enemies.grid import RADIUS, grid_of
from tltl_runtime.stealth.level import Solid
from tltl_runtime.stealth.levels.file import level_names, load_level, variants

CASES = [(name, variant) for name in level_names() for variant in variants(name) if load_level(name, variant).enemies]
FAR_AWAY = PlayerView((0.0, 0.0, -100.0))


def begin(name: str, variant: str) -> Enemies:
    enemies = Enemies(load_level(name, variant))
    enemies.reset(np.random.default_rng(0))
    return enemies


@pytest.mark.parametrize(("name", "variant"), CASES)
def test_enemies_walk_their_whole_routes_and_overlap_nothing(name: str, variant: str) -> None:
    enemies = begin(name, variant)
    level = enemies.level
    shut = [Solid(barrier.name, "wall", barrier.box) for barrier in level.barriers]
    missing = {(index, point[:2]) for index, enemy in enumerate(level.enemies) for point in enemy.route}
    for _ in range(3000):
        enemies.step(0.15, FAR_AWAY)
        for index, (x, y, _) in enumerate(enemies.positions):
            assert distance_to_boxes(x, y, (*level.solids, *shut)) >= RADIUS - 1e-5
            missing -= {(number, (a, b)) for number, (a, b) in missing if number == index and hypot(x - a, y - b) < 0.3}
        if not missing:
            break
    assert not missing
    assert set(enemies.modes) == {"patrol"}


def test_a_player_on_the_route_of_the_guard_is_found_and_hurt() -> None:
    enemies = begin("cover_and_hide", "v0")
    x, y, _ = enemies.level.enemies[0].route[1]
    damage = 0.0
    for _ in range(400):
        enemies.step(0.15, PlayerView((x, y, 0.0)))
        damage += enemies.damage
    assert damage > 0.5


def test_the_added_branch_visits_more_of_a_level() -> None:
    def cells(variant: str) -> int:
        enemies = begin("cover_and_hide", variant)
        visited: set[tuple[int, int]] = set()
        for _ in range(2000):
            enemies.step(0.15, FAR_AWAY)
            visited.update((round(x), round(y)) for x, y, _ in enemies.positions)
        return len(visited)

    assert cells("v2") > 1.3 * cells("v0")


def test_the_steps_between_all_cells_of_a_shipped_level_fit_the_cache() -> None:
    level = load_level("branching")
    floor = grid_of(level).floor(())
    assert 0 < len(floor.centres) ** 2 < 64 << 20
