"""Maps of a game's levels, as SVG for pages."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Generic

from tltl_runtime.game.level_files import LevelT
from tltl_runtime.game.mentions import NO_MENTIONS, Mentions
from tltl_runtime.game.recorder import EpisodeT

if TYPE_CHECKING:
    from markupsafe import Markup


class LevelMaps(ABC, Generic[LevelT, EpisodeT]):
    """Draws maps of a game's levels, and returns the data with which a page's script draws what moves on them.

    Each level must have bounds. Coordinates on a map are centimetres of the map, measured from the
    north-western corner of the bounds: see :mod:`~tltl_runtime.game.map_scale`.
    """

    values: tuple[str, ...] = ()
    """The names of the player's values in [0, 1], such as ``health``, that episodes record in addition to progress."""

    @abstractmethod
    def colours(self) -> Mapping[str, str]:
        """Return the colours of the maps by name, as ``#rrggbb``. The CSS property ``--map-NAME`` has each colour."""

    def metre(self, level: LevelT) -> float:
        """Return how many metres of a level a metre on its map stands for; by default 1."""
        del level
        return 1.0

    @abstractmethod
    def picture(self, level: LevelT, mentions: Mentions = NO_MENTIONS) -> Markup:
        """Draw the map of a level, and highlight the things and regions in ``mentions``.

        The map has the empty layers ``heat``, ``trajectories``, ``ends`` and ``live``, which the page's
        script fills.
        """

    @abstractmethod
    def key(self, level: LevelT, mentions: Mentions = NO_MENTIONS) -> Markup:
        """Return the legend of a map, with the signs that occur on it."""

    @abstractmethod
    def map_data(self, level: LevelT) -> dict[str, Any]:
        """Return what the page's script must know about a level to draw onto its map, as JSON data."""

    @abstractmethod
    def episode_data(self, level: LevelT, index: int, episode: EpisodeT) -> dict[str, Any]:
        """Return an episode as JSON data for the page's player, which draws it on the map of ``level``.

        ``index`` is the number of the episode within its case. The functions of
        :mod:`~tltl_runtime.game.packing` encode the values, and ``packing.js`` decodes them.
        """

    def empty_plan(
        self, level: LevelT, ways: Sequence[tuple[float, float]], episodes: Iterable[EpisodeT]
    ) -> LevelT | None:
        """Return a level without bounds, with an empty plan as its map; None if this is not possible, by default.

        The plan encloses ``ways``, points (x, y) in metres, and what moves in the recorded ``episodes``.
        """
        del level, ways, episodes
        return None

    def is_map_of(self, level: LevelT, episode: EpisodeT) -> bool:
        """Return whether the map of a level also fits a recorded episode of it; by default always."""
        del level, episode
        return True

    @abstractmethod
    def mentions(self, level: LevelT, text: str) -> Mentions:
        """Return the things and regions of a level that a designer's text mentions."""
