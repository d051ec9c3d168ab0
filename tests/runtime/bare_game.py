"""A game that offers only what every game must: a player walks along a corridor of seven cells."""

from __future__ import annotations

import os
import pickle
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from tltl_runtime.game.episode import Cause, EndKind
from tltl_runtime.game.game import Game
from tltl_runtime.game.geometry import Box, Region
from tltl_runtime.game.level import LevelSpec, default_spec
from tltl_runtime.game.level_files import LevelFiles
from tltl_runtime.game.level_name import Variant, parse_variant
from tltl_runtime.game.recorder import EpisodeRecorder
from tltl_runtime.game.sensors import SensorChoice, Sensors
from tltl_runtime.spec.episode_summary import End, settled_end
from tltl_runtime.spec.wrapper import TltlEnv
from tltlc.api import Fspa, RewardOptions, Step, record

SPEC = "signal x: number in [0, 10]\nspec far {\n  limit 8 steps\n  reach x > 3\n}\n"


@record
class BareLevel:
    """A corridor; ``spec`` is in the current folder."""

    name: str = "corridor"
    variant: str = "v0"
    spec: LevelSpec | None = LevelSpec(Path("far.tltl"), "far")
    sensors: Sensors = Sensors((), (), None)
    files: tuple[tuple[str, str], ...] = ()
    bounds: Box = Box((0.0, 0.0, 0.0), (7.0, 1.0, 1.0))
    regions: tuple[Region, ...] = ()

    @property
    def game(self) -> Game[Any, Any]:
        return GAME


@record
class BareEpisode:
    """A recorded walk."""

    level: BareLevel
    fspa: Fspa
    params: Mapping[str, float]
    player: str
    seed: int
    actions: NDArray[Any]
    times: NDArray[np.float64]
    positions: NDArray[np.float64]
    signals: NDArray[np.float64]
    atoms: NDArray[np.float64]
    states: NDArray[np.int32]
    progress: NDArray[np.float64]
    rewards: NDArray[np.float64]
    reward: RewardOptions
    verdict: str
    versions: Mapping[str, str]
    success: bool
    end: End


class Corridor(gymnasium.Env[Any, Any]):
    """Action 1 goes to the next cell, and action 0 stays."""

    observation_space = spaces.Box(0.0, 10.0, (1,), np.float32)
    action_space = spaces.MultiDiscrete([2])

    def __init__(self) -> None:
        self.level = BareLevel()
        self.x = 0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        self.x = 0
        return np.array([self.x], dtype=np.float32), {}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        self.x = min(6, self.x + int(action[0]))
        return np.array([self.x], dtype=np.float32), 0.0, False, False, {}

    def tltl_signals(self) -> dict[str, float]:
        return {"x": float(self.x)}


class BareRecorder(EpisodeRecorder[BareEpisode]):
    """Records walks."""

    def __init__(self, env: TltlEnv, player: str) -> None:
        super().__init__(env)
        self._judge, self._player, self._seed = env, player, 0
        self._actions: list[int] = []
        self._xs: list[float] = []
        self._atoms: list[list[float]] = []
        self._steps: list[Step] = []
        self._success = False

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        result = self.env.reset(seed=seed, options=options)
        self._seed, self._actions, self._atoms, self._steps = seed or 0, [], [], []
        self._xs = [float(self._judge.sample["x"])]
        return result

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        result = self.env.step(action)
        assert self._judge.taken is not None
        self._actions.append(int(action[0]))
        self._xs.append(float(self._judge.sample["x"]))
        self._atoms.append(list(result[4]["atoms"].values()))
        self._steps.append(self._judge.taken)
        self._success = result[4]["success"]
        return result

    @property
    def episode(self) -> BareEpisode:
        task, steps = self._judge.task, self._steps
        rows = np.zeros((len(self._xs), 3))
        rows[:, 0] = self._xs
        return BareEpisode(
            level=BareLevel(),
            fspa=task.fspa,
            params=dict(task.params),
            player=self._player,
            seed=self._seed,
            actions=np.array(self._actions, dtype=np.int64).reshape(-1, 1),
            times=np.arange(len(self._xs)) / 10.0,
            positions=rows,
            signals=np.array(self._xs).reshape(-1, 1),
            atoms=np.array(self._atoms),
            states=np.array([0, *(step.state for step in steps)], dtype=np.int32),
            progress=np.array([0.0, *(step.progress for step in steps)]),
            rewards=np.array([step.reward for step in steps]),
            reward=task.reward,
            verdict=steps[-1].verdict,
            versions={"corridor": "1"},
            success=self._success,
            end=settled_end(self._success, steps[-1].verdict) if steps[-1].done else "stopped",
        )


