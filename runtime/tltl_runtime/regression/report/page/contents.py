"""The data that the HTML page of a suite shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.level import Level
from tltl_runtime.game.level_maps import LevelMaps
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.trace_curves import TraceCurves
from tltl_runtime.regression.verdict.verdict import CaseVerdict
from tltlc.api import EMPTY, Fspa, record


@record
class ReportedCase:
    """A case with the data that the page draws.

    - ``level`` and ``fspa`` (the automaton) are None for a case that cannot be played or judged. A case
      of recorded traces has no level either.
    - ``episodes`` are the recorded episodes by index. ``before`` are the episodes of the baseline.
    - ``baseline_level`` is the level on which the baseline was recorded, or None if it is unknown.
    - ``clauses`` are the clauses of the spec as its source has them; empty if not all of them are known.
    - ``curve`` is the plot of the policy's retraining as a PNG; empty if there is none.
    - ``curves`` are curves of example traces by index, for a case of recorded traces. If the game does
      not say where the player is, they are those of the recorded ``episodes``. Otherwise they are empty.
    - ``is_on_empty_plan`` says that the level has an empty plan as its map, because its game shows no outline.
    - ``films`` are films of some recorded episodes by index, as animated WebP pictures. ``film_notes``
      are sentences about films that could not be made.
    """

    report: CaseReport
    level: Level | None = None
    fspa: Fspa | None = None
    episodes: Mapping[int, RecordedEpisode] = EMPTY
    before: tuple[ExplainedEpisode, ...] = ()
    baseline_level: Level | None = None
    clauses: tuple[str, ...] = ()
    curve: bytes = b""
    curves: Mapping[int, TraceCurves] = EMPTY
    is_on_empty_plan: bool = False
    films: Mapping[int, bytes] = EMPTY
    film_notes: tuple[str, ...] = ()


def maps_of(case: ReportedCase) -> LevelMaps[Any, Any] | None:
    """Return the object that draws the maps of a case's level; None if the page shows no map of it.

    The page shows a map if the level has bounds, if the level's game draws maps, and if the position
    of the player is known in all episodes.
    """
    level = case.level
    if level is None or level.bounds is None or not all(episode.way for episode in case.report.episodes):
        return None
    return level.game.maps


@record
class NotRun:
    """A case that was not judged in this run.

    ``reason`` says why, in a sentence. ``earlier_verdict`` is the case's verdict in an earlier run,
    or None if there is no earlier verdict.
    """

    name: str
    reason: str
    earlier_verdict: CaseVerdict | None = None


@record
class SuiteReport:
    """All that the page of a suite shows.

    ``suite`` is the name of the suite. ``seed`` and ``error`` are as in
    :class:`~tltl_runtime.regression.suite.suite.Suite`; ``seed`` is None if nothing is played.
    ``versions`` are the versions of the software that played or judged, by name. ``cases`` are the
    judged cases in order, and ``not_run`` are the cases that were not judged. ``complete`` says
    whether all requested verdicts and retrainings are there. ``note`` is a sentence at the top of the
    page; it may be empty.
    """

    suite: str
    seed: int | None
    error: float
    versions: Mapping[str, str]
    cases: tuple[ReportedCase, ...]
    complete: bool = True
    not_run: tuple[NotRun, ...] = ()
    note: str = ""
