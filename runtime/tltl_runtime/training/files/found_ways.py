"""The file that keeps the ways of a search until they are in a checkpoint: ``ways.json``.

A training has a checkpoint only after its search. So a search stores the demonstrations that it
finds, and a training that was stopped during its search goes on with them.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.exploration.search import FoundWays, SearchProgress, SuccessfulEpisode
from tltl_runtime.training.files.run_file import WAYS, WRITABLE, TrainingRun, identity
from tltlc.api import TltlError, fileio, record

_FORMAT: Final = "tltl-ways"
_VERSION: Final = 1


@record
class _Way:
    seed: int
    end: int
    actions: tuple[tuple[float, ...], ...]


@record
class _Content:
    """The content of the file.

    ``run`` identifies the training, and ``steps_before`` the search: the steps that the searches of
    the training had taken before it.
    """

    format: str
    version: int
    run: Mapping[str, str]
    steps_before: int
    progress: SearchProgress
    ways: tuple[_Way, ...]


class WaysFile:
    """The file for the demonstrations of one search of a training.

    Each process of a training has its own file; ``rank`` is the number of the process.
    ``steps_before`` are the steps that the searches of the training had taken before this search.
    """

    def __init__(self, run: TrainingRun, rank: int = 0, steps_before: int = 0) -> None:
        self._folder, self._name = run.folder, _name(rank)
        # The identity now: a level that is edited during the search is another one.
        self._identity, self._steps_before = identity(run), steps_before

    def write(self, ways: FoundWays) -> None:
        """Replace the content of the file.

        Raises TltlError, TLT0005, if the file cannot be written.
        """
        encoded = tuple(
            _Way(way.seed, way.end, tuple(tuple(action) for action in way.actions)) for way in ways.demonstrations
        )
        content = _Content(_FORMAT, _VERSION, self._identity, self._steps_before, ways.progress, encoded)
        text = json.dumps(to_json(content)) + "\n"
        fileio.write_files(self._folder, {self._name: text}, WRITABLE, durable=True, over_inputs=True)

    def read(self, encoding: ActionEncoding | None = None) -> FoundWays | None:
        """Return what :meth:`write` stored for this search; None if there is nothing of use.

        There is nothing of use if the file is missing or damaged, or is of another game, scene, spec,
        seed, settings or search. With ``encoding``, nor if an action is none of the game.
        """
        path = self._folder / self._name
        if not path.exists():
            return None
        try:
            source = fileio.read_source(path, max_bytes=fileio.limits.FOUND_WAYS.size)
            content = from_json(_Content, fileio.parse_json(source.text, fileio.limits.FOUND_WAYS), "it")
            ways = tuple(_episode(way, encoding) for way in content.ways)
        except (TltlError, ValueError, RecursionError):
            return None
        begins = (_FORMAT, _VERSION, self._identity, self._steps_before)
        if (content.format, content.version, content.run, content.steps_before) != begins:
            return None
        return FoundWays(content.progress, ways) if ways else None


def remove_ways(folder: Path, rank: int = 0) -> None:
    """Remove the file of a process from the folder of a training, once its demonstrations are in a checkpoint."""
    (folder / _name(rank)).unlink(missing_ok=True)


def _name(rank: int) -> str:
    return f"{WAYS.removesuffix('.json')}-{rank}.json" if rank else WAYS


def _episode(way: _Way, encoding: ActionEncoding | None) -> SuccessfulEpisode:
    """Return a stored demonstration. Raises ValueError if it is none."""
    if min(way.seed, way.end) < 0 or not way.actions:
        raise RecordJsonError("a way has no actions, or a number below 0")
    if encoding is None:
        return SuccessfulEpisode(way.seed, way.actions, way.end)
    rows = np.array(way.actions, np.float64)
    actions = rows.astype(encoding.dtype)
    if (actions != rows).any():
        raise RecordJsonError("a choice of an action is no whole number")
    encoding.check(actions, len(way.actions))
    return SuccessfulEpisode(way.seed, actions.tolist(), way.end)
