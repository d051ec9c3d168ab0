"""The way through navigation, searched in the real physics: it goes on in v0, and ends at the block in v2."""

from __future__ import annotations

from contextlib import closing

import pytest

from benchmarks.reach import Search, search
from tltl_runtime.stealth.capabilities.reach import reachable
from tltl_runtime.stealth.level import Start
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.world.physics import World
from tltlc.core.record import replace

BEHIND_THE_HURDLE = 16.0
BLOCK_2 = 11.6
"""Metres from the west."""


def searched(variant: str) -> Search:
    """The corridor from its west end, behind the shut gap, in cells of 0.4 m."""
    level = replace(load_level("navigation", variant), start=Start((8.8, 2.5, 0.0)))
    with closing(World(level)) as world:
        world.reset(None)
        return search(world, lambda place: place[0] > BEHIND_THE_HURDLE, cell=0.4, first=lambda place: -place[0])


@pytest.mark.parametrize("variant", ["v0", "v1"])
def test_the_corridor_is_passed(variant: str) -> None:
    assert searched(variant).met


def test_nobody_gets_past_the_stretched_block() -> None:
    found = searched("v2")
    assert not found.met
    assert found.poses > 300
    east = max(place[0] for place in found.places)
    assert BLOCK_2 - 0.35 < east < BLOCK_2
    reach = reachable(load_level("navigation", "v2"))
    for x, y, _ in found.places:
        assert reach.ground[int((y - reach.origin[1]) / reach.cell), int((x - reach.origin[0]) / reach.cell)]


def test_a_state_that_is_put_back_goes_on_as_it_did() -> None:
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
