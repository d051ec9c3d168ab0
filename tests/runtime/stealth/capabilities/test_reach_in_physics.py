"""Search the corridor of navigation in the real physics: it can be passed in v0 and v1, and ends at the block in v2."""

from __future__ import annotations

from contextlib import closing

import pytest

from benchmarks.reach import Search, search
from tltl_runtime.stealth.capabilities.reach import compute_reach
from tltl_runtime.stealth.level import Start
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.world.physics import World
from tltlc.core.record import replace

BEHIND_THE_HURDLE = 16.0
BLOCK_2 = 11.6
"""The x coordinates of the place behind the hurdle, and of the block in v2, in metres."""


def search_corridor(variant: str) -> Search:
    """Search the corridor from its west end, behind the shut gap, in cells of 0.4 m."""
    level = replace(load_level("navigation", variant), start=Start((8.8, 2.5, 0.0)))
    with closing(World(level)) as world:
        world.reset(None)
        return search(world, lambda place: place[0] > BEHIND_THE_HURDLE, cell=0.4, first=lambda place: -place[0])


@pytest.mark.parametrize("variant", ["v0", "v1"])
def test_the_corridor_can_be_passed(variant: str) -> None:
    assert search_corridor(variant).found_goal


def test_the_stretched_block_cannot_be_passed() -> None:
    result = search_corridor("v2")
    assert not result.found_goal
    assert result.poses > 300
    east = max(place[0] for place in result.places)
    assert BLOCK_2 - 0.35 < east < BLOCK_2
    reach = compute_reach(load_level("navigation", "v2"))
    for x, y, _ in result.places:
        assert reach.ground[int((y - reach.origin[1]) / reach.cell), int((x - reach.origin[0]) / reach.cell)]


def test_a_restored_state_continues_as_before() -> None:
    with closing(World(load_level("navigation"))) as world:
        world.reset(None)
        for action in ((1, 0, 0, 0, 1), (1, 2, 1, 0, 1), (1, 2, 0, 0, 0)):
            world.step(action)
        state = world.player
        ends = []
        for _ in range(2):
            world.put(state)
            assert world.player == state
            for action in ((1, 0, 0, 1, 0), (0, 2, 0, 1, 0), (2, 2, 0, 0, 1)):
                world.step(action)
            ends.append(world.player)
            for action in ((2, 1, 1, 0, 1), (0, 0, 0, 1, 0)):
                world.step(action)
        assert ends[0].position == pytest.approx(ends[1].position, abs=0.005)
        assert ends[0].crouching == ends[1].crouching
