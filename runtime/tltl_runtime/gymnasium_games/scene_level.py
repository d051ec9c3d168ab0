"""The scenes of a game file as levels."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from tltl_runtime.game.geometry import Box, Point, Region
from tltl_runtime.game.level import LevelSpec, parse_level_spec
from tltl_runtime.game.outline import LevelOutline
from tltl_runtime.game.sensors import Sensors
from tltlc.api import record

if TYPE_CHECKING:
    from tltl_runtime.gymnasium_games.gymnasium_game import GymnasiumGame

_NO_SENSORS: Final = Sensors((), (), None)


def _spec_text(spec: LevelSpec | None) -> str:
    return "" if spec is None else spec.text


@record
class SceneLevel:
    """A variant of a scene of a game file.

    ``game_name`` is the name of the game. ``options`` are the keyword arguments with which the
    environment is made. ``content_hash`` is the SHA-256, in hexadecimal, of everything in the game
    file and the scene's files that can change an episode. ``files`` has the name and the SHA-256 of
    each of these files; the game file is the first. ``place`` is the scene as an argument,
    ``FILE.game.toml:SCENE``, with which it can be played. It is empty for the level of a recording.

    The remaining fields are known only after the scene was played. ``outline`` is the one that the game
    showed in the recorded episode; None if it showed none. ``landmarks`` are the entities that did not
    move, with their positions. ``is_one_of_many`` is true if other episodes had other outlines.
    """

    json_texts = MappingProxyType({"spec": (_spec_text, parse_level_spec)})

    name: str
    variant: str
    game_name: str
    options: Mapping[str, Any]
    spec: LevelSpec | None
    content_hash: str
    files: tuple[tuple[str, str], ...]
    place: str = ""
    outline: LevelOutline | None = None
    landmarks: tuple[tuple[str, Point], ...] = ()
    is_one_of_many: bool = False

    @property
    def game(self) -> GymnasiumGame:
        """The game of all levels that are scenes of game files."""
        from tltl_runtime.gymnasium_games.gymnasium_game import GAME

        return GAME

    @property
    def sensors(self) -> Sensors:
        """No sensors: the environment makes the observation."""
        return _NO_SENSORS

    @property
    def bounds(self) -> Box | None:
        """The bounds of the outline; None if there is none."""
        return None if self.outline is None else self.outline.bounds

    @property
    def regions(self) -> tuple[Region, ...]:
        """The regions of the outline; none without an outline."""
        return () if self.outline is None else self.outline.regions
