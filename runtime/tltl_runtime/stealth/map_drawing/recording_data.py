"""A recorded episode as data for the page, which plays it back."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees
from typing import Any

import numpy as np

from tltl_runtime.game.packing import position_steps, runs, scaled_runs, steps
from tltl_runtime.stealth.recordings.cause import cause
from tltl_runtime.stealth.recordings.episode import Episode


def recording_data(index: int, episode: Episode) -> dict[str, Any]:
    """Return an episode as JSON data for the report page.

    ``index`` is the number of the episode within its test case. For an episode of n steps, each
    list has n + 1 values, the first before step 1; lists about atoms have n. Lengths are in
    centimetres on the map, angles in degrees, times in milliseconds, health and robustness in
    hundredths, progress in thousandths. The functions of :mod:`~tltl_runtime.game.packing` encode
    the values.
    """
    snapshots, bounds = episode.snapshots, episode.level.bounds
    return {
        "index": index,
        "why": cause(episode).text,
        "time": steps((snapshot.time for snapshot in snapshots), 1000),
        "state": runs(episode.states.tolist()),
        "progress": scaled_runs(episode.progress.tolist(), 1000),
        "health": scaled_runs((snapshot.health for snapshot in snapshots), 100),
        "player": {
            **position_steps(bounds, [snapshot.player.position for snapshot in snapshots]),
            "yaw": _yaw_steps([snapshot.player.yaw for snapshot in snapshots]),
            "crouching": runs(int(snapshot.player.crouching) for snapshot in snapshots),
        },
        "enemies": [
            {
                **position_steps(bounds, [snapshot.enemies[row] for snapshot in snapshots]),
                "yaw": _yaw_steps([snapshot.yaws[row] for snapshot in snapshots]),
                "mode": runs(snapshot.modes[row] for snapshot in snapshots),
                "sees": runs(int(snapshot.sees[row]) for snapshot in snapshots),
            }
            for row in range(len(episode.level.enemies))
        ],
        "movers": [
            position_steps(bounds, [snapshot.movers[row] for snapshot in snapshots])
            for row in range(len(episode.level.movers))
        ],
        "active": [
            runs(int(snapshot.active[row]) for snapshot in snapshots) for row in range(len(episode.level.switches))
        ],
        "open": [runs(int(snapshot.open[row]) for snapshot in snapshots) for row in range(len(episode.level.barriers))],
        "atoms": [steps(column, 100) for column in episode.atoms.T.tolist()],
    }


def _yaw_steps(yaws: Sequence[float]) -> str:
    """Encode yaw angles, which are given in radians, as text in degrees.

    Where the angles would jump by a full turn, whole turns are added, so that the page can
    interpolate.
    """
    return steps((degrees(yaw) for yaw in np.unwrap(yaws).tolist()), 1)
