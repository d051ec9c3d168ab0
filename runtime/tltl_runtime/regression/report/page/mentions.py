"""The things and regions of a level that a report mentions."""

from __future__ import annotations

from typing import Any

from tltl_runtime.game.level import Level
from tltl_runtime.game.level_maps import LevelMaps
from tltl_runtime.game.mentions import Mentions, union
from tltl_runtime.regression.report.case_report import CaseReport


def report_mentions(maps: LevelMaps[Any, Any], level: Level, report: CaseReport) -> Mentions:
    """Return the names of things and regions that the sentences of a report mention.

    The level may lack some of them. Sentences that tltlc writes come with the names that they
    mention. Only the designer's descriptions of overlays (files that change a level) are searched
    for names, by ``maps``, which belongs to the level's game.
    """
    findings = (finding.mentions for finding in report.explanation)
    return union((report.mentions, *findings, maps.mentions(level, "\n".join(report.descriptions))))
