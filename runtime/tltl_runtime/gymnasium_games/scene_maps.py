"""The maps of scenes whose games show outlines."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from tltl_runtime.game.level_maps import LevelMaps
from tltl_runtime.game.mentions import NO_MENTIONS, Mentions, mentions_in
from tltl_runtime.game.outline import LevelOutline
from tltl_runtime.game.palette import ENDS, INK
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltl_runtime.gymnasium_games.scene_map_scale import bounds_around, scene_metre
from tltlc.api import replace

if TYPE_CHECKING:
    from markupsafe import Markup

FLOOR, AREA, BOX, LANDMARK, ENTITY = "#f1f5f9", "#bae6fd", "#475569", "#facc15", "#c2410c"
_COLOURS: Final[Mapping[str, str]] = {
    "floor": FLOOR,
    "area": AREA,
    "wall": BOX,
    "landmark": LANDMARK,
    "entity": ENTITY,
    **{f"end-{end}": colour for end, (_, colour) in ENDS.items()},
    "ink": INK,
}


class SceneMaps(LevelMaps[SceneLevel, SceneEpisode]):
    """Draws maps of scenes with outlines. The modules for drawing are imported only when a map is drawn."""

    def colours(self) -> Mapping[str, str]:
        """Return the colours of what an outline shows, of landmarks and of entities."""
        return _COLOURS

    def metre(self, level: SceneLevel) -> float:
        """Return how many metres of a scene a metre on its map stands for; all maps have the same size."""
        return scene_metre(level)

    def picture(self, level: SceneLevel, mentions: Mentions = NO_MENTIONS) -> Markup:
        """Draw the outline of a scene, and its landmarks."""
        from tltl_runtime.gymnasium_games.scene_map import scene_map

        return scene_map(level, mentions)

    def key(self, level: SceneLevel, mentions: Mentions = NO_MENTIONS) -> Markup:
        """Return the legend of a map, with the signs that occur on it."""
        from tltl_runtime.gymnasium_games.scene_map import scene_map_key

        return scene_map_key(level, mentions)

    def map_data(self, level: SceneLevel) -> dict[str, Any]:
        """Return an empty mapping: the page's script needs no data about a scene to draw onto its map."""
        del level
        return {}

    def episode_data(self, level: SceneLevel, index: int, episode: SceneEpisode) -> dict[str, Any]:
        """Return an episode as JSON data: where the player and the entities are, and what the spec says."""
        from tltl_runtime.gymnasium_games.scene_playback import scene_playback

        return scene_playback(level, index, episode)

    def empty_plan(
        self, level: SceneLevel, ways: Sequence[tuple[float, float]], episodes: Iterable[SceneEpisode]
    ) -> SceneLevel:
        """Return a scene whose game shows no outline, with an empty outline around ways and entities."""
        import numpy as np

        points = [np.array(ways, dtype=np.float64).reshape(-1, 2)]
        points += [episode.entities.places[..., :2].reshape(-1, 2) for episode in episodes if episode.entities]
        places = np.concatenate(points)
        return replace(level, outline=LevelOutline(bounds_around(places[~np.isnan(places[:, 0])])))

    def is_map_of(self, level: SceneLevel, episode: SceneEpisode) -> bool:
        """Return whether an episode has the outline of ``level``, or none; False if the level's outline varies.

        A game may return another outline after each reset.
        """
        return episode.level.outline in (None, level.outline) and not level.is_one_of_many

    def mentions(self, level: SceneLevel, text: str) -> Mentions:
        """Return the landmarks, boxes, areas and regions that a text mentions."""
        things = [name for name, _ in level.landmarks]
        if level.outline is not None:
            things += [*(item.name for item in level.outline.boxes), *(area.name for area in level.outline.polygons)]
        return mentions_in(text, dict.fromkeys(things), [region.name for region in level.regions])
