"""Files of episodes: compressed NumPy archives. ``docs/episode-log.md`` describes every array."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.spec.episode_summary import End
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.levels.level_object_check import fault
from tltl_runtime.stealth.recordings.arrays import ARRAYS, Array, Arrays, shape_of, sizes, snapshots, to_arrays
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.numpy_archive import ArchiveError, read_array, read_members
from tltl_runtime.stealth.snapshot import BRANCHES
from tltl_runtime.support.load_errors import LoadErrors
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltlc.api import Fspa, RewardOptions, SourceFile, TltlError, compiler, fileio, record, replace

FORMAT: Final = "tltl-episode"
VERSION: Final = 1
MAX_BYTES: Final = fileio.limits.RECORDING.size
"""The greatest size of a file, and of all its arrays when they are unpacked: 256 MiB.

That is about half a million decisions.
"""

_TEXTS: Final = ("meta", "artefact")
"""The arrays that contain the bytes of a UTF-8 text."""

_ERRORS: Final = LoadErrors("an", "episode", "TLT0820", "TLT0821", "TLT0822", again="record the episode again")


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
            TLT0604, its artefact is invalid.
    """
    name = os.fspath(path)
    return from_bytes(fileio.read_bytes(path, name, MAX_BYTES), name)


def to_bytes(episode: Episode) -> bytes:
    """Return the bytes that :func:`write_episode` writes."""
    meta = json.dumps(to_json(_meta(episode)), ensure_ascii=False, allow_nan=False)
    texts = {"meta": meta, "artefact": _artefact_text(episode.fspa)}
    arrays: dict[str, Any] = {name: np.frombuffer(text.encode(), dtype=np.uint8) for name, text in texts.items()}
    arrays |= to_arrays(episode, _modes(episode))
    archive = BytesIO()
    np.savez_compressed(archive, **arrays)
    return archive.getvalue()


def from_bytes(data: bytes, name: str) -> Episode:
    """Return the episode in the bytes of a file; messages call the file ``name``.

    Raises the errors of :func:`read_episode`, except TLT0001.
    """
    members = _read_archive(data, name)
    meta = _read_meta(members, name)
    fspa = _read_automaton(_read_text(members, "artefact", name), name)
    arrays = _read_arrays(members, meta.level, fspa, name)
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


@lru_cache(maxsize=8)
def _artefact_text(fspa: Fspa) -> str:
    """Return an automaton's artefact as text, cached because the episodes of a spec share it."""
    (artefact,) = compiler.emit("json", fspa).values()
    return str(artefact)


@lru_cache(maxsize=8)
def _automaton(artefact: str) -> Fspa:
    """Return the automaton in an artefact, cached because the episodes of a spec share it."""
    return compiler.read_artefact(SourceFile("artefact", artefact))


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


# --- reading untrusted files ------------------------------------------------------------------------


def _read_archive(data: bytes, name: str) -> dict[str, bytes]:
    """Return the bytes of each array in the file with the content ``data``, by the array's name."""
    if len(data) > MAX_BYTES:
        raise _ERRORS.unreadable_error(name, f"it is larger than {MAX_BYTES >> 20} MiB")
    try:
        members = read_members(data, [*_TEXTS, *(array.name for array in ARRAYS)], MAX_BYTES)
    except ArchiveError as error:
        raise _ERRORS.unreadable_error(name, str(error)) from None
    if "meta" not in members:
        raise _ERRORS.unreadable_error(name, "it is another kind of archive")
    return members


def _read_meta(members: Mapping[str, bytes], name: str) -> Meta:
    text = _read_text(members, "meta", name)
    try:
        document = fileio.parse_json(text, fileio.limits.RECORDED_TEXTS["meta"])
    except (ValueError, RecursionError):
        raise _ERRORS.broken_error(name, "`meta` is not JSON") from None
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise _ERRORS.unreadable_error(name, "it is another kind of archive")
    _ERRORS.check_version(name, document.get("version"), VERSION)
    try:
        meta = from_json(Meta, document, "meta")
    except (RecordJsonError, RecursionError) as error:
        raise _ERRORS.broken_error(name, str(error)) from None
    if wrong := fault(meta.level):
        raise _ERRORS.broken_error(name, f"its level cannot be used: {wrong}")
    return meta


