"""The shipped levels in the real physics: routes that the player can walk, step by step, and routes that it cannot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager

import pytest

from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.world.physics import World

Route = Sequence[tuple[float, float, str]]
"""Points to walk to, each with the moves on the way there: any of jump, crouch and sprint."""

CORRIDOR: Route = ((6.5, 2.5, ""), (8.6, 2.5, "crouch"), (9.0, 1.2, ""), (10.8, 1.2, ""))
BEHIND_BLOCK: Route = ((10.9, 3.9, ""), (13.1, 3.9, ""), (13.1, 1.2, ""), (16.4, 1.2, "jump"))
TO_PLATFORM: Route = ((21.0, 4.0, ""), (21.0, 8.3, ""), (17.4, 8.3, ""))


@contextmanager
def world(name: str, variant: str, shut: tuple[str, ...] = ()) -> Iterator[World]:
    """A world whose barriers are open, except those named in ``shut``."""
    level = load_level(name, variant)
    with closing(World(level)) as opened_world:
        opened_world.reset(None)
        for index, barrier in enumerate(level.barriers):
            opened_world.set_open(index, barrier.name not in shut)
        yield opened_world


def walk(world: World, route: Route, steps: int = 60) -> bool:
    """Whether the player gets within 0.35 m of each point in turn.

    It has ``steps`` decisions for each point, of up to 0.45 m.
    """
    for x, y, moves in route:
        for _ in range(steps):
            dx, dy = x - world.player.position[0], y - world.player.position[1]
            if math.hypot(dx, dy) < 0.35:
                break
            axis = [0 if abs(d) < 0.23 else 1 if d > 0 else 2 for d in (dx, dy)]
            world.step([*axis, "jump" in moves, "crouch" in moves, "sprint" in moves])
        else:
            return False
    return True


@pytest.mark.parametrize("variant", ["v0", "v1"])
def test_navigation_can_be_finished(variant: str) -> None:
    with world("navigation", variant) as opened_world:
        assert walk(opened_world, [(4.5, 5.0, ""), *CORRIDOR, *BEHIND_BLOCK, *TO_PLATFORM])
        assert opened_world.player.position[2] == pytest.approx(1.5, abs=0.05)
        assert walk(opened_world, [(14.4, 8.3, "jump sprint")])
        assert walk(opened_world, [(12.6, 8.3, ""), (9.0, 8.3, ""), (9.0, 6.2, "")])
        assert opened_world.player.position[2] == pytest.approx(0.0, abs=0.05)


def test_the_gap_of_navigation_must_be_open_and_passed_crouching() -> None:
    with world("navigation", "v0") as opened_world:
        assert not walk(opened_world, [(6.5, 2.5, ""), (8.6, 2.5, "")])
    with world("navigation", "v0", shut=("gap",)) as opened_world:
        assert not walk(opened_world, [(6.5, 2.5, ""), (8.6, 2.5, "crouch")])


def test_the_stretched_block_closes_the_corridor() -> None:
    with world("navigation", "v2") as opened_world:
        assert walk(opened_world, CORRIDOR)
        for y in (0.9, 2.5, 4.1):
            for moves in ("", "jump", "crouch", "jump sprint"):
                assert walk(opened_world, [(10.9, y, "")])
                assert not walk(opened_world, [(12.6, y, moves)], steps=15)


def test_a_player_in_the_ditch_of_navigation_can_walk_back_to_the_stairs() -> None:
    with world("navigation", "v0") as opened_world:
        assert walk(opened_world, [*CORRIDOR, *BEHIND_BLOCK, (16.4, 6.0, ""), (16.0, 9.0, "")])
        assert not walk(opened_world, [(14.0, 9.0, "jump sprint")], steps=20)
        assert walk(opened_world, [(16.0, 6.0, ""), (18.0, 3.5, ""), *TO_PLATFORM])


@pytest.mark.parametrize("variant", ["v0", "v1", "v2"])
def test_cover_and_hide_and_branching_can_be_finished_without_guards(variant: str) -> None:
    with world("cover_and_hide", variant) as opened_world:
        assert walk(opened_world, [(8.0, 1.3, ""), (3.8, 2.6, ""), (3.8, 11.4, ""), (4.6, 12.4, "")], steps=90)
        assert walk(opened_world, [(4.6, 11.3, ""), (15.4, 11.3, ""), (15.4, 7.0, ""), (18.0, 7.0, "")], steps=90)
        assert walk(
            opened_world, [(15.4, 7.0, ""), (15.4, 5.4, ""), (3.8, 5.4, ""), (3.8, 7.0, ""), (1.5, 7.0, "")], steps=90
        )
        assert walk(opened_world, [(1.5, 3.0, "")])
    room: Route = ((1.5, 11.5, ""), (4.0, 11.5, ""), (5.9, 11.5, ""), (5.9, 2.5, ""), (5.9, 7.0, ""), (9.3, 7.0, ""))
    right: Route = ((9.3, 3.4, ""), (9.3, 0.7, ""), (24.4, 0.7, ""), (24.6, 8.4, ""))
    with world("branching", variant) as opened_world:
        assert walk(opened_world, [*room, *right], steps=90)
    with world("branching", variant, shut=("right", "left")) as opened_world:
        assert walk(opened_world, room)
        assert not walk(opened_world, [(9.3, 3.0, "jump")])
        assert not walk(opened_world, [(9.3, 11.0, "jump")])


@pytest.mark.parametrize("variant", ["v0", "v1"])
def test_the_moving_obstacles_can_be_passed(variant: str) -> None:
    with world("branching", variant) as opened_world:
        room: Route = ((5.9, 7.0, ""), (9.3, 7.0, ""), (9.3, 11.8, ""))
        assert walk(opened_world, room)
        assert walk(opened_world, [(15.9, 11.2, "jump")], steps=200)
        assert walk(opened_world, [(18.3, 11.2, "")], steps=200)
        assert walk(opened_world, [(24.6, 11.8, "jump")], steps=200)
