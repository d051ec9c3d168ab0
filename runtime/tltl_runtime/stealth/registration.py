"""The stealth game as one game among others.

What plays or draws is imported when it is used: levels and recordings can be read without pybullet.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import gymnasium

from tltl_runtime.game.episode import Trajectory
from tltl_runtime.game.game import Game
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.game.sensors import SensorChoice, Sensors
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.stealth.capabilities.vocabulary import params
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.levels.identity import level_hash
from tltl_runtime.stealth.observation.sensors import missing_sensors
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.file import read_episode, to_bytes
from tltl_runtime.stealth.recordings.trajectory import trajectory
from tltl_runtime.stealth.snapshot import CHOICES
from tltlc.api import Fspa, RewardOptions

if TYPE_CHECKING:
    from tltl_runtime.stealth.recording import RecordEpisode


class StealthGame(Game[Level, Episode]):
    """The stealth game."""

    choices = CHOICES
    modules = (__name__, "tltl_runtime.stealth.recording")

    def load_level(self, name: str, variant: str = "v0") -> Level:
        """Load a shipped level, by name, or one from a ``.toml`` file, in one of its variants."""
        return load_level(name, variant)

    def level_hash(self, level: Level) -> str:
        """Return the hash of the content of a level."""
        return level_hash(level)

    def params(self, level: Level) -> dict[str, float]:
        """Return a level's params."""
        return params(level)

    def check_fit(self, level: Level, fspa: Fspa, spec: str | Path | Fspa) -> None:
        """Raise one TltlError for everything that a spec needs and a level lacks."""
        from tltl_runtime.stealth.env import check_fit

        check_fit(level, fspa, spec)

    def missing_sensors(self, level: Level, sensors: Sensors) -> Iterator[str]:
        """Yield the entities and signals that the sensors refer to and a level does not have."""
        return missing_sensors(level, sensors)

    def make_env(
        self,
        level: str | os.PathLike[str],
        variant: str = "v0",
        spec: str | Path | Fspa | None = None,
        *,
        sensors: SensorChoice | None = None,
        reward: RewardOptions | None = None,
        params: Mapping[str, float] | None = None,
        render_mode: str | None = None,
    ) -> TltlEnv:
        """Make a level with a spec."""
        from tltl_runtime.stealth.env import make_env

        return make_env(level, variant, spec, sensors=sensors, reward=reward, params=params, render_mode=render_mode)

    def recorder(self, env: gymnasium.Env[Any, Any], player: str = "unknown") -> RecordEpisode:
        """Return an environment that records its episodes."""
        from tltl_runtime.stealth.recording import RecordEpisode

        return RecordEpisode(env, player)

    def expert_episodes(
        self, env: EpisodeRecorder[Episode], seeds: Iterable[int], *, careful: bool = True
    ) -> Iterator[Episode]:
        """Yield an episode of the scripted expert for each seed."""
        from tltl_runtime.stealth.expert.expert import expert_episodes

        return expert_episodes(env, seeds, careful=careful)

    def read_episode(self, path: Path) -> Episode:
        """Read a recorded episode."""
        return read_episode(path)

    def episode_bytes(self, episode: Episode) -> bytes:
        """Return the bytes of the file of an episode."""
        return to_bytes(episode)

    def trajectory(self, episode: Episode) -> Trajectory:
        """Return the trajectory of an episode."""
        return trajectory(episode)


GAME: Final = StealthGame()
"""The game, as :mod:`tltl_runtime.game.registry` looks it up."""
