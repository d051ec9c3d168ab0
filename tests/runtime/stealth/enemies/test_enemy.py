from __future__ import annotations

from itertools import pairwise
from math import hypot, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.runtime.stealth.enemies.test_grid import distance_to_boxes
from tests.runtime.stealth.enemy_levels import GUARD, bounds, box, level, low, places, solids, wall
from tltl_runtime.stealth.enemies.enemy import CROUCHED_HEAD, Enemies, PlayerView
from tltl_runtime.stealth.enemies.grid import RADIUS
from tltl_runtime.stealth.level import Barrier, Box, Enemy, Solid, StealthLevel
from tltlc.core.record import replace

DT = 0.15
FAR = PlayerView((5.0, 40.0, 0.0))


def standing(x: float, y: float, z: float = 0.0) -> PlayerView:
    return PlayerView((x, y, z))


def crouched(x: float, y: float) -> PlayerView:
    return PlayerView((x, y, 0.0), CROUCHED_HEAD)


def begin(game: StealthLevel, seed: int = 0) -> Enemies:
    enemies = Enemies(game)
    enemies.reset(np.random.default_rng(seed))
    return enemies


def run(enemies: Enemies, player: PlayerView, seconds: float) -> list[str]:
    """Return the modes of the first enemy, without repeating a mode in a row."""
    modes: list[str] = []
    for _ in range(round(seconds / DT)):
        enemies.step(DT, player)
        if not modes or modes[-1] != enemies.modes[0]:
            modes.append(enemies.modes[0])
    return modes


STILL = (((1.0, 4.0, 0.0),),)
"""A route of one point: the enemy stands there and looks along x."""


def sees(game: StealthLevel, player: PlayerView) -> bool:
    enemies = begin(game)
    enemies.step(DT, player)
    return enemies.sees[0]


def test_an_enemy_walks_its_route_at_its_speed() -> None:
    enemies = begin(level())
    assert enemies.positions == ((1.0, 1.0, 0.0),)
    enemies.step(DT, FAR)
    assert enemies.positions[0] == pytest.approx((1.0 + 1.5 * DT, 1.0, 0.0))
    xs = []
    for _ in range(120):
        enemies.step(DT, FAR)
        xs.append(enemies.positions[0][0])
    assert max(xs) == pytest.approx(9.0)
    assert min(xs) == pytest.approx(1.0)
    assert enemies.modes == ("patrol",)


@pytest.mark.parametrize(
    ("player", "expected"),
    [
        (standing(6.0, 4.0), True),
        (standing(9.2, 4.0), False),  # out of range
        (standing(0.5, 4.0), False),  # behind
        (standing(2.0, 5.5), True),  # 56 degrees aside
        (standing(2.0, 6.0), False),  # 63 degrees aside
        (crouched(6.0, 4.0), True),
    ],
)
def test_sight_has_a_range_and_a_cone(player: PlayerView, expected: bool) -> None:
    assert sees(level(routes=STILL), player) == expected


def test_walls_block_sight_and_low_cover_hides_a_crouching_player() -> None:
    behind = 6.0
    assert not sees(level(wall(5.0, 3.0, 5.2, 5.0), routes=STILL), standing(behind, 4.0))
    for height in (0.9, 1.2):
        game = level(low(5.0, 3.0, 5.4, 5.0, height), routes=STILL)
        assert sees(game, standing(behind, 4.0))
        assert not sees(game, crouched(behind, 4.0))


def test_shut_doors_block_sight_and_lasers_do_not() -> None:
    def with_barrier(kind: str) -> StealthLevel:
        return level(routes=STILL, barriers=(Barrier("door", kind, box(5.0, 3.0, 5.2, 5.0), ()),))  # type: ignore[arg-type]

    assert not sees(with_barrier("solid"), standing(6.0, 4.0))
    assert sees(with_barrier("laser"), standing(6.0, 4.0))
    enemies = begin(with_barrier("solid"))
    enemies.set_open(0, True)
    enemies.step(DT, standing(6.0, 4.0))
    assert enemies.sees == (True,)
    enemies.reset(np.random.default_rng(0))
    enemies.step(DT, standing(6.0, 4.0))
    assert enemies.sees == (False,)


def test_movers_block_sight() -> None:
    enemies = begin(level(routes=STILL))
    enemies.step(DT, standing(6.0, 4.0), [bounds(5.0, 3.0, 5.2, 5.0)])
    assert enemies.sees == (False,)
    enemies.step(DT, standing(6.0, 4.0), [bounds(5.0, 5.0, 5.2, 6.0)])
    assert enemies.sees == (True,)


def test_an_enemy_notices_after_its_reaction_time_and_forgets_after_its_memory_time() -> None:
    enemies = begin(level(routes=STILL))
    enemies.step(DT, standing(8.0, 4.0))
    enemies.step(DT, standing(8.0, 4.0))
    assert (enemies.sees, enemies.knows, enemies.modes) == ((True,), (False,), ("patrol",))
    enemies.step(DT, standing(8.0, 4.0))
    assert (enemies.knows, enemies.modes) == ((True,), ("chase",))
    for _ in range(int(GUARD.memory_time / DT)):
        enemies.step(DT, standing(1.0, 40.0))
        assert enemies.knows == (True,)
    enemies.step(DT, standing(1.0, 40.0))
    assert enemies.knows == (False,)


def test_a_glance_is_forgotten() -> None:
    enemies = begin(level(routes=STILL))
    for player in (standing(8.0, 4.0), FAR) * 10:
        enemies.step(DT, player)
    assert enemies.knows == (False,)