class BareLevelFiles(LevelFiles[BareLevel]):
    """There is one level, in no file."""

    def names(self) -> tuple[str, ...]:
        return ("corridor",)

    def path(self, name: str) -> Path:
        return Path(name)

    def variants(self, name: str) -> tuple[str, ...]:
        return ("v0",)

    def overlays(self, name: str) -> tuple[str, ...]:
        return ()

    def load_with_changes(self, name: str, variant: Variant) -> tuple[BareLevel, tuple[str, ...]]:
        return BareLevel(), ()

    def dependencies(self, name: str, variant: Variant) -> Iterator[Path]:
        return iter(())

    def candidates(self, name: str, variant: Variant, file_name: str) -> Iterator[Path]:
        return iter(())


class BareGame(Game[BareLevel, BareEpisode]):
    """The game of the corridor."""

    level_files = BareLevelFiles()
    modules = (__name__,)

    def load_level(self, name: str, variant: str | Variant = "v0") -> BareLevel:
        return self.level_files.load_with_changes(name, parse_variant("v0"))[0]

    def level_hash(self, level: BareLevel) -> str:
        return "0" * 64

    def check_fit(self, level: BareLevel, fspa: Fspa, spec: str | Path | Fspa) -> None:
        assert [signal.name for signal in fspa.signals] == ["x"]

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
        return TltlEnv(Corridor(), spec or default_spec(BareLevel()), reward=reward, params=params)

    def recorder(self, env: gymnasium.Env[Any, Any], player: str = "unknown") -> BareRecorder:
        assert isinstance(env, TltlEnv)
        return BareRecorder(env, player)

    def read_episode(self, path: Path) -> BareEpisode:
        return self.episode_from_bytes(path.read_bytes(), str(path))

    def episode_from_bytes(self, data: bytes, name: str) -> BareEpisode:
        episode = pickle.loads(data)
        assert isinstance(episode, BareEpisode)
        return episode

    def episode_bytes(self, episode: BareEpisode) -> bytes:
        return pickle.dumps(episode)

    def cause(self, episode: BareEpisode) -> Cause:
        kind: EndKind = "success" if episode.success else "limit"
        end = float(episode.times[-1])
        return Cause(kind, (), end, (float(episode.positions[-1][0]), 0.0, 0.0), f"{kind} after {end:.1f} s")


class ExpertGame(BareGame):
    """The same game with a scripted expert, but without pictures and films."""

    def has_expert(self, env: EpisodeRecorder[BareEpisode]) -> bool:
        return True

    def expert_episodes(
        self, env: EpisodeRecorder[BareEpisode], seeds: Iterable[int], *, careful: bool = True
    ) -> Iterator[BareEpisode]:
        for seed in seeds:
            yield walk(env, seed)


def walk(env: EpisodeRecorder[BareEpisode], seed: int) -> BareEpisode:
    """Walk until the end of the episode."""
    env.reset(seed=seed)
    over = False
    while not over:
        _, _, terminated, truncated, _ = env.step([1])
        over = terminated or truncated
    return env.episode


GAME: BareGame = BareGame()
