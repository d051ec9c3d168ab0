"""The shipped levels under real physics: ways that a player has, step by step, and ways that it has not."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager

import pytest

from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.world.physics import World

Way = Sequence[tuple[float, float, str]]
"""Points to walk to, each with what one does on the way: words of jump, crouch, sprint."""

CORRIDOR: Way = ((6.5, 2.5, ""), (8.6, 2.5, "crouch"), (9.0, 1.2, ""), (10.8, 1.2, ""))
BEHIND_BLOCK: Way = ((10.9, 3.9, ""), (13.1, 3.9, ""), (13.1, 1.2, ""), (16.4, 1.2, "jump"))
TO_PLATFORM: Way = ((21.0, 4.0, ""), (21.0, 8.3, ""), (17.4, 8.3, ""))


@contextmanager
def world(name: str, variant: str, shut: tuple[str, ...] = ()) -> Iterator[World]:
    """A world whose barriers are open, but for those named."""
    level = load_level(name, variant)
    with closing(World(level)) as made:
        made.reset(None)
        for index, barrier in enumerate(level.barriers):
            made.set_open(index, barrier.name not in shut)
        yield made


def walk(world: World, way: Way, steps: int = 60) -> bool:
    """Whether the player gets to each point, within so many decisions, of up to 0.45 m each, to 0.35 m."""
    for x, y, how in way:
        for _ in range(steps):
            dx, dy = x - world.player.position[0], y - world.player.position[1]
            if math.hypot(dx, dy) < 0.35:
                break
            axis = [0 if abs(d) < 0.23 else 1 if d > 0 else 2 for d in (dx, dy)]
            world.step([*axis, "jump" in how, "crouch" in how, "sprint" in how])
        else:
            return False
    return True


@pytest.mark.parametrize("variant", ["v0", "v1"])
def test_navigation_can_be_finished(variant: str) -> None:
    with world("navigation", variant) as place:
        assert walk(place, [(4.5, 5.0, ""), *CORRIDOR, *BEHIND_BLOCK, *TO_PLATFORM])
        assert place.player.position[2] == pytest.approx(1.5, abs=0.05)
        assert walk(place, [(14.4, 8.3, "jump sprint")])
        assert walk(place, [(12.6, 8.3, ""), (9.0, 8.3, ""), (9.0, 6.2, "")])
        assert place.player.position[2] == pytest.approx(0.0, abs=0.05)


def test_the_gap_of_navigation_lets_nobody_through_upright_or_shut() -> None:
    with world("navigation", "v0") as place:
        assert not walk(place, [(6.5, 2.5, ""), (8.6, 2.5, "")])
    with world("navigation", "v0", shut=("gap",)) as place:
        assert not walk(place, [(6.5, 2.5, ""), (8.6, 2.5, "crouch")])


def test_the_stretched_block_shuts_the_corridor() -> None:
    with world("navigation", "v2") as place:
        assert walk(place, CORRIDOR)
        for y in (0.9, 2.5, 4.1):
            for how in ("", "jump", "crouch", "jump sprint"):
                assert walk(place, [(10.9, y, "")])
                assert not walk(place, [(12.6, y, how)], steps=15)


def test_who_falls_into_the_ditch_of_navigation_walks_back_to_the_stairs() -> None:
    with world("navigation", "v0") as place:
        assert walk(place, [*CORRIDOR, *BEHIND_BLOCK, (16.4, 6.0, ""), (16.0, 9.0, "")])
        assert not walk(place, [(14.0, 9.0, "jump sprint")], steps=20)
        assert walk(place, [(16.0, 6.0, ""), (18.0, 3.5, ""), *TO_PLATFORM])


@pytest.mark.parametrize("variant", ["v0", "v1", "v2"])
def test_cover_and_hide_and_branching_have_ways_without_their_guards(variant: str) -> None:
    with world("cover_and_hide", variant) as place:
        assert walk(place, [(8.0, 1.3, ""), (3.8, 2.6, ""), (3.8, 11.4, ""), (4.6, 12.4, "")], steps=90)
        assert walk(place, [(4.6, 11.3, ""), (15.4, 11.3, ""), (15.4, 7.0, ""), (18.0, 7.0, "")], steps=90)
        assert walk(place, [(15.4, 7.0, ""), (15.4, 5.4, ""), (3.8, 5.4, ""), (3.8, 7.0, ""), (1.5, 7.0, "")], steps=90)
        assert walk(place, [(1.5, 3.0, "")])
    room: Way = ((1.5, 11.5, ""), (4.0, 11.5, ""), (5.9, 11.5, ""), (5.9, 2.5, ""), (5.9, 7.0, ""), (9.3, 7.0, ""))
    right: Way = ((9.3, 3.4, ""), (9.3, 0.7, ""), (24.4, 0.7, ""), (24.6, 8.4, ""))
    with world("branching", variant) as place:
        assert walk(place, [*room, *right], steps=90)
    with world("branching", variant, shut=("right", "left")) as place:
        assert walk(place, room)
        assert not walk(place, [(9.3, 3.0, "jump")])
        assert not walk(place, [(9.3, 11.0, "jump")])


@pytest.mark.parametrize("variant", ["v0", "v1"])
def test_the_moving_obstacles_can_be_passed(variant: str) -> None:
    with world("branching", variant) as place:
        room: Way = ((5.9, 7.0, ""), (9.3, 7.0, ""), (9.3, 11.8, ""))
        assert walk(place, room)
        assert walk(place, [(15.9, 11.2, "jump")], steps=200)
        assert walk(place, [(18.3, 11.2, "")], steps=200)
        assert walk(place, [(24.6, 11.8, "jump")], steps=200)
