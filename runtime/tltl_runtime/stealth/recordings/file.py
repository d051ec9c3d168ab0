"""Files of episodes: compressed NumPy archives. ``docs/episode-log.md`` describes every array."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Final, Literal

import numpy as np

from tltl_runtime.game.recording_archive import (
    ERRORS,
    MAX_BYTES,
    STEALTH_FORMAT,
    Arrays,
    RecordingArchive,
    archive_bytes,
)
from tltl_runtime.spec.episode_summary import End
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.levels.level_object_check import fault
from tltl_runtime.stealth.recordings.arrays import ARRAYS, sizes, snapshots, to_arrays
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.snapshot import BRANCHES
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltlc.api import Fspa, RewardOptions, fileio, record, replace

FORMAT: Final = STEALTH_FORMAT
VERSION: Final = 1


@record
class AxisNames:
    """The names of the things along each axis of an episode's arrays, such as signals, in order."""

    signals: tuple[str, ...]
    atoms: tuple[str, ...]
    enemies: tuple[str, ...]
    movers: tuple[str, ...]
    switches: tuple[str, ...]
    barriers: tuple[str, ...]


@record
class Meta:
    """The content of the array ``meta`` of an episode's file, which is JSON.

    It has everything in an episode that is neither in another array nor in the compiled spec, which
    is in the file, too.
    """

    format: str
    version: int
    player: str
    seed: int
    verdict: Literal["holding", "pending", "satisfied", "violated"]
    success: bool
    end: End
    params: Mapping[str, float]
    reward: RewardOptions
    versions: Mapping[str, str]
    modes: tuple[str, ...]
    names: AxisNames
    level: StealthLevel


def write_episode(path: str | os.PathLike[str], episode: Episode) -> None:
    """Write an episode to a file atomically; equal episodes give equal bytes.

    Raises:
        TltlError: TLT0005, the file cannot be written.
        ValueError: the shapes of the episode's arrays do not fit its level and its automaton.
    """
    fileio.write_file(Path(path), to_bytes(episode))


@fileio.resource_limits()
def read_episode(path: str | os.PathLike[str]) -> Episode:
    """Read an episode from a file.

    Raises:
        TltlError: TLT0001, the file cannot be read; TLT0820, it is not an episode or is damaged;
            TLT0821, it has another version; TLT0822, its contents are inconsistent; TLT0601 to
            TLT0604, the compiled spec in it is invalid.
    """
    name = os.fspath(path)
    return from_bytes(fileio.read_bytes(path, name, MAX_BYTES), name)


def to_bytes(episode: Episode) -> bytes:
    """Return the bytes that :func:`write_episode` writes for an episode."""
    return archive_bytes(to_json(_meta(episode)), episode.fspa, to_arrays(episode, _modes(episode)))


def from_bytes(data: bytes, name: str) -> Episode:
    """Return the episode that is stored in the bytes of a file; messages call the file ``name``.

    Raises the errors of :func:`read_episode`, except TLT0001.
    """
    archive = RecordingArchive(data, name, [array.name for array in ARRAYS])
    meta = _read_meta(archive, name)
    fspa = archive.automaton()
    arrays = archive.arrays(ARRAYS, sizes(meta.level, fspa, archive.row_count("actions")))
    _check_indices(arrays, meta, fspa, name)
    return Episode(
        level=meta.level,
        fspa=fspa,
        params=meta.params,
        player=meta.player,
        seed=meta.seed,
        actions=arrays["actions"],
        snapshots=snapshots(arrays, meta.modes),
        signals=arrays["signals"],
        atoms=arrays["atoms"],
        states=arrays["states"],
        progress=arrays["progress"],
        rewards=arrays["rewards"],
        verdict=meta.verdict,
        success=meta.success,
        end=meta.end,
        reward=meta.reward,
        versions=meta.versions,
    )


def _meta(episode: Episode) -> Meta:
    level, spec = episode.level, episode.level.spec
    return Meta(
        format=FORMAT,
        version=VERSION,
        player=episode.player,
        seed=episode.seed,
        verdict=episode.verdict,  # type: ignore[arg-type]
        success=episode.success,
        end=episode.end,
        params=episode.params,
        reward=episode.reward,
        versions=episode.versions,
        modes=_modes(episode),
        names=_names(level, episode.fspa),
        # Keep the file name only: the folder means nothing on another machine.
        level=replace(level, spec=spec and replace(spec, file=Path(spec.file.name))),
    )


def _modes(episode: Episode) -> tuple[str, ...]:
    return tuple(sorted({mode for shot in episode.snapshots for mode in shot.modes}))


def _names(level: StealthLevel, fspa: Fspa) -> AxisNames:
    groups = (fspa.signals, fspa.atoms, level.enemies, level.movers, level.switches, level.barriers)
    return AxisNames(*(tuple(item.name for item in group) for group in groups))


def _read_meta(archive: RecordingArchive, name: str) -> Meta:
    try:
        meta = from_json(Meta, archive.meta(FORMAT, VERSION), "meta")
    except (RecordJsonError, RecursionError) as error:
        raise ERRORS.broken_error(name, str(error)) from None
    if wrong := fault(meta.level):
        raise ERRORS.broken_error(name, f"its level cannot be used: {wrong}")
    return meta


def _check_indices(arrays: Arrays, meta: Meta, fspa: Fspa, name: str) -> None:
    """Raise an error (TLT0822) if the arrays, the seed or the names in a file are wrong.

    These are an index out of range, a negative seed, and names that do not fit the level and the
    spec.
    """
    limits = [
        ("actions", np.array(BRANCHES)),
        ("states", np.array(len(fspa.states))),
        ("enemy_mode", np.array(len(meta.modes))),
    ]
    for array, limit in limits:
        if bool((arrays[array] >= limit).any()):
            raise ERRORS.broken_error(name, f"the array `{array}` has invalid values")
    if meta.names != _names(meta.level, fspa):
        raise ERRORS.broken_error(name, "`meta.names` does not match the names in the level and in the spec")
    if meta.seed < 0:
        raise ERRORS.broken_error(name, "`meta.seed` is below 0")