def test_an_enemy_chases_searches_returns_and_patrols() -> None:
    enemies = begin(level())
    assert run(enemies, standing(8.0, 2.0), 1.0) == ["patrol", "chase"]
    assert run(enemies, standing(5.0, 7.0), 0.6) == ["chase"]
    assert run(enemies, FAR, 20.0) == ["chase", "search", "return", "patrol"]
    assert enemies.positions[0][1] == pytest.approx(1.0)


def test_an_enemy_runs_to_the_player_at_its_chase_speed_and_hurts_it() -> None:
    enemies = begin(level(routes=STILL))
    player = standing(7.0, 4.0)
    for _ in range(4):
        enemies.step(DT, player)
    before = enemies.positions[0][0]
    enemies.step(DT, player)
    assert enemies.positions[0][0] - before == pytest.approx(GUARD.chase_speed * DT)
    assert enemies.damage == 0.0
    run(enemies, player, 2.0)
    x, y, _ = enemies.positions[0]
    assert 0.6 < hypot(x - 7.0, y - 4.0) < GUARD.attack_range
    assert enemies.damage == pytest.approx(GUARD.attack_damage * DT)


def test_a_player_on_a_platform_or_behind_a_wall_is_not_hurt() -> None:
    enemies = begin(level(Solid("p", "platform", box(6.5, 3.5, 7.5, 4.5, 0.0, 1.0)), routes=STILL))
    run(enemies, standing(7.0, 4.0, 1.0), 3.0)
    assert enemies.knows == (True,)
    assert enemies.damage == 0.0
    enemies = begin(level(wall(2.0, 0.0, 2.2, 8.0), routes=STILL))
    run(enemies, standing(2.4, 4.0), 3.0)
    assert enemies.damage == 0.0


def test_an_enemy_turns_at_its_turn_speed() -> None:
    enemies = begin(level(routes=(((1.0, 4.0, 0.0), (9.0, 4.0, 0.0)),)))
    yaws = []
    for _ in range(90):
        enemies.step(DT, FAR)
        yaws.append(enemies.yaws[0])
    turns = [abs((b - a + pi) % (2 * pi) - pi) for a, b in pairwise(yaws)]
    assert max(turns) <= GUARD.turn_speed * DT + 1e-9
    assert max(turns) > 0.5
    assert max(abs(yaw) for yaw in yaws) > 3.0


GAPS = (wall(0.0, 5.0, 3.0, 5.2), wall(4.2, 5.0, 7.0, 5.2), wall(8.2, 5.0, 10.0, 5.2))


def test_check_gaps_visits_each_narrow_place_off_the_route() -> None:
    def nearest_visits(branches: tuple[str, ...]) -> list[float]:
        enemies = begin(level(*GAPS, kind=replace(GUARD, branches=branches)))
        visited = []
        for _ in range(400):
            enemies.step(DT, FAR)
            visited.append(enemies.positions[0])
            assert enemies.modes == ("patrol",)
        return [min(hypot(x - gap, y - 5.1) for x, y, _ in visited) for gap in (3.6, 7.6)]

    assert max(nearest_visits(("check_gaps",))) < 0.5
    assert min(nearest_visits(())) > 3.0


def trace(enemies: Enemies, seed: int, players: list[PlayerView]) -> list[object]:
    enemies.reset(np.random.default_rng(seed))
    records: list[object] = []
    for step, player in enumerate(players):
        if step == 20:
            enemies.set_open(0, True)
        enemies.step(DT, player)
        records.append((enemies.positions, enemies.yaws, enemies.modes, enemies.sees, enemies.damage))
    return records


def test_a_seed_repeats_an_episode_exactly() -> None:
    door = Barrier("door", "solid", box(3.0, 5.0, 4.2, 5.2), ())
    game = level(*GAPS, kind=replace(GUARD, branches=("check_gaps",)), barriers=(door,))
    rng = np.random.default_rng(5)
    players = [standing(x, y) for x, y in rng.uniform((0, 0), (10, 8), (10, 2)).tolist() for _ in range(15)]
    players[:120] = [standing(8.0, 2.0)] * 10 + [FAR] * 110
    enemies = Enemies(game)
    first = trace(enemies, 3, players)
    trace(enemies, 4, players[:40])
    assert trace(enemies, 3, players) == first
    assert trace(Enemies(game), 3, players) == first
    assert trace(enemies, 4, players) != first


@settings(max_examples=40, deadline=None)
@given(solids(), st.lists(places(), min_size=2, max_size=4), st.lists(places(), min_size=1, max_size=6), st.data())
def test_an_enemy_never_comes_closer_to_a_solid_than_its_radius(
    obstacles: tuple[Solid, ...],
    route: list[tuple[float, float]],
    players: list[tuple[float, float]],
    data: st.DataObject,
) -> None:
    x, y = data.draw(places())
    door = Barrier("door", "solid", Box((x, y, 0.0), (x + 1.0, y + 0.3, 3.0)), ())
    game = level(*obstacles, barriers=(door,), kind=replace(GUARD, branches=("check_gaps",), sight_angle=2 * pi))
    game = replace(game, enemies=(Enemy("guard", game.enemies[0].kind, tuple((*place, 0.0) for place in route)),))
    try:
        enemies = begin(game)
    except ValueError:
        return
    shut: tuple[Solid, ...] = (Solid("door", "wall", door.box),)
    for index, place in enumerate(players):
        if index == 3:
            enemies.set_open(0, True)
            shut = ()
        for _ in range(12):
            x, y, _ = enemies.positions[0]
            enemies.step(DT, standing(*place))
            new_x, new_y, _ = enemies.positions[0]
            assert hypot(new_x - x, new_y - y) <= GUARD.chase_speed * DT + 1e-9
            assert distance_to_boxes(new_x, new_y, obstacles + shut) >= RADIUS - 1e-5
            assert 0.3 < new_x < 9.7
            assert 0.3 < new_y < 7.7
