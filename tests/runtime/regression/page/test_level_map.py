"""The map of a level as SVG."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from tltl_runtime.regression.explain.places import place_name
from tltl_runtime.regression.report.page.level_map import level_map, map_data, map_key
from tltl_runtime.regression.report.page.map_names import is_spoken_of
from tltl_runtime.stealth.level import Box, Solid
from tltl_runtime.stealth.levels.file import level_names, load_level
from tltlc.core.record import replace


@pytest.mark.parametrize("name", level_names())
def test_a_map_has_what_the_level_has(name: str) -> None:
    level = load_level(name)
    root = ElementTree.fromstring(level_map(level))
    kinds = [each.get("class", "").split() for each in root.iter()]
    assert sum("solid" in kind and "barrier" not in kind for kind in kinds) == len(level.solids)
    for kind, known in (
        ("barrier", level.barriers),
        ("switch", level.switches),
        ("exit", level.exits),
        ("route", level.enemies),
        ("mover-way", level.movers),
        ("region", level.regions),
    ):
        assert sum(kind in each for each in kinds) == len(known), kind
    texts = [name for name, *_ in names_on(root)]
    assert {switch.name for switch in level.switches} <= set(texts)
    assert {region.name.replace("_", " ") for region in level.regions} <= set(texts)
    assert {enemy.name for enemy in level.enemies} <= set(texts)


def names_on(root: ElementTree.Element) -> list[tuple[str, str, float, float]]:
    """The names on a map: text, class, and where the first line begins or has its middle, and its foot."""
    return [
        (
            " ".join(line.text or "" for line in each.iter("tspan")),
            each.get("class", ""),
            float(each.get("x", "nan")),
            float(each.get("y", "nan")),
        )
        for each in root.iter("text")
    ]


@pytest.mark.parametrize("name", level_names())
@pytest.mark.parametrize("variant", ["v0", "v2"])
def test_names_of_regions_stand_where_places_are_called_so(name: str, variant: str) -> None:
    level = load_level(name, variant)
    shown = {
        name: (x, y)
        for name, kind, x, y in names_on(ElementTree.fromstring(level_map(level)))
        if kind.startswith("region-name")
    }
    assert len(shown) == len(level.regions)
    for row, region in enumerate(level.regions):
        x, y = shown[text := region.name.replace("_", " ")]
        place = (level.bounds.low[0] + x / 100, level.bounds.high[1] - (y - 10) / 100, 0.1)
        assert place_name(replace(level, regions=(region,)), place) == f"in the {text}"
        if not any(within(region.box, other.box) for other in level.regions[:row]):
            assert place_name(level, place) == f"in the {text}"


def within(box: Box, other: Box) -> bool:
    """Whether one lies in the other, seen from above: no place is called by its name then."""
    lows = zip(other.low[:2], box.low[:2], strict=True)
    return all(low <= its for low, its in lows) and all(
        its <= high for its, high in zip(box.high[:2], other.high[:2], strict=True)
    )


def test_what_sentences_speak_of_stands_out() -> None:
    level = load_level("navigation", "v2")
    said = "nobody reaches `s2`: the way ends at `corridor_block_2`\nruns out of time in the corridor"
    root = ElementTree.fromstring(level_map(level, said))
    outlined = [each.findtext("title") for each in root.iter("rect") if "spoken" in each.get("class", "").split()]
    assert outlined == ["corridor_block_2"]
    assert {name for name, kind, *_ in names_on(root) if "spoken" in kind} == {"s2", "corridor_block_2", "corridor"}
    assert "a reason speaks of it" in map_key(level, said) and "a reason speaks of it" not in map_key(level)
    quiet = names_on(ElementTree.fromstring(level_map(level)))
    assert "corridor_block_2" not in {name for name, *_ in quiet} and not any("spoken" in kind for _, kind, *_ in quiet)


@pytest.mark.parametrize("said", ["`wall.far_wall` new", "`wall.far_wall.at` [1, 2] → [3, 4]", "at `far_wall`"])
def test_keys_of_a_thing_are_names_of_it(said: str) -> None:
    assert is_spoken_of("far_wall", said)
    assert not is_spoken_of("wall_", said) and not is_spoken_of("far", said)


def test_a_patrol_there_and_back_is_drawn_once() -> None:
    level = load_level("cover_and_hide")
    enemy = replace(level.enemies[0], route=((8.0, 4.0, 0.0), (12.0, 4.0, 0.0)))
    root = ElementTree.fromstring(level_map(replace(level, enemies=(enemy,))))
    (route,) = [each.get("d", "") for each in root.iter("path") if each.get("class") == "route"]
    stretches = [frozenset(each.split("L")) for each in route.split("M")[1:]]
    assert stretches and len(set(stretches)) == len(stretches)


def test_names_of_things_do_not_cover_each_other() -> None:
    shown = names_on(ElementTree.fromstring(level_map(load_level("branching"))))
    places = {name: (x, y) for name, kind, x, y in shown if not kind.startswith("region-name")}
    (x, y), (other_x, other_y) = places["guard_2"], places["e_right"]
    assert abs(x - other_x) < 100 and abs(y - other_y) >= 40


def test_names_of_things_that_stand_in_one_place_do_not_cover_each_other() -> None:
    level = load_level("navigation", "v2")
    box = next(each.box for each in level.solids if each.name == "corridor_block_2")
    walls = tuple(Solid(f"corridor_block_{number}", "wall", box) for number in range(10, 22))
    said = " ".join(f"`{wall.name}`" for wall in walls)
    level = replace(level, solids=(*level.solids, *walls))
    shown = {name: (x, y) for name, kind, x, y in names_on(ElementTree.fromstring(level_map(level, said)))}
    places = [shown[wall.name] for wall in walls]
    for row, (x, y) in enumerate(places):
        assert not any(abs(x - other_x) < 300 and abs(y - other_y) < 40 for other_x, other_y in places[:row])


@pytest.mark.parametrize("name", level_names())
def test_all_of_it_lies_within(name: str) -> None:
    root = ElementTree.fromstring(level_map(load_level(name)))
    left, top, width, height = map(float, root.get("viewBox", "").split())
    for each in root.iter("rect"):
        x, y, wide, high = (float(each.get(key, "nan")) for key in ("x", "y", "width", "height"))
        assert left <= x and top <= y and x + wide <= left + width and y + high <= top + height
        assert wide > 0 and high > 0


def test_south_is_below() -> None:
    level = load_level("navigation")
    root = ElementTree.fromstring(level_map(level))
    (start,) = [each for each in root.iter("circle") if each.get("class") == "start"]
    x, y, _ = level.start.position
    assert float(start.get("cx", "nan")) == round(100 * (x - level.bounds.low[0]))
    assert float(start.get("cy", "nan")) == round(100 * (level.bounds.high[1] - y))


def test_layers_come_in_their_order() -> None:
    root = ElementTree.fromstring(level_map(load_level("branching")))
    layers = [each.get("class") for each in root if each.tag == "g"]
    assert layers == ["heat", "ways", "ends", "names", "live"]


def test_the_key_explains_what_there_is_alone() -> None:
    words = {}
    for name in ("navigation", "branching"):
        root = ElementTree.fromstring(map_key(load_level(name)))
        words[name] = ["".join(each.itertext()) for each in root.iter("li")]
    assert {"laser", "route of an enemy", "way of a moving obstacle"} <= set(words["branching"])
    assert not {"laser", "route of an enemy", "way of a moving obstacle"} & set(words["navigation"])
    assert {"start", "switch", "exit", "gate", "wall"} <= set(words["navigation"])


def test_data_of_a_map_have_what_stops_sight_and_who_sees() -> None:
    level = load_level("branching")
    data = map_data(level)
    assert len(data["blocks"]) == sum(solid.kind != "floor" for solid in level.solids)
    assert [each["kind"] for each in data["barriers"]] == [barrier.kind for barrier in level.barriers]
    for each, enemy in zip(data["enemies"], level.enemies, strict=True):
        assert each["reach"] == round(100 * enemy.kind.sight_range) and 0 < each["angle"] <= 360
    assert all(left < right and top < bottom and low < high for left, top, right, bottom, low, high in data["blocks"])
