"""The stealth game as a :class:`~tltl_runtime.game.game.Game`.

The modules that play or draw are imported only when they are needed. So levels and recordings can
be read without pybullet.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import gymnasium

from tltl_runtime.game.episode import Cause
from tltl_runtime.game.game import Game
from tltl_runtime.game.geometry import Box, Point
from tltl_runtime.game.level import UnreachableEntity
from tltl_runtime.game.level_check import LevelCheck
from tltl_runtime.game.level_files import LevelFiles
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.game.recording_summary import GameFigures
from tltl_runtime.game.sensors import SensorChoice, Sensors
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.stealth.capabilities.feasible import is_infeasible, reach_warnings, unreachable_entities
from tltl_runtime.stealth.capabilities.vocabulary import params
from tltl_runtime.stealth.films import StealthFilms
from tltl_runtime.stealth.keyboard_play import StealthKeyboard
from tltl_runtime.stealth.level import StealthLevel, fixed_places
from tltl_runtime.stealth.level_maps import StealthMaps
from tltl_runtime.stealth.levels import file
from tltl_runtime.stealth.levels.dependencies import file_candidates, level_dependencies
from tltl_runtime.stealth.levels.identity import level_hash
from tltl_runtime.stealth.observation.sensors import choose_sensors, missing_sensors
from tltl_runtime.stealth.pictures import StealthPictures
from tltl_runtime.stealth.recordings.cause import cause
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.figures import figures
from tltl_runtime.stealth.recordings.file import from_bytes, read_episode, to_bytes
from tltl_runtime.stealth.snapshot import CHOICES
from tltl_runtime.stealth.world.physics_errors import player_fault
from tltl_runtime.stealth.world.player import DECISION
from tltlc.api import Diagnostic, Fspa, RewardOptions, TltlError

if TYPE_CHECKING:
    from tltl_runtime.stealth.episode_recorder import RecordEpisode


class StealthLevelFiles(LevelFiles[StealthLevel]):
    """Finds and reads the ``.toml`` files of levels.

    In all methods, ``name`` is the name of a shipped level or the path of a file. A variant of a
    level may have overlays: files with small changes to what the level uses.
    """

    def names(self) -> tuple[str, ...]:
        """Return the names of the levels that come with the package."""
        return file.level_names()

    def path(self, name: str) -> Path:
        """Return the path of a level's file, which may not exist."""
        return file.level_path(name)

    def variants(self, name: str) -> tuple[str, ...]:
        """Return the names of a level's variants, in the order of its file."""
        return file.variants(name)

    def overlays(self, name: str) -> tuple[str, ...]:
        """Return the names of the overlays in the folder ``overlays`` beside a level's file and in the package."""
        return file.shared_names(file.level_path(name), "overlays")

    def load_with_changes(self, name: str, variant: Variant) -> tuple[StealthLevel, tuple[str, ...]]:
        """Load a level in a variant; return it with the descriptions of the variant's overlays."""
        return file.level_and_changes(name, variant)

    def dependencies(self, name: str, variant: Variant) -> Iterator[Path]:
        """Yield the files that a level depends on: its own, assets (shared files), overlays, and its spec.

        Also yield each path where a new file would be used instead of an existing one.
        """
        return level_dependencies(file.level_path(name), variant)

    def candidates(self, name: str, variant: Variant, file_name: str) -> Iterator[Path]:
        """Yield the paths at which one of a level's files may be.

        ``file_name`` is the name of the file as the level lists it in ``files``, for example
        ``assets/guard.toml``.
        """
        return file_candidates(file.level_path(name), variant, file_name)

    def description(self, name: str, variant: Variant) -> str:
        """Return what the overlays of a variant change. If it has no overlays, return what the level is about."""
        level, changes = file.level_and_changes(name, variant)
        return " ".join(changes) or level.doc


