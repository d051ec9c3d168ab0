"""The sensor options: from the command line to the mapping that environments take."""

from __future__ import annotations

from typing import Any

import click
import pytest
from click.testing import CliRunner

from tltl_runtime.cli.support.sensor_options import sensor_options


def parsed(*arguments: str) -> tuple[Any, str]:
    """Invoke a command with these options; return the parsed sensors (None if rejected) and the output."""
    received: list[Any] = []

    @click.command()
    @sensor_options
    def command(sensors: dict[str, Any]) -> None:
        received.append(sensors)

    result = CliRunner().invoke(command, arguments)
    return (received[0] if received else None), result.output


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
def test_options_give_the_sensors(arguments: tuple[str, ...], sensors: dict[str, Any]) -> None:
    assert parsed(*arguments)[0] == sensors


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--entities", "s1,,exit"), "`s1,,exit` is not of the form A,B"),
        (("--map", "0.5"), "is not of the form cell=0.5"),
        (("--map", ""), "is not of the form cell=0.5"),
        (("--map", "cell=wide"), "`cell` must be a number, not `wide`"),
        (("--map", "cell=1,2"), "`cell` must be a number, not `1,2`"),
        (("--map", "extent=1.5"), "`extent` must be a whole number, not `1.5`"),
        (("--map", "cell=1,cell=2"), "`cell` is given twice"),
        (("--map", "cell=1", "--no-map"), "--map and --no-map cannot be used together"),
    ],
)
def test_invalid_options_are_rejected(arguments: tuple[str, ...], message: str) -> None:
    sensors, output = parsed(*arguments)
    assert sensors is None
    assert message in " ".join(output.split())
