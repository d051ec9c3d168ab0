"""The things and regions of a level that a text mentions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Final

from tltlc.api import record


@record
class Mentions:
    """The names of the things and regions of a level that a text mentions.

    ``things`` are entities and solids, or keys of their tables in the files of a level.
    """

    things: tuple[str, ...] = ()
    regions: tuple[str, ...] = ()


NO_MENTIONS: Final = Mentions()


def mentions_in(text: str, things: Iterable[str], regions: Sequence[str]) -> Mentions:
    """Return which of the ``things`` and ``regions`` of a level a text mentions.

    A thing is mentioned by its name (```far_wall```) or by a key of its table in the level's file
    (```wall.far_wall.at```). A region is mentioned by *the* and its name (*the left part*). If the
    names of several regions fit at one place in the text, only the longest counts: *the left part*
    does not mention ``left``.
    """
    return Mentions(tuple(name for name in things if _mentions_thing(name, text)), _regions(text, regions))


def region_text(name: str) -> str:
    """Return the name of a region as sentences and maps write it."""
    return name.replace("_", " ")


def union(mentions: Iterable[Mentions]) -> Mentions:
    """Return all names in ``mentions``, each once, in order."""
    things: dict[str, None] = {}
    regions: dict[str, None] = {}
    for part in mentions:
        things |= dict.fromkeys(part.things)
        regions |= dict.fromkeys(part.regions)
    return Mentions(tuple(things), tuple(regions))


def _mentions_thing(name: str, text: str) -> bool:
    return re.search(rf"[`.]{re.escape(name)}[`.]", text) is not None


def _regions(text: str, regions: Sequence[str]) -> tuple[str, ...]:
    names_by_text = {region_text(name): name for name in regions}
    alternatives = "|".join(map(re.escape, sorted(names_by_text, key=len, reverse=True)))
    matches = re.findall(rf"\bthe ({alternatives})(?![-\w])", text) if names_by_text else ()
    return tuple(names_by_text[match] for match in matches)
