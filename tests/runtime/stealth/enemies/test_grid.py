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


def floor_of(*obstacles: Solid) -> Floor:
    return Grid(level(*obstacles)).floor(())


def distance_to_boxes(x: float, y: float, obstacles: tuple[Solid, ...]) -> float:
    """Return the distance from a point to the nearest box that blocks an enemy; ``RADIUS`` if there is none."""
    gaps = [
        hypot(
            max(obstacle.box.low[0] - x, 0.0, x - obstacle.box.high[0]),
            max(obstacle.box.low[1] - y, 0.0, y - obstacle.box.high[1]),
        )
        for obstacle in obstacles
        if obstacle.box.low[2] < 1.8 and obstacle.box.high[2] > 0.1
    ]
    return min(gaps, default=RADIUS)


def test_a_path_leads_through_the_door() -> None:
    path = floor_of(*ROOMS).path((1.0, 1.0), (9.0, 1.0))
    assert len(path) > 30
    assert any(abs(x - 5.0) < 0.2 and 5.3 < y < 6.2 for x, y in path)
    assert all(hypot(a - c, b - d) < 0.36 for (a, b), (c, d) in pairwise(path))


def test_a_walk_is_straight_if_nothing_is_in_the_way() -> None:
    floor = floor_of(low(2.0, 3.0, 3.0, 4.0))
    assert floor.next_point((1.0, 1.0), (9.1, 1.7)) == (9.1, 1.7)
    assert floor.next_point((1.0, 3.5), (9.0, 3.5)) not in ((9.0, 3.5), None)


def test_an_unreachable_place_is_approached() -> None:
    floor = floor_of(wall(4.0, 0.0, 4.5, 8.0))
    x, y = 1.0, 4.0
    for _ in range(100):
        next_place = floor.next_point((x, y), (4.2, 4.0))
        assert next_place is not None
        if next_place == (x, y):
            break
        x, y = next_place
    assert 3.3 < x < 3.66
    assert abs(y - 4.0) < 0.6


def test_a_shut_barrier_is_a_wall_and_an_open_one_is_not() -> None:
    door = Barrier("door", "solid", box(4.9, 5.0, 5.1, 6.5), ())
    grid = Grid(level(*ROOMS, barriers=(door,)))
    assert grid.floor([0]).path((1.0, 1.0), (9.0, 1.0)) == []
    assert grid.floor([]).path((1.0, 1.0), (9.0, 1.0)) != []
    assert grid.floor([]) is grid.floor(())


def test_only_cells_that_an_enemy_can_reach_are_kept() -> None:
    walled = floor_of(wall(4.9, 0.0, 5.1, 8.0))
    assert all(x < 5.0 for x, _ in walled.centres)
    assert Grid(level(routes=())).floor(()).centres == []


def test_the_cache_stays_within_its_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.stealth.enemies.grid._BUDGET", 1 << 20)
    grid = Grid(level())
    floor = grid.floor(())
    floor.prepare()
    cached_bytes = sum(table.nbytes for table in grid._steps_to_goals.values())
    assert 0 < cached_bytes <= 1 << 20
    assert len(floor.path((1.0, 1.0), (9.0, 7.0))) > 30


def test_a_level_has_one_grid() -> None:
    assert grid_of(level()) is grid_of(level())


def test_gaps_are_the_narrow_passages() -> None:
    gaps = floor_of(*ROOMS).gaps()
    assert len(gaps) == 1
    assert hypot(gaps[0][0] - 5.0, gaps[0][1] - 5.75) < 0.5
    assert floor_of().gaps() == ()


def test_an_enemy_without_room_is_rejected() -> None:
    with pytest.raises(ValueError, match="no room"):
        floor_of(wall(0.0, 0.0, 10.0, 8.0)).standing_place((1.0, 1.0))


def lengths(floor: Floor, goal: int) -> list[int]:
    """Return the steps from each cell to a goal, by a breadth-first search; -1 if there is no path."""
    steps = [-1] * len(floor.centres)
    steps[goal] = 0
    queue = deque([goal])
    while queue:
        cell = queue.popleft()
        for neighbour in floor.neighbours[:, cell]:
            if neighbour < len(steps) and steps[neighbour] < 0:
                steps[neighbour] = steps[cell] + 1
                queue.append(int(neighbour))
    return steps


@settings(max_examples=15, deadline=None)
@given(solids(), st.data())
def test_paths_are_as_short_as_those_of_a_breadth_first_search(
    obstacles: tuple[Solid, ...], data: st.DataObject
) -> None:
    floor = floor_of(*obstacles)
    if not floor.centres:
        return
    cells = st.integers(0, len(floor.centres) - 1)
    goal = data.draw(cells)
    steps = lengths(floor, goal)
    for cell in data.draw(st.lists(cells, min_size=1, max_size=8)):
        path = floor._cell_path(cell, goal)
        assert len(path) == steps[cell] + 1 if steps[cell] >= 0 else path == [cell]


@settings(max_examples=40, deadline=None)
@given(solids(), places(), places())
def test_no_path_comes_closer_to_an_obstacle_than_the_radius(
    obstacles: tuple[Solid, ...], a: tuple[float, float], b: tuple[float, float]
) -> None:
    path = floor_of(*obstacles).path(a, b)
    for (x0, y0), (x1, y1) in pairwise(path):
        for part in np.linspace(0.0, 1.0, 5):
            x, y = x0 + part * (x1 - x0), y0 + part * (y1 - y0)
            assert distance_to_boxes(x, y, obstacles) >= RADIUS - 1e-5


@settings(max_examples=40, deadline=None)
@given(solids(), st.lists(places(), min_size=20, max_size=20))
def test_an_enemy_can_stand_wherever_it_overlaps_no_obstacle(
    obstacles: tuple[Solid, ...], spots: list[tuple[float, float]]
) -> None:
    floor = floor_of(*obstacles)
    for x, y in spots:
        inside = RADIUS <= x <= 10.0 - RADIUS and RADIUS <= y <= 8.0 - RADIUS
        assert floor.is_free(x, y) == (inside and not any(a < x < c and b < y < d for a, b, c, d in floor.obstacles))
        entry = floor.entry((x, y))
        assert entry is None or floor.is_clear((x, y), floor.centres[entry])
