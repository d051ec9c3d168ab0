"""The things and regions of a level that a report mentions."""

from __future__ import annotations

import re

from tltl_runtime.game.level import Level
from tltl_runtime.regression.explain.mentions import Mentions, region_text, union
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.stealth.level import StealthLevel, entity_names


def report_mentions(level: Level, report: CaseReport) -> Mentions:
    """Return the names that the sentences of a report mention.

    The names may include some that the level does not have. Only the descriptions of overlays are
    searched for names, because designers write them.
    """
    findings = (finding.mentions for finding in report.explanation)
    return union((report.mentions, *findings, description_mentions(level, "\n".join(report.descriptions))))


def description_mentions(level: Level, text: str) -> Mentions:
    """Return the things and regions of a level that a designer's text mentions.

    A thing is mentioned by its name (```far_wall```) or by a key of its table in the level's file
    (```wall.far_wall.at```). A region is mentioned by *the* and its name (*the left part*).
    """
    assert isinstance(level, StealthLevel)
    names = (*entity_names(level), *(solid.name for solid in level.solids))
    return Mentions(tuple(name for name in names if _mentions_thing(name, text)), _regions(level, text))


def _mentions_thing(name: str, text: str) -> bool:
    return re.search(rf"[`.]{re.escape(name)}[`.]", text) is not None


def _regions(level: StealthLevel, text: str) -> tuple[str, ...]:
    """Return the names of the mentioned regions.

    If the names of several regions fit at one place in the text, only the longest counts: *the left
    part* does not mention ``left``.
    """
    names_by_text = {region_text(region.name): region.name for region in level.regions}
    alternatives = "|".join(map(re.escape, sorted(names_by_text, key=len, reverse=True)))
    matches = re.findall(rf"\bthe ({alternatives})(?![-\w])", text) if names_by_text else ()
    return tuple(names_by_text[match] for match in matches)
