"""The things and regions of a level that the sentences of a report mention.

They are found by a search for their names, because authors of levels write some of the sentences:
the descriptions of overlays. All sentences put names of things between backquotes, and call regions
by their names.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from tltl_runtime.game.level import Level
from tltl_runtime.stealth.level import StealthLevel, entity_names
from tltlc.api import record


@record
class Mentions:
    """The names that a report mentions.

    ``things`` are entities and solids.
    """

    things: frozenset[str] = frozenset()
    regions: frozenset[str] = frozenset()


NO_MENTIONS: Final = Mentions()


def mentions(level: Level, sentences: Sequence[str]) -> Mentions:
    """Return the things and regions that sentences mention.

    A thing is mentioned by its name (```far_wall```) or by a key of its table in the level's file
    (```wall.far_wall.at```). A region is mentioned by *the* and its name (*the left part*).
    """
    assert isinstance(level, StealthLevel)
    text = "\n".join(sentences)
    names = {*entity_names(level), *(solid.name for solid in level.solids)}
    return Mentions(frozenset(name for name in names if _mentions_thing(name, text)), _regions(level, text))


def _mentions_thing(name: str, text: str) -> bool:
    return re.search(rf"[`.]{re.escape(name)}[`.]", text) is not None


def _regions(level: StealthLevel, text: str) -> frozenset[str]:
    """Return the names of the mentioned regions.

    If the names of several regions fit at one place in the text, only the longest counts: *the left
    part* does not mention ``left``.
    """
    names_by_text = {region.name.replace("_", " "): region.name for region in level.regions}
    alternatives = "|".join(map(re.escape, sorted(names_by_text, key=len, reverse=True)))
    matches = re.findall(rf"\bthe ({alternatives})(?![-\w])", text) if names_by_text else ()
    return frozenset(names_by_text[match] for match in matches)
