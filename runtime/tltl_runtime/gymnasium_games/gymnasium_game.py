"""The games that game files describe, all together as one :class:`~tltl_runtime.game.game.Game`.

Each level of this game is a scene of a game file, which says how the environment is made.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, Final

import gymnasium

from tltl_runtime.game.episode import Cause
from tltl_runtime.game.game import Game
from tltl_runtime.game.geometry import Box, Point
from tltl_runtime.game.level_name import GAME_FILE, Variant, is_scene, parse_variant, split_scene
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.game.sensors import SensorChoice
from tltl_runtime.gymnasium_games.entity_positions import PLAYER
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.installed_code import installed_code_hash
from tltl_runtime.gymnasium_games.scene_cause import scene_cause
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_episode_file import (
    read_scene_episode,
    scene_episode_bytes,
    scene_episode_from_bytes,
)
from tltl_runtime.gymnasium_games.scene_files import SceneFiles
from tltl_runtime.gymnasium_games.scene_films import SceneFilms
from tltl_runtime.gymnasium_games.scene_keyboard import SceneKeyboard
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltl_runtime.gymnasium_games.scene_maps import SceneMaps
from tltl_runtime.gymnasium_games.scene_pictures import ScenePictures
from tltl_runtime.spec.wrapper import TltlEnv
from tltlc.api import Diagnostic, Fspa, RewardOptions, TltlError, replace


class GymnasiumGame(Game[SceneLevel, SceneEpisode]):
    """All games that game files describe."""

    level_files = SceneFiles()
    recordings_have_levels = False
    promises_replays = False
    pictures = ScenePictures()
    films = SceneFilms()
    keyboard = SceneKeyboard()
    maps = SceneMaps()
    modules = (__name__, "tltl_runtime.gymnasium_games.scene_recorder", "tltl_runtime.gymnasium_games.scene_env")

    def load_level(self, name: str, variant: str | Variant = "v0") -> SceneLevel:
        """Load a scene, ``FILE.game.toml:SCENE``, in one of its variants; nothing is imported or run."""
        chosen = parse_variant(variant) if isinstance(variant, str) else variant
        return self.level_files.load_with_changes(name, chosen)[0]

    def level_hash(self, level: SceneLevel) -> str:
        """Return the SHA-256 of what can change an episode: files, and the versions of packages.

        :func:`~tltl_runtime.gymnasium_games.scene_hash.scene_hash` lists them.
        """
        return level.content_hash

    def clock_s(self, level: SceneLevel) -> float | None:
        """Return the clock of the game file; None if it has none, or if it is unknown where the scene is."""
        return read_game_file(Path(split_scene(level.place)[0])).clock_s if level.place else None

    def installed_code(self, level: SceneLevel) -> str:
        """Return a hash of the packages that the game file names; empty if it is unknown where the scene is."""
        if not level.place:
            return ""
        return installed_code_hash(read_game_file(Path(split_scene(level.place)[0])))

    def check_fit(self, level: SceneLevel, fspa: Fspa, spec: str | Path | Fspa) -> None:
        """Do nothing: the signals of a scene are known only when it is played."""

    def landmarks(self, level: SceneLevel) -> dict[str, Point]:
        """Return the positions of the entities that did not move in the recorded episodes, by name."""
        return dict(level.landmarks)

    def solids(self, level: SceneLevel) -> dict[str, Box]:
        """Return the boxes of the outline by name; boxes that share a name are left out."""
        boxes = () if level.outline is None else level.outline.boxes
        counts = Counter(item.name for item in boxes)
        return {item.name: item.box for item in boxes if counts[item.name] == 1}

    def played_level(self, level: SceneLevel, episodes: Iterable[SceneEpisode]) -> SceneLevel:
        """Return a scene with the outline of the first episode, and the landmarks that are the same in all episodes."""
        played = list(episodes)
        if not played:
            return level
        first, *others = [{} if episode.entities is None else episode.entities.still() for episode in played]
        landmarks = tuple(item for item in first.items() if all(item in other.items() for other in others))
        outline = played[0].level.outline
        varies = level.is_one_of_many or any(episode.level.outline != outline for episode in played)
        return replace(level, outline=outline, landmarks=landmarks, is_one_of_many=varies)

    def make_env(
        self,
        level: str | os.PathLike[str],
        variant: str | Variant = "v0",
        spec: str | Path | Fspa | None = None,
        *,
        sensors: SensorChoice | None = None,
        reward: RewardOptions | None = None,
        params: Mapping[str, float] | None = None,
        render_mode: str | None = None,
    ) -> TltlEnv:
        """Make an environment of a scene with a spec, by default the spec of the scene.

        ``sensors`` are ignored, because the environment makes the observation.
        """
        from tltl_runtime.gymnasium_games.scene_env import make_scene_env

        del sensors
        name = os.fspath(level)
        loaded = self.load_level(name, variant)
        path, _ = split_scene(name)
        env = make_scene_env(
            Path(path), loaded.name, loaded.variant, spec, reward=reward, params=params, render_mode=render_mode
        )
        env.level = loaded  # type: ignore[attr-defined]
        return env

    def recorder(self, env: gymnasium.Env[Any, Any], player: str = "unknown") -> EpisodeRecorder[SceneEpisode]:
        """Wrap an environment to record its episodes, with ``player`` as the player's name."""
        from tltl_runtime.gymnasium_games.scene_recorder import SceneRecorder

        return SceneRecorder(env, player)

    def player_position(self, env: gymnasium.Env[Any, Any]) -> Point | None:
        """Return the position of the entity ``player``, as ``tltl_positions`` gives it."""
        positions: Mapping[str, Point] = env.get_wrapper_attr("scene_positions")() or {}
        return positions.get(PLAYER)

    def level_bounds(self, env: gymnasium.Env[Any, Any]) -> Box | None:
        """Return the bounds of the outline, as ``tltl_outline`` gives it."""
        outline = env.get_wrapper_attr("scene_outline")()
        return None if outline is None else outline.bounds

    def runs_already(self, level: SceneLevel) -> bool:
        """Return whether the game file says with ``connect`` where the game is running."""
        wire = read_game_file(Path(split_scene(level.place)[0])).wire if level.place else None
        return wire is not None and bool(wire.connect)

    def plays_at_once(self, env: gymnasium.Env[Any, Any]) -> bool:
        """Return whether the game file starts the game; a game that is running plays for one environment."""
        wire = env.get_wrapper_attr("game_file").wire
        return wire is None or not wire.connect

    def is_same_game(self, level: SceneLevel, other: SceneLevel) -> bool:
        """Return whether two scenes are of game files with the same name."""
        return level.game_name == other.game_name

    def has_expert(self, env: EpisodeRecorder[SceneEpisode]) -> bool:
        """Return whether the environment has an expert of its own: a method ``tltl_expert``."""
        return env.has_wrapper_attr("tltl_expert")

    def expert_episodes(
        self, env: EpisodeRecorder[SceneEpisode], seeds: Iterable[int], *, careful: bool = True
    ) -> Iterator[SceneEpisode]:
        """Yield an episode of the game's own expert, ``tltl_expert``, for each seed."""
        del careful
        choose = env.get_wrapper_attr("scene_expert")(env.get_wrapper_attr("task"))
        for seed in seeds:
            observation, _ = env.reset(seed=seed)
            over = False
            while not over:
                observation, _, terminated, truncated, _ = env.step(choose(observation))
                over = terminated or truncated
            yield env.episode

    def read_episode(self, path: Path) -> SceneEpisode:
        """Read a recorded episode from a file."""
        return read_scene_episode(path)

    def episode_from_bytes(self, data: bytes, name: str) -> SceneEpisode:
        """Return the episode in the bytes of a file; messages call the file ``name``."""
        return scene_episode_from_bytes(data, name)

    def episode_bytes(self, episode: SceneEpisode) -> bytes:
        """Return the bytes that a file of the episode contains."""
        return scene_episode_bytes(episode)

    def located(self, episode: SceneEpisode, level: str, variant: str | None) -> SceneEpisode:
        """Return ``episode`` with the place of its scene, so that it can be played again.

        ``level`` is ``FILE.game.toml:SCENE``, or ``FILE.game.toml`` for the recorded scene. ``variant`` is
        None for the recorded variant.

        Raises:
            TltlError: the errors of :meth:`load_level`; TLT0800, the episode was played in another scene.
        """
        if not is_scene(level):
            title = f"the recording is of the game `{episode.level.game_name}`, not of the level `{level}`"
            help_ = f"name the game file with which it was played: `{episode.level.game_name}{GAME_FILE}`"
            raise TltlError([Diagnostic("TLT0800", title, help=help_)])
        if split_scene(level)[1] is None:
            level = f"{level}:{episode.level.name}"
        here = self.load_level(level, variant or episode.level.variant)
        if here.name != episode.level.name:
            title = f"the recording is of the scene `{episode.level.name}`, not of `{here.name}`"
            raise TltlError([Diagnostic("TLT0800", title, help="name that scene after the game file, or leave it out")])
        return replace(episode, level=replace(episode.level, place=here.place, variant=here.variant))

    def check_replay(self, episode: SceneEpisode) -> tuple[Diagnostic, ...] | None:
        """Play the actions of an episode again, and compare the signals.

        Return TLT0824 if a signal or the end differs, an empty tuple if not, and None if it is unknown
        where the episode's scene is: see :meth:`located`.
        """
        from tltl_runtime.gymnasium_games.scene_replay import check_replay

        return check_replay(episode) if episode.level.place else None

    def cause(self, episode: SceneEpisode) -> Cause:
        """Return why an episode ended."""
        return scene_cause(episode)


GAME: Final = GymnasiumGame()
"""The game for all game files. :mod:`tltl_runtime.game.registry` finds it by this name."""
