"""The map of a level as SVG."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from tltl_runtime.regression.page.level_map import level_map, map_data, map_key
from tltl_runtime.stealth.levels.file import level_names, load_level


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
    texts = [each.text for each in root.iter("text")]
    assert {switch.name for switch in level.switches} <= set(texts)
    assert {region.name.replace("_", " ") for region in level.regions} <= set(texts)


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
