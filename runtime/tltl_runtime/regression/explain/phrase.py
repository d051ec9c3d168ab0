"""Texts of a report, with the names of the things and regions that they mention."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.game.mentions import NO_MENTIONS, Mentions, union
from tltlc.api import record


@record
class Phrase:
    """A text of a report, and the names that it mentions.

    Phrases with the same text are equal, because a reader cannot tell them apart: *in the middle* may
    be in a region of that name, or in the middle of a level.
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
    """Return a list of things: ```a`, `b` and `c```. There is at least one."""
    return Phrase(quoted_names(names), Mentions(tuple(names)))


def quoted_names(names: Sequence[str]) -> str:
    """Return a list of names between backquotes: ```a`, `b` and `c```. There is at least one."""
    *before, last = (f"`{name}`" for name in names)
    return f"{', '.join(before)} and {last}" if before else last
