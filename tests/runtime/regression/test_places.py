"""Names of places in a level, and the obstacles at a place."""

from __future__ import annotations

import pytest

from tests.runtime.regression.handmade import ROOM
from tltl_runtime.regression.explain.places import blocking_solids, nearest_entity, place_phrase
from tltl_runtime.stealth.level import Box, Point, StealthLevel
from tltl_runtime.stealth.levels.file import load_level
from tltlc.core.record import replace

MORE = """[[region]]
name = "dark_corner"
at = [1.5, 8.5, 0.0]
size = [2.0, 2.0, 3.0]
[[region]]
name = "west"
at = [1.5, 5.0, 0.0]
size = [2.0, 9.6, 3.0]
[[switch]]
name = "lever"
at = [5.0, 2.0, 0.0]
[[wall]]
name = "pillar"
at = [7.0, 5.0, 0.0]
size = [1.0, 1.0, 3.0]
"""


def ends(*feet: Point) -> list[tuple[Point, tuple[str, ...]]]:
    """The positions of players, without closed barriers."""
    return [(position, ()) for position in feet]


@pytest.fixture(name="level", scope="module")
def _level(tmp_path_factory: pytest.TempPathFactory) -> StealthLevel:
    path = tmp_path_factory.mktemp("levels") / "room.toml"
    path.write_text(ROOM + MORE, encoding="utf-8")
    return load_level(str(path))


@pytest.mark.parametrize(
    ("point", "name"),
    [
        ((1.5, 8.5, 0.0), "in the dark corner"),
        ((1.5, 4.0, 0.0), "in the west"),
        ((6.0, 2.0, 0.0), "near `lever`"),
        ((8.0, 6.0, 0.0), "near `exit`"),
        ((5.2, 5.0, 0.0), "in the middle"),
        ((9.0, 3.0, 0.0), "in the south-east"),
        ((5.2, 9.0, 0.0), "in the north"),
        ((9.4, 5.0, 0.0), "in the east"),
    ],
)
def test_a_place_is_named_by_region_then_entity_then_direction(level: StealthLevel, point: Point, name: str) -> None:
    assert place_phrase(level, point).text == name


def test_the_nearest_entity_is_within_two_and_a_half_metres(level: StealthLevel) -> None:
    assert nearest_entity(level, (5.0, 4.4, 0.0)) == "lever"
    assert nearest_entity(level, (5.0, 4.6, 0.0)) is None


def test_an_obstacle_of_most_players_is_in_the_way(level: StealthLevel) -> None:
    at_pillar = [(6.2, 4.8 + row / 10, 0.0) for row in range(5)]
    assert blocking_solids(level, ends(*at_pillar)) == ["pillar"]
    assert blocking_solids(level, ends((4.0, 5.0, 0.0), (4.0, 5.0, 0.0))) == []
    # Half of the players are elsewhere, so no obstacle stopped most of them.
    assert blocking_solids(level, ends(*at_pillar[:2], (4.0, 5.0, 0.0), (4.0, 5.0, 0.0))) == []
    assert blocking_solids(level, []) == []


def test_in_a_corner_all_touched_walls_are_named_most_frequent_first(level: StealthLevel) -> None:
    corner, wall = (9.6, 0.4, 0.0), (9.6, 4.0, 0.0)
    assert blocking_solids(level, ends(corner, corner, wall)) == ["outer_east", "outer_south"]
    assert blocking_solids(level, ends(corner, wall, wall)) == ["outer_east"]


def test_a_solid_below_the_feet_is_not_in_the_way(level: StealthLevel) -> None:
    assert blocking_solids(level, ends((7.0, 5.0, 3.0))) == []


def test_a_gate_is_in_the_way_while_it_is_closed() -> None:
    level = load_level("navigation")
    (gate, *_) = (barrier for barrier in level.barriers if barrier.kind == "solid")
    at_gate = gate.box.low[0] - 0.4, (gate.box.low[1] + gate.box.high[1]) / 2, gate.box.low[2]
    assert gate.name in blocking_solids(level, [(at_gate, (gate.name,))])
    assert gate.name not in blocking_solids(level, [(at_gate, ())])


def test_a_solid_behind_another_one_is_not_in_the_way(level: StealthLevel) -> None:
    pillar = next(solid for solid in level.solids if solid.name == "pillar")
    low = (pillar.box.high[0], pillar.box.low[1], 0.0)
    behind = replace(pillar, name="behind", box=Box(low, (low[0] + 1.0, pillar.box.high[1], 3.0)))
    thin = replace(pillar, box=Box((low[0] - 0.2, low[1], 0.0), pillar.box.high))
    with_both = replace(level, solids=(*(solid for solid in level.solids if solid is not pillar), thin, behind))
    before = (low[0] - 0.5, 5.0, 0.0)
    assert blocking_solids(with_both, ends(before)) == ["pillar"]
    assert blocking_solids(replace(with_both, solids=with_both.solids[-1:]), ends(before)) == ["behind"]
