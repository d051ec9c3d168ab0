"""Cases whose game shows no map: an empty plan for the ways of the players, or a sentence that says what is missing."""

from __future__ import annotations

from tltl_runtime.regression.report.page.contents import ReportedCase, maps_of
from tltlc.api import replace


def with_plan(case: ReportedCase) -> ReportedCase:
    """Return a case with an empty plan of its ways as its map, if it has no map but all episodes have ways.

    Return the case unchanged if it has a map, if the game does not say where the player is, or if the game
    draws no maps.
    """
    level, episodes = case.level, (*case.report.episodes, *case.before)
    if level is None or level.bounds is not None or level.game.maps is None or not _has_all_ways(case):
        return case
    ways = [(x, y) for episode in episodes for x, y, *_ in episode.way]
    ways += [(episode.place[0], episode.place[1]) for episode in episodes if episode.way and episode.place]
    plan = level.game.maps.empty_plan(level, ways, case.episodes.values())
    if plan is None:
        return case
    return replace(case, level=plan, baseline_level=plan, is_on_empty_plan=True)


def missing_map_text(case: ReportedCase) -> str:
    """Return a sentence that says why the page has no map of a case, and how to get one; empty if it has one."""
    if maps_of(case) is not None:
        return ""
    if case.report.traces:
        return "There is no map: recorded traces do not say where players are. Cases that play a game may have one."
    if case.level is not None and case.level.game.maps is None:
        return "There is no map: the game draws none."
    return (
        "There is no map: the game does not say where the player is. Add `tltl_positions()`, or `positions` if the game"
        " runs in another process."
    )


def _has_all_ways(case: ReportedCase) -> bool:
    return bool(case.report.episodes) and all(episode.way for episode in case.report.episodes)
