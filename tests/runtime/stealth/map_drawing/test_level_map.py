"""The map of a level as SVG."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from tltl_runtime.game.mentions import Mentions
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.explain.places import place_phrase
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.page.mentions import report_mentions
from tltl_runtime.stealth.level import Box, Solid
from tltl_runtime.stealth.level_maps import StealthMaps
from tltl_runtime.stealth.levels.file import level_names, load_level
from tltl_runtime.stealth.map_drawing.level_map import level_map, map_data, map_key
from tltlc.core.record import replace

MAPS = StealthMaps()


@pytest.mark.parametrize("name", level_names())
def test_a_map_draws_everything_in_the_level(name: str) -> None:
    level = load_level(name)
    root = ElementTree.fromstring(level_map(level))
    class_lists = [element.get("class", "").split() for element in root.iter()]
    assert sum("solid" in kind and "barrier" not in kind for kind in class_lists) == len(level.solids)
    for kind, things in (
        ("barrier", level.barriers),
        ("switch", level.switches),
        ("exit", level.exits),
        ("route", level.enemies),
        ("mover-path", level.movers),
        ("region", level.regions),
    ):
        assert sum(kind in classes for classes in class_lists) == len(things), kind
    texts = [name for name, *_ in names_on(root)]
    assert {switch.name for switch in level.switches} <= set(texts)
    assert {region.name.replace("_", " ") for region in level.regions} <= set(texts)
    assert {enemy.name for enemy in level.enemies} <= set(texts)


def names_on(root: ElementTree.Element) -> list[tuple[str, str, float, float]]:
    """The names on a map: text, class, and the x and y of the first line (its start or middle, its baseline)."""
    return [
        (
            " ".join(line.text or "" for line in element.iter("tspan")),
            element.get("class", ""),
            float(element.get("x", "nan")),
            float(element.get("y", "nan")),
        )
        for element in root.iter("text")
    ]


@pytest.mark.parametrize("name", level_names())
@pytest.mark.parametrize("variant", ["v0", "v2"])
def test_names_of_regions_stand_inside_their_regions(name: str, variant: str) -> None:
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
        assert place_phrase(replace(level, regions=(region,)), place).text == f"in the {text}"
        if not any(within(region.box, other.box) for other in level.regions[:row]):
            assert place_phrase(level, place).text == f"in the {text}"


def within(box: Box, other: Box) -> bool:
    """Whether ``box`` lies in ``other``, seen from above; then no place is called by the name of ``box``."""
    lows = zip(other.low[:2], box.low[:2], strict=True)
    return all(low <= its for low, its in lows) and all(
        its <= high for its, high in zip(box.high[:2], other.high[:2], strict=True)
    )


def test_things_named_in_the_reasons_are_highlighted() -> None:
    level = load_level("navigation", "v2")
    mentioned = Mentions(("s2", "corridor_block_2", "another"), ("corridor",))
    root = ElementTree.fromstring(level_map(level, mentioned))
    outlined = [
        element.findtext("title") for element in root.iter("rect") if "mentioned" in element.get("class", "").split()
    ]
    assert outlined == ["corridor_block_2"]
    assert {name for name, kind, *_ in names_on(root) if "mentioned" in kind} == {"s2", "corridor_block_2", "corridor"}
    assert "mentioned in a reason" in map_key(level, mentioned) and "mentioned in a reason" not in map_key(level)
    quiet = names_on(ElementTree.fromstring(level_map(level)))
    assert "corridor_block_2" not in {name for name, *_ in quiet} and not any(
        "mentioned" in kind for _, kind, *_ in quiet
    )


@pytest.mark.parametrize("sentence", ["The `wall.far_wall` is new.", "Moves `wall.far_wall.at`.", "Opens `far_wall`."])
def test_a_description_mentions_a_thing_by_its_name_or_a_key(sentence: str) -> None:
    level = load_level("navigation")
    walls = tuple(replace(level.solids[0], name=name) for name in ("far_wall", "wall_", "far"))
    assert MAPS.mentions(replace(level, solids=walls), sentence).things == ("far_wall",)


def test_only_descriptions_are_searched_for_names() -> None:
    level = load_level("navigation", "v2")
    report = CaseReport(
        "a",
        "navigation",
        "v2",
        "fail",
        ("nobody can reach `s2`", "moves `corridor_block_2`"),
        explanation=(Finding("dies at `exit`", (), mentions=Mentions(("corridor_block_1",), ("corridor",))),),
        edits=("Moves `corridor_block_2`.",),
        mentions=Mentions(("s1",)),
        descriptions=("Moves `corridor_block_2`.",),
    )
    assert report_mentions(MAPS, level, report) == Mentions(
        ("s1", "corridor_block_1", "corridor_block_2"), ("corridor",)
    )


def test_a_description_mentions_the_longest_name_of_a_region() -> None:
    level = load_level("navigation")
    regions = tuple(replace(level.regions[0], name=name) for name in ("left", "left_part", "middle"))
    named = replace(level, regions=regions)
    assert MAPS.mentions(named, "Shuts the left part for the middle-aged guard").regions == ("left_part",)
    assert MAPS.mentions(named, "Near the left and the middle.").regions == ("left", "middle")


def test_a_patrol_there_and_back_is_drawn_once() -> None:
    level = load_level("cover_and_hide")
    enemy = replace(level.enemies[0], route=((8.0, 4.0, 0.0), (12.0, 4.0, 0.0)))
    root = ElementTree.fromstring(level_map(replace(level, enemies=(enemy,))))
    (route,) = [element.get("d", "") for element in root.iter("path") if element.get("class") == "route"]
    segments = [frozenset(segment.split("L")) for segment in route.split("M")[1:]]
    assert segments and len(set(segments)) == len(segments)


def test_names_of_things_do_not_cover_each_other() -> None:
    shown = names_on(ElementTree.fromstring(level_map(load_level("branching"))))
    places = {name: (x, y) for name, kind, x, y in shown if not kind.startswith("region-name")}
    (x, y), (other_x, other_y) = places["guard_2"], places["e_right"]
    assert abs(x - other_x) < 100 and abs(y - other_y) >= 40


def test_names_of_things_in_the_same_place_do_not_cover_each_other() -> None:
    level = load_level("navigation", "v2")
    box = next(solid.box for solid in level.solids if solid.name == "corridor_block_2")
    walls = tuple(Solid(f"corridor_block_{number}", "wall", box) for number in range(10, 22))
    level = replace(level, solids=(*level.solids, *walls))
    mentioned = Mentions(tuple(wall.name for wall in walls))
    shown = {name: (x, y) for name, kind, x, y in names_on(ElementTree.fromstring(level_map(level, mentioned)))}
    places = [shown[wall.name] for wall in walls]
    for row, (x, y) in enumerate(places):
        assert not any(abs(x - other_x) < 300 and abs(y - other_y) < 40 for other_x, other_y in places[:row])


@pytest.mark.parametrize("name", level_names())
def test_everything_lies_within_the_view(name: str) -> None:
    root = ElementTree.fromstring(level_map(load_level(name)))
    left, top, width, height = map(float, root.get("viewBox", "").split())
    for element in root.iter("rect"):
        x, y, wide, high = (float(element.get(key, "nan")) for key in ("x", "y", "width", "height"))
        assert left <= x and top <= y and x + wide <= left + width and y + high <= top + height
        assert wide > 0 and high > 0


def test_south_is_below() -> None:
    level = load_level("navigation")
    root = ElementTree.fromstring(level_map(level))
    (start,) = [element for element in root.iter("circle") if element.get("class") == "start"]
    x, y, _ = level.start.position
    assert float(start.get("cx", "nan")) == round(100 * (x - level.bounds.low[0]))
    assert float(start.get("cy", "nan")) == round(100 * (level.bounds.high[1] - y))


def test_layers_are_in_order() -> None:
    root = ElementTree.fromstring(level_map(load_level("branching")))
    layers = [element.get("class") for element in root if element.tag == "g"]
    assert layers == ["heat", "trajectories", "ends", "names", "live"]


def test_the_key_explains_only_what_is_drawn() -> None:
    words = {}
    for name in ("navigation", "branching"):
        root = ElementTree.fromstring(map_key(load_level(name)))
        words[name] = ["".join(element.itertext()) for element in root.iter("li")]
    assert {"laser", "route of an enemy", "way of a moving obstacle"} <= set(words["branching"])
    assert not {"laser", "route of an enemy", "way of a moving obstacle"} & set(words["navigation"])
    assert {"start", "switch", "exit", "gate", "wall"} <= set(words["navigation"])


def test_the_data_of_a_map_include_sight_blockers_and_enemies() -> None:
    level = load_level("branching")
    data = map_data(level)
    assert len(data["blocks"]) == sum(solid.kind != "floor" for solid in level.solids)
    assert [barrier_data["kind"] for barrier_data in data["barriers"]] == [barrier.kind for barrier in level.barriers]
    for enemy_data, enemy in zip(data["enemies"], level.enemies, strict=True):
        assert enemy_data["reach"] == round(100 * enemy.kind.sight_range) and 0 < enemy_data["angle"] <= 360
    assert all(left < right and top < bottom and low < high for left, top, right, bottom, low, high in data["blocks"])
