"""The things and regions of a level that a text mentions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Final

from tltlc.api import record


@record
class Mentions:
    """The names of the things and regions of a level that a text mentions.

    ``things`` are the names of entities, solids such as walls, and areas.
    """

    things: tuple[str, ...] = ()
    regions: tuple[str, ...] = ()


NO_MENTIONS: Final = Mentions()


def mentions_in(text: str, things: Iterable[str], regions: Sequence[str]) -> Mentions:
    """Return which of the ``things`` and ``regions`` of a level a text mentions.

    A text mentions the thing ``far_wall`` if it contains, in backticks, either "far_wall" or a key of the
    level's file with this name in it, such as "wall.far_wall.at". A text mentions the region
    ``left_part`` if it contains "the left part". If the names of several regions fit at one place in the
    text, only the longest counts: "the left part" does not mention the region ``left``.
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
