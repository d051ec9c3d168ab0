"""Maps of a game's levels, as SVG for pages."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Generic

from tltl_runtime.game.level_files import LevelT
from tltl_runtime.game.mentions import NO_MENTIONS, Mentions
from tltl_runtime.game.recorder import EpisodeT

if TYPE_CHECKING:
    from markupsafe import Markup


class LevelMaps(ABC, Generic[LevelT, EpisodeT]):
    """Draws maps of a game's levels, and gives a page's script the data of what moves on them.

    The levels have bounds. Lengths on a map are in centimetres of the map, from the north-western
    corner of the level's bounds: see :mod:`~tltl_runtime.game.map_scale`.
    """

    values: tuple[str, ...] = ()
    """The names of the values in [0, 1] of a player, beside progress, that recorded episodes show."""

    @abstractmethod
    def colours(self) -> Mapping[str, str]:
        """Return the colours of the maps by name, as ``#rrggbb``: the property ``--map-NAME`` in CSS."""

    def metre(self, level: LevelT) -> float:
        """Return the length in a level, in metres, that is a metre on its map; by default 1."""
        del level
        return 1.0

    @abstractmethod
    def picture(self, level: LevelT, mentions: Mentions = NO_MENTIONS) -> Markup:
        """Draw the map of a level, with what a report ``mentions`` highlighted.

        The page's script fills its layers ``heat``, ``trajectories``, ``ends`` and ``live``.
        """

    @abstractmethod
    def key(self, level: LevelT, mentions: Mentions = NO_MENTIONS) -> Markup:
        """Return the legend of a map, with the signs that occur on it."""

    @abstractmethod
    def map_data(self, level: LevelT) -> dict[str, Any]:
        """Return what the page's script must know of a level to draw onto its map, as JSON data."""

    @abstractmethod
    def episode_data(self, level: LevelT, index: int, episode: EpisodeT) -> dict[str, Any]:
        """Return an episode as JSON data for the page's player, which draws it on the map of ``level``.

        ``index`` is the number of the episode within its case.

        The functions of :mod:`~tltl_runtime.game.packing` encode the values, and ``packing.js``
        decodes them.
        """

    def is_map_of(self, level: LevelT, episode: EpisodeT) -> bool:
        """Return whether a recorded episode was played on the map of a level; by default always."""
        del level, episode
        return True

    @abstractmethod
    def mentions(self, level: LevelT, text: str) -> Mentions:
        """Return the things and regions of a level that a designer's text mentions."""
