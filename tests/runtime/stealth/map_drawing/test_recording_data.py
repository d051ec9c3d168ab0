"""The data of an episode in the page match the recording."""

from __future__ import annotations

import json
from itertools import pairwise
from math import degrees
from typing import Any

import pytest

from tests.runtime.game.test_packing import unstepped
from tests.runtime.regression.page import samples
from tltl_runtime.stealth.map_drawing.recording_data import recording_data
from tltl_runtime.stealth.recordings.episode import Episode


def unrun(packed: list[list[Any]]) -> list[Any]:
    return [value for value, count in packed for _ in range(count)]


@pytest.fixture(params=["navigation", "cover_and_hide", "branching"])
def episode(request: pytest.FixtureRequest) -> Episode:
    if request.param == "navigation":
        return samples.navigation()[0]
    if request.param == "cover_and_hide":
        return samples.cover_and_hide_failed()[0]
    return samples.branching()[0]


def test_every_row_of_the_recording_is_in_the_data(episode: Episode) -> None:
    data = json.loads(json.dumps(recording_data(4, episode)))
    shots, bounds = episode.snapshots, episode.level.bounds
    assert data["index"] == 4
    assert unrun(data["state"]) == episode.states.tolist()
    assert unstepped(data["time"]) == [round(1000 * shot.time) for shot in shots]
    for name, values in (("progress", episode.progress / 0.001), ("health", [100 * shot.health for shot in shots])):
        assert unrun(data[name]) == pytest.approx(list(values), abs=0.501)
    bodies = [(data["player"], [(shot.player.position, shot.player.yaw) for shot in shots])]
    for row in range(len(episode.level.enemies)):
        bodies.append((data["enemies"][row], [(shot.enemies[row], shot.yaws[row]) for shot in shots]))
        assert unrun(data["enemies"][row]["mode"]) == [shot.modes[row] for shot in shots]
        assert unrun(data["enemies"][row]["sees"]) == [shot.sees[row] for shot in shots]
    for body, poses in bodies:
        xs, ys, yaws = (unstepped(body[name]) for name in ("x", "y", "yaw"))
        for x, y, yaw, ((east, north, _), angle) in zip(xs, ys, yaws, poses, strict=True):
            assert x / 100 == pytest.approx(east - bounds.low[0], abs=0.00501)
            assert y / 100 == pytest.approx(bounds.high[1] - north, abs=0.00501)
            assert (yaw - degrees(angle) + 180) % 360 - 180 == pytest.approx(0, abs=0.51)
        # A difference of more than half a turn would turn the drawn body the wrong way.
        assert all(abs(one - other) <= 180 for one, other in pairwise(yaws))
    for place in range(len(episode.level.barriers)):
        assert unrun(data["open"][place]) == [shot.open[place] for shot in shots]
    for place in range(len(episode.level.switches)):
        assert unrun(data["active"][place]) == [shot.active[place] for shot in shots]
    assert len(data["movers"]) == len(episode.level.movers)
    for column, known_values in zip(data["atoms"], episode.atoms.T.tolist(), strict=True):
        assert [value / 100 for value in unstepped(column)] == pytest.approx(known_values, abs=0.00501)


def test_a_row_takes_few_bytes() -> None:
    episode = samples.branching()[0]
    assert len(json.dumps(recording_data(0, episode), separators=(",", ":"))) < 60 * len(episode.actions)
