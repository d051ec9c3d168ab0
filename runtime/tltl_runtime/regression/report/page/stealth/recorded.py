"""A recorded episode as data for the player of the page."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees
from typing import Any

import numpy as np

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.geometry import Box, Point
from tltl_runtime.regression.report.page.packing import across, down, runs, steps
from tltl_runtime.stealth.recordings.cause import cause
from tltl_runtime.stealth.recordings.episode import Episode


def recorded(index: int, episode: RecordedEpisode) -> dict[str, Any]:
    """Return episode ``index`` of a case as JSON data.

    An episode of n steps has n + 1 rows of each value, but n rows of atoms.  Lengths are in centimetres
    on the map, angles in degrees, times in milliseconds, shares and robustness in hundredths, progress
    in thousandths.  Values are encoded by :mod:`~tltl_runtime.regression.report.page.packing`.
    """
    assert isinstance(episode, Episode)
    shots, bounds = episode.snapshots, episode.level.bounds
    return {
        "index": index,
        "why": cause(episode).text,
        "time": steps((shot.time for shot in shots), 1000),
        "state": runs(episode.states.tolist()),
        "progress": runs(_scaled(episode.progress.tolist(), 1000)),
        "health": runs(_scaled([shot.health for shot in shots], 100)),
        "player": {
            **_way([shot.player.position for shot in shots], bounds),
            "yaw": _turns([shot.player.yaw for shot in shots]),
            "crouching": runs(int(shot.player.crouching) for shot in shots),
        },
        "enemies": [
            {
                **_way([shot.enemies[row] for shot in shots], bounds),
                "yaw": _turns([shot.yaws[row] for shot in shots]),
                "mode": runs(shot.modes[row] for shot in shots),
                "sees": runs(int(shot.sees[row]) for shot in shots),
            }
            for row in range(len(episode.level.enemies))
        ],
        "movers": [_way([shot.movers[row] for shot in shots], bounds) for row in range(len(episode.level.movers))],
        "active": [runs(int(shot.active[row]) for shot in shots) for row in range(len(episode.level.switches))],
        "open": [runs(int(shot.open[row]) for shot in shots) for row in range(len(episode.level.barriers))],
        "atoms": [steps(column, 100) for column in episode.atoms.T.tolist()],
    }


def _way(points: Sequence[Point], bounds: Box) -> dict[str, str]:
    return {"x": across(bounds, [x for x, _, _ in points]), "y": down(bounds, [y for _, y, _ in points])}


def _turns(yaws: Sequence[float]) -> str:
    """Encode yaw angles in degrees, unwrapped at half a turn so that they can be interpolated."""
    return steps((degrees(yaw) for yaw in np.unwrap(yaws).tolist()), 1)


def _scaled(values: Sequence[float], scale: float) -> list[int]:
    return [round(value * scale) for value in values]
