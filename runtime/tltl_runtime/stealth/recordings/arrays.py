"""The arrays of an episode's file, and their conversion from and to an episode."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.recording_archive import Array, Arrays
from tltl_runtime.stealth.level import Point, StealthLevel
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.snapshot import BRANCHES, Snapshot
from tltl_runtime.stealth.world.player import PlayerState
from tltlc.api import Fspa

ARRAYS: Final = (
    Array("time", "<f8", ("n + 1",), "s", "since the reset", low=0.0),
    Array("position", "<f8", ("n + 1", 3), "m", "the player's feet: x east, y north, z up"),
    Array("velocity", "<f8", ("n + 1", 3), "m/s", "of the player"),
    Array("yaw", "<f8", ("n + 1",), "rad", "where the player looks: 0 along x, growing towards y"),
    Array("crouching", "|b1", ("n + 1",), "", "whether the player crouches"),
    Array("grounded", "|b1", ("n + 1",), "", "whether the player stands on something"),
    Array("stamina", "<f8", ("n + 1",), "1", "what is left for sprinting", low=0.0, high=1.0),
    Array("health", "<f8", ("n + 1",), "1", "of the player", low=0.0, high=1.0),
    Array("enemy_position", "<f8", ("n + 1", "enemies", 3), "m", "the enemies' feet"),
    Array("enemy_yaw", "<f8", ("n + 1", "enemies"), "rad", "where the enemies look"),
    Array("enemy_mode", "|u1", ("n + 1", "enemies"), "", "what the enemies do, as indices into `meta.modes`"),
    Array("enemy_sees", "|b1", ("n + 1", "enemies"), "", "whether the player is in an enemy's sight"),
    Array("mover_position", "<f8", ("n + 1", "movers", 3), "m", "the middle of the moving obstacles"),
    Array("switch_active", "|b1", ("n + 1", "switches"), "", "which switches are active"),
    Array("barrier_open", "|b1", ("n + 1", "barriers"), "", "which barriers are open"),
    Array("actions", "|u1", ("n", len(BRANCHES)), "", "x, y, jump, crouch, sprint, as the environments take them"),
    Array("signals", "<f8", ("n + 1", "signals"), "SI", "those of the spec; bools are 0 and 1"),
    Array("atoms", "<f8", ("n", "atoms"), "1", "robustness of the spec's atoms", low=-1.0, high=1.0),
    Array("states", "<i4", ("n + 1",), "", "of the automaton, from 0", low=0),
    Array("progress", "<f8", ("n + 1",), "1", "the best so far", low=0.0, high=1.0),
    Array("rewards", "<f8", ("n",), "1", "of the steps"),
)


def to_arrays(episode: Episode, modes: tuple[str, ...]) -> dict[str, NDArray[Any]]:
    """Convert an episode to the arrays of :data:`ARRAYS`.

    ``modes`` lists the modes of enemies: the array ``enemy_mode`` has indices into it.
    """
    shots = episode.snapshots
    index_of = {mode: number for number, mode in enumerate(modes)}
    columns = {
        "time": [shot.time for shot in shots],
        "position": [shot.player.position for shot in shots],
        "velocity": [shot.player.velocity for shot in shots],
        "yaw": [shot.player.yaw for shot in shots],
        "crouching": [shot.player.crouching for shot in shots],
        "grounded": [shot.player.grounded for shot in shots],
        "stamina": [shot.player.stamina for shot in shots],
        "health": [shot.health for shot in shots],
        "enemy_position": [shot.enemies for shot in shots],
        "enemy_yaw": [shot.yaws for shot in shots],
        "enemy_mode": [[index_of[mode] for mode in shot.modes] for shot in shots],
        "enemy_sees": [shot.sees for shot in shots],
        "mover_position": [shot.movers for shot in shots],
        "switch_active": [shot.active for shot in shots],
        "barrier_open": [shot.open for shot in shots],
        **{name: getattr(episode, name) for name in ("actions", "signals", "atoms", "states", "progress", "rewards")},
    }
    known = sizes(episode.level, episode.fspa, len(episode.actions))
    return {
        array.name: np.asarray(columns[array.name], dtype=array.dtype).reshape(array.actual_shape(known))
        for array in ARRAYS
    }


def snapshots(arrays: Arrays, modes: tuple[str, ...]) -> tuple[Snapshot, ...]:
    """Convert the arrays of a file to snapshots.

    ``modes`` lists the modes of enemies. The array ``enemy_mode`` has indices into this list, which
    must be valid.
    """
    lists = {name: array.tolist() for name, array in arrays.items()}
    player = zip(
        *(map(tuple, lists[name]) for name in ("position", "velocity")),
        *(lists[name] for name in ("yaw", "crouching", "grounded", "stamina")),
        strict=True,
    )
    rest = zip(
        lists["health"],
        map(_points, lists["enemy_position"]),
        map(tuple, lists["enemy_yaw"]),
        (tuple(modes[number] for number in row) for row in lists["enemy_mode"]),
        map(tuple, lists["enemy_sees"]),
        map(_points, lists["mover_position"]),
        map(tuple, lists["switch_active"]),
        map(tuple, lists["barrier_open"]),
        strict=True,
    )
    rows = zip(lists["time"], player, rest, strict=True)
    return tuple(Snapshot(time, PlayerState(*state), *remainder) for time, state, remainder in rows)


def sizes(level: StealthLevel, fspa: Fspa, count: int) -> dict[str, int]:
    """Return the lengths of the arrays' axes, by name, for an episode of ``count`` time steps."""
    return {
        "n": count,
        "n + 1": count + 1,
        "signals": len(fspa.signals),
        "atoms": len(fspa.atoms),
        "enemies": len(level.enemies),
        "movers": len(level.movers),
        "switches": len(level.switches),
        "barriers": len(level.barriers),
    }


def _points(points: list[list[float]]) -> tuple[Point, ...]:
    return tuple((x, y, z) for x, y, z in points)
