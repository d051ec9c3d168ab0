from __future__ import annotations

from collections import deque
from itertools import pairwise
from math import hypot

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.runtime.stealth.enemy_levels import box, level, low, places, solids, wall
from tltl_runtime.stealth.enemies.grid import RADIUS, Floor, Grid, grid_of
from tltl_runtime.stealth.level import Barrier, Solid

ROOMS = (wall(4.9, 0.0, 5.1, 5.0), wall(4.9, 6.5, 5.1, 8.0))


def floor_of(*things: Solid) -> Floor:
    return Grid(level(*things)).floor(())


def distance_to_boxes(x: float, y: float, things: tuple[Solid, ...]) -> float:
    """Of a point from the nearest box that stands in an enemy's way."""
    gaps = [
        hypot(max(s.box.low[0] - x, 0.0, x - s.box.high[0]), max(s.box.low[1] - y, 0.0, y - s.box.high[1]))
        for s in things
        if s.box.low[2] < 1.8 and s.box.high[2] > 0.1
    ]
    return min(gaps, default=RADIUS)


def test_a_way_leads_through_the_door() -> None:
    way = floor_of(*ROOMS).way((1.0, 1.0), (9.0, 1.0))
    assert len(way) > 30
    assert any(abs(x - 5.0) < 0.2 and 5.3 < y < 6.2 for x, y in way)
    assert all(hypot(a - c, b - d) < 0.36 for (a, b), (c, d) in pairwise(way))


def test_where_nothing_is_between_the_walk_is_straight() -> None:
    floor = floor_of(low(2.0, 3.0, 3.0, 4.0))
    assert floor.towards((1.0, 1.0), (9.1, 1.7)) == (9.1, 1.7)
    assert floor.towards((1.0, 3.5), (9.0, 3.5)) not in ((9.0, 3.5), None)


def test_a_place_that_cannot_be_reached_is_approached() -> None:
    floor = floor_of(wall(4.0, 0.0, 4.5, 8.0))
    x, y = 1.0, 4.0
    for _ in range(100):
        found = floor.towards((x, y), (4.2, 4.0))
        assert found is not None
        if found == (x, y):
            break
        x, y = found
    assert 3.3 < x < 3.66
    assert abs(y - 4.0) < 0.6


def test_a_shut_barrier_is_a_wall_and_an_open_one_is_not() -> None:
    door = Barrier("door", "solid", box(4.9, 5.0, 5.1, 6.5), ())
    grid = Grid(level(*ROOMS, barriers=(door,)))
    assert grid.floor([0]).way((1.0, 1.0), (9.0, 1.0)) == []
    assert grid.floor([]).way((1.0, 1.0), (9.0, 1.0)) != []
    assert grid.floor([]) is grid.floor(())


def test_only_cells_that_an_enemy_reaches_are_kept() -> None:
    walled = floor_of(wall(4.9, 0.0, 5.1, 8.0))
    assert all(x < 5.0 for x, _ in walled.centres)
    assert Grid(level(routes=())).floor(()).centres == []


def test_kept_answers_stay_within_the_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.stealth.enemies.grid._BUDGET", 1 << 20)
    grid = Grid(level())
    floor = grid.floor(())
    floor.prepare()
    kept = sum(each.nbytes for each in grid._answers.values())
    assert 0 < kept <= 1 << 20
    assert len(floor.way((1.0, 1.0), (9.0, 7.0))) > 30


def test_a_level_has_one_grid() -> None:
    assert grid_of(level()) is grid_of(level())


def test_gaps_are_the_narrow_passages() -> None:
    gaps = floor_of(*ROOMS).gaps()
    assert len(gaps) == 1
    assert hypot(gaps[0][0] - 5.0, gaps[0][1] - 5.75) < 0.5
    assert floor_of().gaps() == ()


def test_an_enemy_without_room_is_refused() -> None:
    with pytest.raises(ValueError, match="no room"):
        floor_of(wall(0.0, 0.0, 10.0, 8.0)).stand((1.0, 1.0))


def lengths(floor: Floor, goal: int) -> list[int]:
    """Steps to a goal, by a plain search from it."""
    found = [-1] * len(floor.centres)
    found[goal] = 0
    queue = deque([goal])
    while queue:
        cell = queue.popleft()
        for other in floor.neighbours[:, cell]:
            if other < len(found) and found[other] < 0:
                found[other] = found[cell] + 1
                queue.append(int(other))
    return found


@settings(max_examples=15, deadline=None)
@given(solids(), st.data())
def test_ways_are_as_short_as_a_plain_search_finds_them(things: tuple[Solid, ...], data: st.DataObject) -> None:
    floor = floor_of(*things)
    if not floor.centres:
        return
    cells = st.integers(0, len(floor.centres) - 1)
    goal = data.draw(cells)
    steps = lengths(floor, goal)
    for cell in data.draw(st.lists(cells, min_size=1, max_size=8)):
        way = floor._way(cell, goal)
        assert len(way) == steps[cell] + 1 if steps[cell] >= 0 else way == [cell]


@settings(max_examples=40, deadline=None)
@given(solids(), places(), places())
def test_no_way_comes_nearer_to_an_obstacle_than_the_radius(
    things: tuple[Solid, ...], a: tuple[float, float], b: tuple[float, float]
) -> None:
    way = floor_of(*things).way(a, b)
    for (x0, y0), (x1, y1) in pairwise(way):
        for part in np.linspace(0.0, 1.0, 5):
            x, y = x0 + part * (x1 - x0), y0 + part * (y1 - y0)
            assert distance_to_boxes(x, y, things) >= RADIUS - 1e-5


@settings(max_examples=40, deadline=None)
@given(solids(), st.lists(places(), min_size=20, max_size=20))
def test_where_an_enemy_can_stand_and_walk_to_is_told_exactly(
    things: tuple[Solid, ...], spots: list[tuple[float, float]]
) -> None:
    floor = floor_of(*things)
    for x, y in spots:
        inside = RADIUS <= x <= 10.0 - RADIUS and RADIUS <= y <= 8.0 - RADIUS
        assert floor.is_free(x, y) == (inside and not any(a < x < c and b < y < d for a, b, c, d in floor.obstacles))
        entry = floor.entry((x, y))
        assert entry is None or floor.clear((x, y), floor.centres[entry])
