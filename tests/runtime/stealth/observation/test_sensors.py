"""A choice of sensors overrides the sensors that the level declares."""

from __future__ import annotations

from typing import Any

import pytest

from tltl_runtime.stealth.level import MapSensor, Sensors
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.observation.sensors import DEFAULT_MAP, choose_sensors
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

LEVEL = load_level("navigation")
DECLARED = LEVEL.sensors


@pytest.mark.parametrize(
    ("choice", "expected"),
    [
        (None, DECLARED),
        ({}, DECLARED),
        ({"entities": ["exit"]}, replace(DECLARED, entities=("exit",))),
        ({"entities": ()}, replace(DECLARED, entities=())),
        ({"variables": ["health", "active(s1)"]}, replace(DECLARED, variables=("health", "active(s1)"))),
        ({"map": None}, replace(DECLARED, map=None)),
        ({"map": {"cell": 1}}, replace(DECLARED, map=replace(DECLARED.map, cell=1.0))),
        ({"map": {"types": ["wall"], "extent": 3}}, replace(DECLARED, map=MapSensor(("wall",), 0.5, 3))),
        ({"map": MapSensor(("wall",), 1.0, 5)}, replace(DECLARED, map=MapSensor(("wall",), 1.0, 5))),
        (Sensors((), (), None), Sensors((), (), None)),
    ],
)
def test_a_choice_overrides_the_declared_sensors(choice: Any, expected: Sensors) -> None:
    assert choose_sensors(LEVEL, choice) == expected


def test_a_level_without_a_map_gets_the_default_one() -> None:
    bare = replace(LEVEL, sensors=Sensors((), (), None))
    assert choose_sensors(bare, {"map": {"cell": 1.0}}).map == replace(DEFAULT_MAP, cell=1.0)
    assert choose_sensors(bare, {}).map is None


@pytest.mark.parametrize(
    ("choice", "title", "help_"),
    [
        ({"entities": ["s3"]}, "the level `navigation` has no entity `s3`", "there are: `s1`, `s2`"),
        ({"entities": "s1"}, "wrong value for `entities`", "list of names"),
        ({"variables": ["heath"]}, "has no signal `heath`", "did you mean `health`?"),
        ({"sight": []}, "sensors have no key `sight`", "`entities`"),
        ({"map": {"cells": 1}}, "a map has no key `cells`", "did you mean `cell`?"),
        ({"map": {"types": ["wal"]}}, "a map has no type `wal`", "did you mean `wall`?"),
        ({"map": {"cell": float("nan")}}, "wrong value for `cell`", "from 0.1 to 5 m"),
        ({"map": {"cell": "wide"}}, "wrong value for `cell`", "from 0.1 to 5 m"),
        ({"map": {"extent": 65}}, "wrong value for `extent`", "from 3 to 63"),
        ({"map": {"extent": 8}}, "wrong value for `extent`", "odd"),
        ({"map": {"extent": True}}, "wrong value for `extent`", "odd"),
        ({"map": 3}, "wrong value for the map", "None"),
        (Sensors(("x",), (), None), "has no entity `x`", "`s1`"),
    ],
)
def test_invalid_choices_are_rejected(choice: Any, title: str, help_: str) -> None:
    with pytest.raises(TltlError) as error:
        choose_sensors(LEVEL, choice)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0815"
    assert title in diagnostic.title and help_ in str(diagnostic.help)
