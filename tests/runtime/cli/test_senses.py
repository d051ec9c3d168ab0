"""The options of what an agent senses, from the command line to the mapping that environments take."""

from __future__ import annotations

from typing import Any

import click
import pytest
from click.testing import CliRunner

from tltl_runtime.cli.support.sensor_options import senses_options


def said(*arguments: str) -> tuple[Any, str]:
    """What a command with these options is given, and what it says."""
    given: list[Any] = []

    @click.command()
    @senses_options
    def command(sensors: dict[str, Any]) -> None:
        given.append(sensors)

    result = CliRunner().invoke(command, arguments)
    return (given[0] if given else None), result.output


@pytest.mark.parametrize(
    ("arguments", "sensors"),
    [
        ((), {}),
        (("--entities", "s1, exit"), {"entities": ["s1", "exit"]}),
        (("--variables", "health,distance(exit)"), {"variables": ["health", "distance(exit)"]}),
        (("--no-entities", "--no-variables", "--no-map"), {"entities": [], "variables": [], "map": None}),
        (
            ("--map", "cell=0.5,extent=15,types=wall,low"),
            {"map": {"cell": 0.5, "extent": 15, "types": ["wall", "low"]}},
        ),
        (("--map", "types=wall,low,cell=1"), {"map": {"types": ["wall", "low"], "cell": 1.0}}),
        (("--map", "size=3"), {"map": {"size": "3"}}),
    ],
)
def test_what_is_said(arguments: tuple[str, ...], sensors: dict[str, Any]) -> None:
    assert said(*arguments)[0] == sensors


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--entities", "s1,,exit"), "`s1,,exit` is not of the form A,B"),
        (("--map", "0.5"), "is not of the form cell=0.5"),
        (("--map", ""), "is not of the form cell=0.5"),
        (("--map", "cell=wide"), "`cell` is a number, not `wide`"),
        (("--map", "cell=1,2"), "`cell` is a number, not `1,2`"),
        (("--map", "extent=1.5"), "`extent` is a whole number, not `1.5`"),
        (("--map", "cell=1,cell=2"), "`cell` is given twice"),
        (("--map", "cell=1", "--no-map"), "--map and --no-map exclude each other"),
    ],
)
def test_what_cannot_be_said(arguments: tuple[str, ...], message: str) -> None:
    sensors, output = said(*arguments)
    assert sensors is None
    assert message in " ".join(output.split())
