"""What the HTML page of a suite shows."""

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

    ``level`` and ``fspa`` are None for a case that cannot be played. ``episodes`` are the recorded
    episodes by index. ``before`` are the episodes of the baseline. ``baseline_level`` is the level
    that the baseline was recorded on, or None if it is unknown. ``curve`` is the plot of the
    retraining as a PNG, or empty without a retraining or its plot.

    A case of recorded traces has no level. ``curves`` are those of examples of its traces by index, or
    of the recorded ``episodes`` if the level's game says nothing about places; they are empty for
    other cases. ``films`` are films of some of these episodes by index, as animated WebP pictures;
    ``film_notes`` are sentences about films that could not be made.
    """

    report: CaseReport
    level: Level | None = None
    fspa: Fspa | None = None
    episodes: Mapping[int, RecordedEpisode] = EMPTY
    before: tuple[ExplainedEpisode, ...] = ()
    baseline_level: Level | None = None
    curve: bytes = b""
    curves: Mapping[int, TraceCurves] = EMPTY
    films: Mapping[int, bytes] = EMPTY
    film_notes: tuple[str, ...] = ()


def maps_of(case: ReportedCase) -> LevelMaps[Any, Any] | None:
    """Return what draws the map of a case; None if its page shows no map.

    A case with a map has a level with bounds, and its game draws maps and says where the player was
    in each episode.
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
    """What the page of a suite shows.

    ``suite`` is the name of the suite. ``seed`` and ``error`` are as in
    :class:`~tltl_runtime.regression.suite.suite.Suite`; ``seed`` is None if nothing is played.
    ``versions`` are the versions of the software that played or judged. ``cases`` are the judged cases
    in order, and ``not_run`` are the cases that were not judged. ``complete`` says whether all
    requested cases were judged and retrained.
    ``note`` is shown at the top of the page.
    """

    suite: str
    seed: int | None
    error: float
    versions: Mapping[str, str]
    cases: tuple[ReportedCase, ...]
    complete: bool = True
    not_run: tuple[NotRun, ...] = ()
    note: str = ""
