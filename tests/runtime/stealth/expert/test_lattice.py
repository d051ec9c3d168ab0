"""An action on the lattice has the same effect as in the physics, and routes have the right length."""

from __future__ import annotations

from contextlib import closing

import numpy as np
import pytest

from tests.runtime.stealth.enemy_levels import level, wall
from tltl_runtime.stealth.expert.lattice import ACTIONS, DISPLACEMENTS, FAR, SPRINTS, lattice_of
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.world.physics import World


def test_a_feasible_action_ends_where_the_lattice_predicts() -> None:
    cover = load_level("cover_and_hide")
    lattice = lattice_of(cover, frozenset(range(len(cover.barriers))))
    rng = np.random.default_rng(3)
    with closing(World(cover)) as world:
        world.reset(None)
        stamina = 1.0
        for _ in range(600):
            here = np.array(world.player.position[:2])
            free = lattice.feasible(here[None])[:, 0] & ~(SPRINTS & (stamina < 0.1))
            chosen = int(rng.choice(np.flatnonzero(free)))
            world.step(ACTIONS[chosen])
            stamina = world.player.stamina
            assert world.player.position[:2] == pytest.approx(here + DISPLACEMENTS[chosen], abs=0.01)


def test_the_decisions_around_a_wall_match_the_length_of_the_route() -> None:
    lattice = lattice_of(level(wall(5.0, 0.0, 5.4, 6.0)), frozenset())
    costs = lattice.decisions_to((8.0, 2.0, 0.0), within=0.8)
    start = np.array([[2.0, 2.0]])
    # Straight to the corner of the wall, 2.7 m east and 4.3 m north, and as far again to the goal.
    shortest = 2 * np.hypot(2.7, 4.3) / 0.45
    decisions = float(lattice.values(costs, start)[0])
    assert shortest * 0.9 < decisions < shortest * 1.2
    assert lattice.values(costs, np.array([[8.0, 2.0]]))[0] == 0.0


def test_a_place_behind_a_wall_is_unreachable() -> None:
    lattice = lattice_of(level(wall(5.0, 0.0, 5.4, 8.0)), frozenset())
    costs = lattice.decisions_to((8.0, 2.0, 0.0), within=0.8)
    assert lattice.values(costs, np.array([[2.0, 2.0]]))[0] >= 0.99 * FAR
    assert lattice.values(costs, np.array([[7.0, 6.0]]))[0] < 40.0
