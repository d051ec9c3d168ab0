"""The things and regions of a level that a report mentions."""

from __future__ import annotations

from typing import Any

from tltl_runtime.game.level import Level
from tltl_runtime.game.level_maps import LevelMaps
from tltl_runtime.game.mentions import Mentions, union
from tltl_runtime.regression.report.case_report import CaseReport


def report_mentions(maps: LevelMaps[Any, Any], level: Level, report: CaseReport) -> Mentions:
    """Return the names that the sentences of a report mention; ``maps`` are those of the level's game.

    The names may include some that the level does not have. Only the descriptions of overlays are
    searched for names, because designers write them.
    """
    findings = (finding.mentions for finding in report.explanation)
    return union((report.mentions, *findings, maps.mentions(level, "\n".join(report.descriptions))))
