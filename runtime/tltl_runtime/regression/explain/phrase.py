"""Texts of a report, with the names of the level's things and regions that they mention."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.game.mentions import NO_MENTIONS, Mentions, union
from tltlc.api import record


@record
class Phrase:
    """A text of a report, and the names of things and regions of a level that it mentions.

    Phrases with the same text are equal, whatever they mention, because a reader cannot tell them
    apart: *in the middle* may mean a region of that name, or the middle of the level.
    """

    text: str
    mentions: Mentions = NO_MENTIONS

    def __eq__(self, other: object) -> bool:
        return self.text == other.text if isinstance(other, Phrase) else NotImplemented

    def __hash__(self) -> int:
        return hash((Phrase, self.text))


def phrase(*parts: Phrase | str) -> Phrase:
    """Join phrases and plain texts without a separator. A plain text mentions nothing."""
    phrases = [Phrase(part) if isinstance(part, str) else part for part in parts]
    return Phrase("".join(part.text for part in phrases), union(part.mentions for part in phrases))


def things_phrase(names: Sequence[str]) -> Phrase:
    """Return a phrase that lists and mentions things: ```a`, `b` and `c```. ``names`` must not be empty."""
    return Phrase(quoted_names(names), Mentions(tuple(names)))


def quoted_names(names: Sequence[str]) -> str:
    """Return a text that lists names: ```a`, `b` and `c```. ``names`` must not be empty."""
    *before, last = (f"`{name}`" for name in names)
    return f"{', '.join(before)} and {last}" if before else last
