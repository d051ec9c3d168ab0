"""The JSON data from which the page's scripts draw the maps and trajectories of a case."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltl_runtime.game.geometry import Box
from tltl_runtime.game.level import Level
from tltl_runtime.game.moments import has_clock
from tltl_runtime.game.packing import runs, x_steps, y_steps
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.report.page.automaton import label_texts
from tltl_runtime.regression.report.page.contents import ReportedCase, maps_of
from tltl_runtime.regression.report.page.heat import Heat, failed_ends, time_spent

_RESOLUTION_CM: Final = 5
"""The resolution of trajectories, in centimetres.

At this resolution, most differences between successive points are encoded as a single character.
"""


def case_data(case: ReportedCase, slug: str) -> dict[str, Any] | None:
    """Return the data that the page's scripts draw on the maps of a case; None if the case has no map.

    ``slug`` is the case's short name in addresses within the page, such as ``navigation-v1``.
    """
    level, fspa, maps = case.level, case.fspa, maps_of(case)
    if level is None or fspa is None or maps is None:
        return None
    before = level if case.baseline_level is None or case.baseline_level.bounds is None else case.baseline_level
    labels = [label_texts(fspa, state.id) for state in fspa.states]
    return {
        "slug": slug,
        "unit": "s" if _is_timed(case) else "steps",
        "map": maps.map_data(level),
        "states": [words for words, _ in labels],
        "symbols": [symbols for _, symbols in labels],
        "now": _episodes_data(level, maps.metre(level), case.report.episodes),
        "before": _episodes_data(before, maps.metre(before), case.before),
        "episodes": [maps.episode_data(level, index, case.episodes[index]) for index in sorted(case.episodes)],
    }


def _is_timed(case: ReportedCase) -> bool:
    """Whether the times of a case are seconds. Its recordings say so; without any, its spec does."""
    if case.episodes:
        return any(has_clock(episode.times) for episode in case.episodes.values())
    return case.fspa is not None and case.fspa.clock_s is not None


def _episodes_data(level: Level, metre: float, episodes: Sequence[ExplainedEpisode]) -> dict[str, Any]:
    """Return the trajectories and heat maps of the episodes that say where the player was.

    ``metre`` is the length in the level, in metres, of a metre on the map.
    """
    bounds, placed = level.bounds, [episode for episode in episodes if episode.way]
    assert bounds is not None
    return {
        "trajectories": [_trajectory(bounds, metre, episode) for episode in placed],
        "time": _heat_data(time_spent(bounds, placed, metre), metre),
        "failed": _heat_data(failed_ends(bounds, placed, metre), metre),
    }


def _trajectory(bounds: Box, metre: float, episode: ExplainedEpisode) -> dict[str, Any]:
    """Return the encoded trajectory of an episode, and how and where the episode ended.

    ``bounds`` are those of the level. ``metre`` is as in :func:`_episodes_data`.
    """
    place = episode.place or episode.arrivals[-1].place
    assert place is not None, "an episode with a way has places"
    return {
        "index": episode.summary.index,
        "unit": _RESOLUTION_CM,
        "end": episode.summary.end,
        "cause": episode.cause,
        "by": list(episode.by),
        "x": x_steps(bounds, [x for x, *_ in episode.way], _RESOLUTION_CM * metre),
        "y": y_steps(bounds, [y for _, y, *_ in episode.way], _RESOLUTION_CM * metre),
        "state": runs(state for *_, state, _ in episode.way),
        "place": [x_steps(bounds, place[:1], metre), y_steps(bounds, place[1:2], metre)],
    }


def _heat_data(heat: Heat, metre: float) -> dict[str, Any]:
    return {
        "cell": round(100 * heat.cell / metre),
        "columns": heat.columns,
        "cells": [number for pair in heat.values for number in pair],
        "most": max((value for _, value in heat.values), default=0),
    }
