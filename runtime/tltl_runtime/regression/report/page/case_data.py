"""The data of a case that the page's scripts draw, as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltl_runtime.game.geometry import Box
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.report.page.contents import ReportedCase
from tltl_runtime.regression.report.page.heat import Heat, failed_ends, time_spent
from tltl_runtime.regression.report.page.packing import runs, x_steps, y_steps
from tltlc.api import label_text

_RESOLUTION_CM: Final = 5
"""The resolution of trajectories, in centimetres.

At this resolution, most differences between successive points are encoded as a single character.
"""


def case_data(case: ReportedCase, slug: str) -> dict[str, Any] | None:
    """Return the data for the map and the automaton of a case; None if it has no map.

    ``slug`` is the case's short name in addresses within the page.
    """
    level, fspa = case.level, case.fspa
    bounds = None if level is None else level.bounds
    if level is None or fspa is None or bounds is None:
        return None
    # Drawing a level needs the packages of the game; a page of traces does not.
    from tltl_runtime.regression.report.page.stealth.level_map import map_data
    from tltl_runtime.regression.report.page.stealth.recording_data import recording_data

    return {
        "slug": slug,
        "map": map_data(level),
        "states": [label_text(fspa, state.id) for state in fspa.states],
        "now": _episodes_data(bounds, case.report.episodes),
        "before": _episodes_data((case.baseline_level or level).bounds or bounds, case.before),
        "episodes": [recording_data(index, case.episodes[index]) for index in sorted(case.episodes)],
    }


def _episodes_data(bounds: Box, episodes: Sequence[ExplainedEpisode]) -> dict[str, Any]:
    return {
        "trajectories": [_trajectory(bounds, episode) for episode in episodes],
        "time": _heat_data(time_spent(bounds, episodes)),
        "failed": _heat_data(failed_ends(bounds, episodes)),
    }


def _trajectory(bounds: Box, episode: ExplainedEpisode) -> dict[str, Any]:
    """Return the trajectory of an episode on the map, and how the episode ended."""
    place = episode.place or episode.arrivals[-1].place
    assert place is not None, "an episode of a level has places"
    return {
        "index": episode.summary.index,
        "unit": _RESOLUTION_CM,
        "end": episode.summary.end,
        "cause": episode.cause,
        "by": list(episode.by),
        "x": x_steps(bounds, [x for x, *_ in episode.way], _RESOLUTION_CM),
        "y": y_steps(bounds, [y for _, y, *_ in episode.way], _RESOLUTION_CM),
        "state": runs(state for *_, state, _ in episode.way),
        "place": [x_steps(bounds, place[:1]), y_steps(bounds, place[1:2])],
    }


def _heat_data(heat: Heat) -> dict[str, Any]:
    return {
        "cell": round(100 * heat.cell),
        "columns": heat.columns,
        "cells": [number for pair in heat.values for number in pair],
        "most": max((value for _, value in heat.values), default=0),
    }
