from __future__ import annotations

from math import floor

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.runtime.stealth.enemy_levels import bounds, box, level, low, solids, wall
from tltl_runtime.stealth.level import Barrier, MapSensor, Point, Solid, Switch
from tltl_runtime.stealth.levels.level_tables import CELL_TYPES
from tltl_runtime.stealth.observation.semantic_map import SemanticMap
from tltl_runtime.stealth.observation.voxels import Voxels

SENSOR = MapSensor(CELL_TYPES, 0.5, 11)
IDS = {name: 1 + index for index, name in enumerate(CELL_TYPES)}
DOOR = Barrier("door", "solid", box(6.0, 4.0, 6.2, 4.5), ())
LASER = Barrier("laser", "laser", box(4.0, 4.0, 4.2, 4.5), ())


def name_at(cells: np.ndarray[tuple[int, int], np.dtype[np.uint8]], x: float, y: float) -> str:
    """Return the cell type at a place, in a map around (5.2, 4.2); empty if there is none."""
    number = int(cells[5 + floor(y / 0.5) - 8, 5 + floor(x / 0.5) - 10])
    return CELL_TYPES[number - 1] if number else ""


def test_a_map_shows_the_type_of_each_cell() -> None:
    game = level(
        wall(3.0, 4.0, 3.3, 4.3),
        low(5.0, 6.0, 5.5, 6.5),
        barriers=(DOOR, LASER),
        switches=(Switch("s1", (5.2, 5.2, 0.0), 0.5),),
        map_sensor=SENSOR,
    )
    semantic_map = SemanticMap(game)
    cells = semantic_map.look((5.2, 4.2, 0.0), movers=[bounds(7.0, 3.0, 7.5, 3.5)], enemies=[(5.25, 2.75, 0.0)])
    assert cells.shape == (11, 11)
    assert cells.dtype == np.uint8
    expected = {
        (5.2, 4.2): "floor",
        (3.1, 4.1): "wall",
        (5.2, 6.2): "low",
        (6.1, 4.2): "barrier",
        (4.1, 4.2): "laser",
        (5.2, 5.2): "switch",
        (7.2, 3.2): "mover",
        (5.2, 2.7): "enemy",
        (7.2, 4.2): "floor",
    }
    assert {place: name_at(cells, *place) for place in expected} == expected


def test_an_open_barrier_is_not_shown_until_the_reset() -> None:
    semantic_map = SemanticMap(level(barriers=(DOOR, LASER), map_sensor=SENSOR))
    semantic_map.set_open(0, True)
    cells = semantic_map.look((5.2, 4.2, 0.0))
    assert (name_at(cells, 6.1, 4.2), name_at(cells, 4.1, 4.2)) == ("floor", "laser")
    semantic_map.reset()
    assert name_at(semantic_map.look((5.2, 4.2, 0.0)), 6.1, 4.2) == "barrier"


def test_a_low_passage_is_free_for_a_crouching_player() -> None:
    beam = Solid("beam", "wall", box(6.0, 4.0, 6.5, 4.5, 1.2, 3.0))
    semantic_map = SemanticMap(level(beam, map_sensor=SENSOR))
    assert name_at(semantic_map.look((5.2, 4.2, 0.0)), 6.2, 4.2) == "wall"
    assert name_at(semantic_map.look((5.2, 4.2, 0.0), crouching=True), 6.2, 4.2) == "floor"


def test_a_map_on_a_platform_does_not_show_the_floor() -> None:
    platform = Solid("platform", "platform", box(5.0, 4.0, 6.0, 5.0, 0.0, 1.0))
    semantic_map = SemanticMap(level(platform, map_sensor=SENSOR))
    cells = semantic_map.look((5.2, 4.2, 1.0))
    assert (name_at(cells, 5.7, 4.2), name_at(cells, 6.2, 4.2)) == ("platform", "")
    assert name_at(semantic_map.look((5.2, 4.2, 2.0)), 5.2, 4.2) == ""


def test_only_requested_types_are_shown() -> None:
    game = level(wall(6.0, 4.0, 6.5, 4.5), map_sensor=MapSensor(("low",), 0.5, 3))
    assert not SemanticMap(game).look((5.2, 4.2, 0.0), enemies=[(5.2, 4.2, 0.0)]).any()


def test_changing_a_map_changes_no_later_one() -> None:
    semantic_map = SemanticMap(level(map_sensor=SENSOR))
    cells = semantic_map.look((5.2, 4.2, 0.0))
    cells[:] = 0
    assert semantic_map.look((5.2, 4.2, 0.0)).any()


def test_one_hot_has_a_layer_for_each_type() -> None:
    semantic_map = SemanticMap(level(wall(6.0, 4.0, 6.5, 4.5), map_sensor=SENSOR))
    ids = semantic_map.look((5.2, 4.2, 0.0))
    layers = semantic_map.one_hot(ids)
    assert layers.shape == (len(CELL_TYPES), 11, 11)
    for name, number in IDS.items():
        assert np.array_equal(layers[number - 1], ids == number), name


def test_a_map_needs_a_sensor_with_known_types() -> None:
    with pytest.raises(ValueError, match="a map has no type 'water': there are floor, platform"):
        Voxels(level(), MapSensor(("water",), 0.5, 3))
    with pytest.raises(ValueError, match="include no map"):
        SemanticMap(level())


@settings(max_examples=60, deadline=None)
@given(
    solids(),
    st.tuples(st.floats(-2, 12), st.floats(-2, 10), st.floats(-3, 6)),
    st.sampled_from([0.25, 0.4, 0.5, 1.0]),
    st.booleans(),
    st.lists(st.tuples(st.floats(-1, 10), st.floats(-1, 8), st.floats(0.1, 2.0)), max_size=3),
)
def test_a_map_agrees_with_the_boxes_in_each_cell(
    obstacles: tuple[Solid, ...],
    position: Point,
    cell: float,
    crouching: bool,
    moving: list[tuple[float, float, float]],
) -> None:
    sensor = MapSensor(("floor", "wall", "mover"), cell, 5)
    game = level(*obstacles)
    movers = [bounds(x, y, x + size, y + size) for x, y, size in moving]
    cells = SemanticMap(game, sensor).look(position, crouching, movers)
    x, y = (min(max(position[i], 0.0), game.bounds.high[i] - 1e-9) for i in range(2))
    feet = min(max(floor(position[2] * 4 + 0.5), -4), 15) / 4
    height = 0.9 if crouching else 1.8
    for row in range(5):
        for column in range(5):
            west, south = (floor(x / cell) + column - 2) * cell, (floor(y / cell) + row - 2) * cell

            def covers(low: Point, high: Point, slack: float, west: float = west, south: float = south) -> bool:
                flat = low[0] < west + cell - slack and high[0] > west + slack
                return flat and low[1] < south + cell - slack and high[1] > south + slack

            number = int(cells[row, column])
            for slack in (1e-4, -1e-4):
                expected = 0
                for solid in game.solids:
                    at_height = solid.box.high[2] > feet - 0.1 and solid.box.low[2] < feet + height
                    if at_height and covers(solid.box.low, solid.box.high, slack):
                        expected = max(expected, 1 if solid.kind == "floor" else 2)
                for begin, end in movers:
                    at_height = begin[2] < position[2] + height and end[2] > position[2] - 0.1
                    if at_height and covers(begin, end, slack):
                        expected = 3
                if slack > 0:
                    assert number >= expected
                else:
                    assert number <= expected