def _read_automaton(text: str, name: str) -> Fspa:
    try:
        return _automaton(text)
    except TltlError:
        return compiler.read_artefact(SourceFile(f"{name}/artefact", text))  # raises the error that names the file


def _read_text(members: Mapping[str, bytes], array: str, name: str) -> str:
    data = _read_array(members, array, name)
    if data.dtype != np.uint8 or data.ndim != 1:
        raise _ERRORS.broken_error(name, f"the array `{array}` does not contain bytes")
    limit = fileio.limits.RECORDED_TEXTS[array]
    if data.size > limit.size or np.count_nonzero(data == ord(",")) >= (limit.values or 0):
        most = f"{limit.size >> 20} MiB or {limit.values:,} values"
        raise _ERRORS.broken_error(name, f"the array `{array}` contains more than {most}")
    try:
        return data.tobytes().decode()
    except UnicodeDecodeError:
        raise _ERRORS.broken_error(name, f"the array `{array}` is not UTF-8 text") from None


def _read_arrays(members: Mapping[str, bytes], level: StealthLevel, fspa: Fspa, name: str) -> dict[str, NDArray[Any]]:
    """Read the arrays of an episode's file, and check their shapes and ranges.

    ``members`` has the bytes of the arrays by name; messages call the file ``name``.
    """
    arrays = {array.name: _read_array(members, array.name, name) for array in ARRAYS}
    actions = arrays["actions"]
    known = sizes(level, fspa, actions.shape[0] if actions.ndim else 0)
    for array in ARRAYS:
        _check_array(arrays[array.name], array, shape_of(array, known), name)
    return arrays


def _read_array(members: Mapping[str, bytes], array: str, name: str) -> NDArray[Any]:
    """Read the array with the name ``array``, which may have any shape, from ``members``."""
    if array not in members:
        raise _ERRORS.broken_error(name, f"the array `{array}` is missing")
    try:
        return read_array(members[array])
    except ArchiveError as error:
        raise _ERRORS.broken_error(name, f"the array `{array}`: {error}") from None


def _check_array(values: NDArray[Any], array: Array, shape: tuple[int, ...], name: str) -> None:
    if values.dtype != np.dtype(array.dtype) or values.shape != shape:
        expected = f"{array.dtype} of shape {shape}"
        raise _ERRORS.broken_error(
            name, f"the array `{array.name}` is {values.dtype.str} of shape {values.shape}, not {expected}"
        )
    if values.dtype == np.bool_:
        valid = bool((values.view(np.uint8) <= 1).all())
    else:
        # The comparisons reject not-a-number; isfinite also rejects infinities.
        valid = bool(((values >= array.low) & (values <= array.high) & np.isfinite(values)).all())
    if not valid:
        raise _ERRORS.broken_error(name, f"the array `{array.name}` has invalid values")


def _check_indices(arrays: Arrays, meta: Meta, fspa: Fspa, name: str) -> None:
    """Raise TLT0822 if an index is out of range, or if names do not fit the level and the spec."""
    limits = [
        ("actions", np.array(BRANCHES)),
        ("states", np.array(len(fspa.states))),
        ("enemy_mode", np.array(len(meta.modes))),
    ]
    for array, limit in limits:
        if bool((arrays[array] >= limit).any()):
            raise _ERRORS.broken_error(name, f"the array `{array}` has invalid values")
    if meta.names != _names(meta.level, fspa):
        raise _ERRORS.broken_error(name, "`meta.names` does not match the names in the level and in the spec")
    if meta.seed < 0:
        raise _ERRORS.broken_error(name, "`meta.seed` is below 0")