class StealthGame(Game[StealthLevel, Episode]):
    """The stealth game, with the interface that all games of this package have."""

    choices = CHOICES
    level_files = StealthLevelFiles()
    pictures = StealthPictures()
    maps = StealthMaps()
    films = StealthFilms()
    keyboard = StealthKeyboard()
    modules = (__name__, "tltl_runtime.stealth.episode_recorder")

    def load_level(self, name: str, variant: str | Variant = "v0") -> StealthLevel:
        """Load a shipped level, by name, or one from a ``.toml`` file, in one of its variants."""
        return file.load_level(name, variant)

    def level_hash(self, level: StealthLevel) -> str:
        """Return the SHA-256, in hexadecimal, of the part of a level that can change an episode."""
        return level_hash(level)

    def params(self, level: StealthLevel) -> dict[str, float]:
        """Return the values that a level defines for parameters of specs, in SI units, by name."""
        return params(level)

    def check_fit(self, level: StealthLevel, fspa: Fspa, spec: str | Path | Fspa) -> None:
        """Raise a TltlError that lists everything that a spec needs and a level lacks.

        ``fspa`` is the automaton of ``spec``.
        """
        from tltl_runtime.stealth.env import check_fit

        check_fit(level, fspa, spec)

    def level_check(self, name: str, variant: str | Variant, sensors: SensorChoice | None) -> LevelCheck:
        """Read a level, and compute what a player can reach in it; the result checks specs against the level."""
        from tltl_runtime.stealth.level_check import StealthLevelCheck

        return StealthLevelCheck(name, variant, sensors)

    def choose_sensors(self, level: StealthLevel, choice: SensorChoice | None = None) -> Sensors:
        """Return the sensors of an agent: those in ``choice``, and the level's own for the rest."""
        return choose_sensors(level, choice)

    def missing_sensors(self, level: StealthLevel, sensors: Sensors) -> Iterator[str]:
        """Yield a text for each entity or signal that ``sensors`` names and the level lacks.

        An example of such a text is "the entity `exit`".
        """
        return missing_sensors(level, sensors)

    def landmarks(self, level: StealthLevel) -> dict[str, Point]:
        """Return the positions of the switches, exits and barriers, by name."""
        return fixed_places(level)

    def solids(self, level: StealthLevel) -> dict[str, Box]:
        """Return the boxes of all solids except the floor, by name."""
        return {solid.name: solid.box for solid in level.solids if solid.kind != "floor"}

    def barriers(self, level: StealthLevel) -> dict[str, Box]:
        """Return the boxes of the barriers, by name."""
        return {barrier.name: barrier.box for barrier in level.barriers}

    def clock_s(self, level: StealthLevel) -> float | None:
        """Return the time of a decision, which all levels share."""
        del level
        return DECISION

    def unreachable_entities(self, level: StealthLevel, fspa: Fspa) -> list[UnreachableEntity]:
        """Return the entities of a spec that no player can reach.

        Return an empty list if the level is too large to search.
        """
        return unreachable_entities(level, fspa)

    def is_infeasible(self, level: StealthLevel, fspa: Fspa) -> bool:
        """Return whether it is certain that no player can meet the spec."""
        return is_infeasible(level, fspa)

    def play_warnings(self, level: StealthLevel, fspa: Fspa) -> list[Diagnostic]:
        """Return a warning for each entity of a spec that no player can reach.

        If the level is too large to search, return a warning that says so.
        """
        return reach_warnings(level, fspa)

    def level_fault(self, error: RuntimeError) -> TltlError | None:
        """Return an error of the level if ``error`` says that the player has left it or has no room, else None.

        It is TLT0806 if the player has left the level's bounds, and TLT0807 if there is no room at the start.
        """
        return player_fault(error)

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
        """Make an environment of a level with a spec, by default the spec of the level."""
        from tltl_runtime.stealth.env import make_env

        return make_env(level, variant, spec, sensors=sensors, reward=reward, params=params, render_mode=render_mode)

    def recorder(self, env: gymnasium.Env[Any, Any], player: str = "unknown") -> RecordEpisode:
        """Wrap an environment to record its episodes, with ``player`` as the player's name."""
        from tltl_runtime.stealth.episode_recorder import RecordEpisode

        return RecordEpisode(env, player)

    def has_expert(self, env: EpisodeRecorder[Episode]) -> bool:
        """Return True: the scripted expert can play each level."""
        del env
        return True

    def expert_episodes(
        self, env: EpisodeRecorder[Episode], seeds: Iterable[int], *, careful: bool = True
    ) -> Iterator[Episode]:
        """Yield an episode of the scripted expert for each seed.

        An expert that is not ``careful`` plays as if no enemy could see it.
        """
        from tltl_runtime.stealth.expert.expert import expert_episodes

        return expert_episodes(env, seeds, careful=careful)

    def read_episode(self, path: Path) -> Episode:
        """Read a recorded episode from a file."""
        return read_episode(path)

    def episode_from_bytes(self, data: bytes, name: str) -> Episode:
        """Return the episode in the bytes of a file; messages call the file ``name``."""
        return from_bytes(data, name)

    def episode_bytes(self, episode: Episode) -> bytes:
        """Return the bytes that a file of the episode contains."""
        return to_bytes(episode)

    def check_replay(self, episode: Episode) -> tuple[Diagnostic, ...]:
        """Play the actions of an episode again, and compare the two episodes.

        Return an error (TLT0824) if they differ in any bit, else an empty tuple.
        """
        from tltl_runtime.stealth.recordings.replay_check import check_replay

        return check_replay(episode)

    def figures(self, episode: Episode) -> GameFigures:
        """Return the health at the end of an episode, and at how many moments an enemy saw the player."""
        return figures(episode)

    def cause(self, episode: Episode) -> Cause:
        """Return why an episode ended, for example which enemy killed the player."""
        return cause(episode)

    def observers(self, episode: Episode, begin_s: float, end_s: float) -> tuple[str, ...]:
        """Return the names of the enemies that saw the player between two times.

        The times are in seconds since the reset.
        """
        shots = [shot for shot in episode.snapshots if begin_s <= shot.time <= end_s]
        enemies = enumerate(episode.level.enemies)
        return tuple(enemy.name for row, enemy in enemies if any(shot.sees[row] for shot in shots))

    def shut_barriers(self, episode: Episode) -> tuple[str, ...]:
        """Return the names of the solid barriers that were shut at the end of an episode."""
        barriers = zip(episode.level.barriers, episode.snapshots[-1].open, strict=True)
        return tuple(barrier.name for barrier, is_open in barriers if barrier.kind == "solid" and not is_open)


GAME: Final = StealthGame()
"""The stealth game. :mod:`tltl_runtime.game.registry` finds it by this name."""
