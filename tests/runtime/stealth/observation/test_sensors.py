"""What an agent senses, chosen beside what its level declares."""

from __future__ import annotations

from typing import Any

import pytest

from tltl_runtime.stealth.level import MapSensor, Sensors
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.observation.sensors import DEFAULT_MAP, chosen
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

LEVEL = load_level("navigation")
OWN = LEVEL.sensors


@pytest.mark.parametrize(
    ("choice", "expected"),
    [
        (None, OWN),
        ({}, OWN),
        ({"entities": ["exit"]}, replace(OWN, entities=("exit",))),
        ({"entities": ()}, replace(OWN, entities=())),
        ({"variables": ["health", "active(s1)"]}, replace(OWN, variables=("health", "active(s1)"))),
        ({"map": None}, replace(OWN, map=None)),
        ({"map": {"cell": 1}}, replace(OWN, map=replace(OWN.map, cell=1.0))),
        ({"map": {"types": ["wall"], "extent": 3}}, replace(OWN, map=MapSensor(("wall",), 0.5, 3))),
        ({"map": MapSensor(("wall",), 1.0, 5)}, replace(OWN, map=MapSensor(("wall",), 1.0, 5))),
        (Sensors((), (), None), Sensors((), (), None)),
    ],
)
def test_chosen(choice: Any, expected: Sensors) -> None:
    assert chosen(LEVEL, choice) == expected


def test_a_level_without_a_map_gets_the_default_one() -> None:
    bare = replace(LEVEL, sensors=Sensors((), (), None))
    assert chosen(bare, {"map": {"cell": 1.0}}).map == replace(DEFAULT_MAP, cell=1.0)
    assert chosen(bare, {}).map is None


@pytest.mark.parametrize(
    ("choice", "title", "help_"),
    [
        ({"entities": ["s3"]}, "the level `navigation` has no entity `s3`", "there are: `s1`, `s2`"),
        ({"entities": "s1"}, "wrong value for `entities`", "list of names"),
        ({"variables": ["heath"]}, "has no signal `heath`", "did you mean `health`?"),
        ({"sight": []}, "sensors have no key `sight`", "`entities`"),
        ({"map": {"cells": 1}}, "a map has no key `cells`", "did you mean `cell`?"),
        ({"map": {"types": ["wal"]}}, "a map knows no type `wal`", "did you mean `wall`?"),
        ({"map": {"cell": float("nan")}}, "wrong value for `cell`", "from 0.1 to 5 m"),
        ({"map": {"cell": "wide"}}, "wrong value for `cell`", "from 0.1 to 5 m"),
        ({"map": {"extent": 65}}, "wrong value for `extent`", "from 3 to 63"),
        ({"map": {"extent": 8}}, "wrong value for `extent`", "odd"),
        ({"map": {"extent": True}}, "wrong value for `extent`", "odd"),
        ({"map": 3}, "wrong value for the map", "None"),
        (Sensors(("x",), (), None), "has no entity `x`", "`s1`"),
    ],
)
def test_what_cannot_be_sensed(choice: Any, title: str, help_: str) -> None:
    with pytest.raises(TltlError) as error:
        chosen(LEVEL, choice)
    (found,) = error.value.diagnostics
    assert found.code == "TLT0815"
    assert title in found.title and help_ in str(found.help)
