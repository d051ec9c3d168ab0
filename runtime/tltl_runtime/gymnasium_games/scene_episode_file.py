"""Files of recorded episodes of scenes: compressed NumPy archives."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.outline import GREATEST, outline_problem
from tltl_runtime.game.recording_archive import (
    ERRORS,
    MAX_BYTES,
    SCENE_FORMAT,
    Array,
    Arrays,
    RecordingArchive,
    archive_bytes,
)
from tltl_runtime.gymnasium_games.entity_positions import EntityPositions
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltl_runtime.policies.spaces.action_layout import ActionLayout
from tltl_runtime.spec.episode_summary import End
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltlc.api import Fspa, RewardOptions, fileio, record, replace

VERSION: Final = 1

_GREATEST: Final = 1e300
"""The greatest absolute value of a number in an action."""

_LATEST_S: Final = 1e12
"""The latest time of an episode, in seconds."""

ARRAYS: Final = (
    Array("time", "<f8", ("n + 1",), "s", "since the reset", low=0.0, high=_LATEST_S),
    Array("actions", "<f8", ("n", "width"), "", "flat: the choices from 0, then the numbers", -_GREATEST, _GREATEST),
    Array("signals", "<f8", ("n + 1", "signals"), "SI", "those of the spec; bools are 0 and 1"),
    Array("atoms", "<f8", ("n", "atoms"), "1", "robustness of the spec's atoms", low=-1.0, high=1.0),
    Array("states", "<i4", ("n + 1",), "", "of the automaton, from 0", low=0),
    Array("progress", "<f8", ("n + 1",), "1", "the best so far", low=0.0, high=1.0),
    Array("rewards", "<f8", ("n",), "1", "of the steps"),
)
POSITION: Final = Array(
    "position", "<f8", ("n + 1", 3), "m", "of the player; absent if the game does not say it", -GREATEST, GREATEST
)
ENTITIES: Final = Array(
    "entities",
    "<f8",
    ("n + 1", "entities", 3),
    "m",
    "of the other entities; not-a-number where one is gone; absent if the game does not say it",
    low=-GREATEST,
    high=GREATEST,
    gaps=True,
)


_ARRAYS: Final = (*ARRAYS, POSITION, ENTITIES)


@record
class SceneMeta:
    """The content of the array ``meta``, which is JSON.

    It has everything in an episode that is neither in another array nor in the spec's artefact.
    """

    format: str
    version: int
    player: str
    seed: int
    verdict: Literal["holding", "pending", "satisfied", "violated"]
    success: bool
    end: End
    killer: str
    params: Mapping[str, float]
    reward: RewardOptions
    versions: Mapping[str, str]
    has_positions: bool
    layout: ActionLayout
    level: SceneLevel
    entities: tuple[str, ...] | None = None
    """The names of the entities without the player; None if the game does not give positions."""


@fileio.resource_limits()
def read_scene_episode(path: Path) -> SceneEpisode:
    """Read an episode from a file.

    Raises:
        TltlError: TLT0001, the file cannot be read; TLT0820, it is not an episode or is damaged;
            TLT0821, it has another version; TLT0822, its contents are inconsistent; TLT0601 to
            TLT0604, its artefact is invalid.
    """
    return scene_episode_from_bytes(fileio.read_bytes(path, str(path), MAX_BYTES), str(path))


def scene_episode_bytes(episode: SceneEpisode) -> bytes:
    """Return the bytes of the file of an episode; equal episodes give equal bytes.

    Raises:
        ValueError: an array of the episode has another number of values than its steps, actions,
            signals, atoms or entities need.
    """
    columns = {
        "time": episode.times,
        "position": episode.positions,
        "entities": None if episode.entities is None else episode.entities.places,
        **{name: getattr(episode, name) for name in ("actions", "signals", "atoms", "states", "progress", "rewards")},
    }
    formats = [array for array in _ARRAYS if columns[array.name] is not None]
    names = () if episode.entities is None else episode.entities.names
    known = _sizes(episode.layout, episode.fspa, len(episode.actions), len(names))
    arrays = {
        array.name: np.asarray(columns[array.name], dtype=array.dtype).reshape(array.actual_shape(known))
        for array in formats
    }
    return archive_bytes(to_json(_meta(episode)), episode.fspa, arrays)


def scene_episode_from_bytes(data: bytes, name: str) -> SceneEpisode:
    """Return the episode in the bytes of a file; messages call the file ``name``.

    Raises the errors of :func:`read_scene_episode`, except TLT0001.
    """
    archive = RecordingArchive(data, name, [array.name for array in _ARRAYS])
    try:
        meta = from_json(SceneMeta, archive.meta(SCENE_FORMAT, VERSION), "meta")
    except (RecordJsonError, ValueError, RecursionError) as error:
        raise ERRORS.broken_error(name, str(error)) from None
    fspa = archive.automaton()
    formats = [*ARRAYS, *([POSITION] if meta.has_positions else []), *([] if meta.entities is None else [ENTITIES])]
    sizes = _sizes(meta.layout, fspa, archive.row_count("actions"), len(meta.entities or ()))
    arrays = archive.arrays(formats, sizes)
    _check(arrays, meta, fspa, name)
    return SceneEpisode(
        level=meta.level,
        fspa=fspa,
        params=meta.params,
        player=meta.player,
        seed=meta.seed,
        layout=meta.layout,
        actions=arrays["actions"],
        times=arrays["time"],
        positions=arrays.get("position"),
        signals=arrays["signals"],
        atoms=arrays["atoms"],
        states=arrays["states"],
        progress=arrays["progress"],
        rewards=arrays["rewards"],
        verdict=meta.verdict,
        success=meta.success,
        end=meta.end,
        killer=meta.killer,
        reward=meta.reward,
        versions=meta.versions,
        entities=None if meta.entities is None else EntityPositions(meta.entities, arrays["entities"]),
    )


def _meta(episode: SceneEpisode) -> SceneMeta:
    level, spec = episode.level, episode.level.spec
    return SceneMeta(
        format=SCENE_FORMAT,
        version=VERSION,
        player=episode.player,
        seed=episode.seed,
        verdict=episode.verdict,  # type: ignore[arg-type]
        success=episode.success,
        end=episode.end,
        killer=episode.killer,
        params=episode.params,
        reward=episode.reward,
        versions=episode.versions,
        has_positions=episode.positions is not None,
        layout=episode.layout,
        # Keep the file name only: the folder means nothing on another machine.
        level=replace(level, place="", spec=spec and replace(spec, file=Path(spec.file.name))),
        entities=None if episode.entities is None else episode.entities.names,
    )


def _sizes(layout: ActionLayout, fspa: Fspa, count: int, entities: int) -> dict[str, int]:
    return {
        "n": count,
        "n + 1": count + 1,
        "width": layout.width,
        "signals": len(fspa.signals),
        "atoms": len(fspa.atoms),
        "entities": entities,
    }


def _check(arrays: Arrays, meta: SceneMeta, fspa: Fspa, name: str) -> None:
    """Raise TltlError, TLT0822, if a value is out of range, times do not increase, or the outline is invalid."""
    choices: NDArray[np.float64] = arrays["actions"][:, : len(meta.layout.sizes)]
    if ((choices < 0) | (choices >= np.array(meta.layout.sizes)) | (choices != np.rint(choices))).any():
        raise ERRORS.broken_error(name, "the array `actions` has invalid values")
    if (arrays["states"] >= len(fspa.states)).any():
        raise ERRORS.broken_error(name, "the array `states` has invalid values")
    if arrays["time"][0] != 0.0 or (np.diff(arrays["time"]) <= 0).any():
        raise ERRORS.broken_error(name, "the array `time` has invalid values")
    if meta.seed < 0:
        raise ERRORS.broken_error(name, "`meta.seed` is below 0")
    gone = np.isnan(arrays["entities"]) if "entities" in arrays else np.zeros((0, 0, 3), dtype=np.bool_)
    if (gone.any(axis=2) != gone.all(axis=2)).any():
        raise ERRORS.broken_error(name, "the array `entities` has invalid values")
    problem = None if meta.level.outline is None else outline_problem(meta.level.outline)
    if problem is not None:
        raise ERRORS.broken_error(name, f"`meta.level.outline` {problem}")
