"""Episodes that were lost with their games: their number, and when too many were lost to go on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Final, TypeVar

from tltl_runtime.wire.errors import WireError
from tltlc.api import Diagnostic, record, replace

MOST_IN_A_ROW: Final = 3
"""If more episodes than these are lost one after the other, the game is at fault each time."""

_SHARE: Final = 10
"""At most a tenth of the episodes may be lost."""

Episode = TypeVar("Episode")


@record
class LostEpisodes:
    """``count`` episodes were lost with their games; ``first`` says how the first of these was lost."""

    count: int
    first: Diagnostic

    @property
    def text(self) -> str:
        """How many episodes were lost, and why the first one was: ``2 episodes were lost: the game …``."""
        counted = "1 episode was" if self.count == 1 else f"{self.count:,} episodes were"
        return f"{counted} lost: {self.first.title}"

    @property
    def line(self) -> str:
        """The text and the help, with the last standard error of the game that was lost first, in one line."""
        return f"{self.text} ({' | '.join((self.first.help or '').splitlines())})" if self.first.help else self.text

    @property
    def warning(self) -> Diagnostic:
        """The warning with this text; its help has the last standard error of the game that was lost first."""
        return replace(self.first, title=self.text, severity="warning")


def lost_episodes(faults: Sequence[Diagnostic]) -> LostEpisodes | None:
    """Return the lost episodes that ``faults`` are about; None if there are none."""
    return LostEpisodes(len(faults), faults[0]) if faults else None


def together(parts: Iterable[LostEpisodes | None]) -> LostEpisodes | None:
    """Return the lost episodes of several parts of a play, as one; None if no part has any."""
    lost = [part for part in parts if part is not None]
    return LostEpisodes(sum(part.count for part in lost), lost[0].first) if lost else None


class LossLimit:
    """Counts the episodes that are lost with their games, and ends the play if there are too many.

    ``most`` is the number of episodes that may be lost, see :func:`most_lost`; of many episodes, a tenth.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._played = self._lost = self._in_a_row = 0

    def add_played(self) -> None:
        """Count an episode that was played until it ended or was cut off."""
        self._played, self._in_a_row = self._played + 1, 0

    def add_lost(self, fault: Diagnostic) -> None:
        """Count a lost episode; ``fault`` says what happened.

        Raises:
            WireError: with ``fault``, if too many episodes were lost, or too many in a row.
        """
        self._lost, self._in_a_row = self._lost + 1, self._in_a_row + 1
        most = max(self._most, (self._played + self._lost) // _SHARE)
        if self._lost > most or self._in_a_row > MOST_IN_A_ROW:
            raise WireError([fault])


def going_on(
    begin: Callable[[], Iterator[Episode]], limit: LossLimit, on_lost: Callable[[Diagnostic], None]
) -> Iterator[Episode]:
    """Yield the episodes that ``begin()`` plays; if a game is lost, begin again, without the lost episode.

    ``begin`` returns an iterator over the episodes that are left, and ``on_lost`` gets what happened to the game.

    Raises:
        WireError: too many episodes were lost, or too many in a row.
    """
    while True:
        try:
            for episode in begin():
                limit.add_played()
                yield episode
            return
        except WireError as error:
            on_lost(error.diagnostics[0])
            limit.add_lost(error.diagnostics[0])


def most_lost(episodes: int) -> int:
    """Return how many of this many episodes may be lost: a tenth, but at least one if another one is left."""
    return max(episodes // _SHARE, min(1, episodes - 1))
