"""A recorded episode of a scene as data for the page, which plays it back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tltl_runtime.game.packing import position_steps, runs, scaled_runs, steps
from tltl_runtime.gymnasium_games.entity_positions import EntityPositions
from tltl_runtime.gymnasium_games.scene_cause import scene_cause
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltl_runtime.gymnasium_games.scene_map_scale import scene_metre


def scene_playback(level: SceneLevel, index: int, episode: SceneEpisode) -> dict[str, Any]:
    """Return an episode as JSON data for the report page, which draws it on the map of ``level``.

    ``index`` is the number of the episode within its case. The level must have bounds, and the episode
    positions of the player. For an episode of n steps, each list has n + 1 values, the first before
    step 1; lists about atoms have n. Lengths are in centimetres on the map, times in milliseconds,
    robustness in hundredths, progress in thousandths. ``there`` is 0 while an entity is gone. The
    functions of :mod:`~tltl_runtime.game.packing` encode the values.
    """
    bounds, metre = level.bounds, scene_metre(level)
    assert bounds is not None and episode.positions is not None, "the page draws no map of this scene"
    return {
        "index": index,
        "why": scene_cause(episode).text,
        "time": steps(episode.times.tolist(), 1000),
        "state": runs(episode.states.tolist()),
        "progress": scaled_runs(episode.progress.tolist(), 1000),
        "player": position_steps(bounds, episode.positions.tolist(), metre),
        "entities": [] if episode.entities is None else [*_entities(episode.entities, level)],
        "atoms": [steps(column, 100) for column in episode.atoms.T.tolist()],
    }


def _entities(entities: EntityPositions, level: SceneLevel) -> Iterator[dict[str, Any]]:
    """Yield the data of each entity that appears in an episode.

    While an entity is gone, it keeps its last position; before it first appears, it has its first one.
    """
    assert level.bounds is not None
    for column, name in enumerate(entities.names):
        places = entities.places[:, column]
        there = ~np.isnan(places[:, 0])
        if there.any():
            rows = np.arange(len(places))
            known = np.maximum.accumulate(np.where(there, rows, -1))
            known[known < 0] = int(np.argmax(there))
            positions = position_steps(level.bounds, places[known].tolist(), scene_metre(level))
            yield {"name": name, **positions, "there": runs(map(int, there.tolist()))}
