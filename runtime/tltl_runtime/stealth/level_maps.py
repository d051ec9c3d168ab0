"""The maps of the stealth game's levels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from tltl_runtime.game.level_maps import LevelMaps
from tltl_runtime.game.mentions import NO_MENTIONS, Mentions, mentions_in
from tltl_runtime.stealth.level import StealthLevel, entity_names
from tltl_runtime.stealth.recordings.episode import Episode

if TYPE_CHECKING:
    from markupsafe import Markup


class StealthMaps(LevelMaps[StealthLevel, Episode]):
    """Draws maps of levels. The modules that draw are imported only when a method needs them."""

    values = ("health",)

    def colours(self) -> Mapping[str, str]:
        """Return the colours of things on a map, as ``#rrggbb``, by names such as ``barrier-laser``."""
        from tltl_runtime.stealth.map_drawing.colours import colours

        return colours()

    def picture(self, level: StealthLevel, mentions: Mentions = NO_MENTIONS) -> Markup:
        """Return a map of everything in a level that does not move, as SVG.

        The things and regions in ``mentions`` are highlighted.
        """
        from tltl_runtime.stealth.map_drawing.level_map import level_map

        return level_map(level, mentions)

    def key(self, level: StealthLevel, mentions: Mentions = NO_MENTIONS) -> Markup:
        """Return the legend of a level's map as HTML, with the signs that occur on the map."""
        from tltl_runtime.stealth.map_drawing.level_map import map_key

        return map_key(level, mentions)

    def map_data(self, level: StealthLevel) -> dict[str, Any]:
        """Return what blocks sight in a level, and how its enemies see, as JSON data."""
        from tltl_runtime.stealth.map_drawing.level_map import map_data

        return map_data(level)

    def episode_data(self, level: StealthLevel, index: int, episode: Episode) -> dict[str, Any]:
        """Return the player, the enemies, the movers, switches and barriers of an episode over time.

        The result is JSON data. ``index``, the number of the episode within its test case, is
        copied into it.
        """
        from tltl_runtime.stealth.map_drawing.recording_data import recording_data

        del level
        return recording_data(index, episode)

    def mentions(self, level: StealthLevel, text: str) -> Mentions:
        """Return the entities, solids and regions of a level that a designer's text mentions."""
        things = (*entity_names(level), *(solid.name for solid in level.solids))
        return mentions_in(text, things, [region.name for region in level.regions])
