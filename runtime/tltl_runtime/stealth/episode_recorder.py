"""Record episodes while they are played."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium.utils import RecordConstructorArgs

from tltl_runtime.game.recorder import EpisodeRecorder, judging_wrapper, recorded_end
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.stealth.env import GameEnv
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.versions import versions
from tltl_runtime.stealth.snapshot import BRANCHES, Snapshot
from tltl_runtime.support.writable_folder import writable_folder
from tltlc.api import Step


class RecordEpisode(EpisodeRecorder[Episode], RecordConstructorArgs):
    """A wrapper that records the current episode and changes no observation, reward or info.

    ``env`` is a :class:`TltlEnv` over a :class:`GameEnv`, or wrappers around such an environment.
    ``player`` is the player's name in the recording. If there is a ``folder``, each finished
    episode is written into it as ``LEVEL-VARIANT-SEED.episode.npz``. If that file exists, the new
    file's name has a number after the seed. A missing folder is created.

    Raises:
        TypeError: ``env`` has no spec, or does not contain a :class:`GameEnv`.
        TltlError: TLT0005, the folder is not writable.
    """

    def __init__(
        self, env: gymnasium.Env[Any, Any], player: str = "unknown", *, folder: str | Path | None = None
    ) -> None:
        RecordConstructorArgs.__init__(self, player=player, folder=folder)
        gymnasium.Wrapper.__init__(self, env)
        self._game_env = _unwrapped_game(env)
        self._game = self._game_env.game
        self._judge = judging_wrapper(env)
        self._player = player
        self._folder = None if folder is None else writable_folder(Path(folder))
        self._names = tuple(signal.name for signal in self._judge.task.fspa.signals)
        self._rows: _EpisodeRows | None = None
        self._over = False

    @property
    def episode(self) -> Episode:
        """A copy of the episode so far; raises RuntimeError before the first reset."""
        if self._rows is None:
            raise RuntimeError("there is no episode before the first reset")
        return self._rows.episode(self._judge, self._player)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin a new episode, and drop the recording of the previous one from memory."""
        observation, info = self.env.reset(seed=seed, options=options)
        self._rows = _EpisodeRows(self._game.level, self._game.seed, self._game.snapshot(), self._signals())
        self._over = False
        return observation, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Take a step in the environment, and record it unless the episode was already over.

        If the step ends the episode and there is a folder, write the recording into it.

        Raises:
            RuntimeError: there was no reset before.
        """
        if self._rows is None:
            raise RuntimeError("there is no episode before the first reset")
        observation, reward, terminated, truncated, info = self.env.step(action)
        if not self._over:
            step = self._judge.taken
            assert step is not None
            atoms = tuple(info["atoms"].values())
            self._rows.add(self._game_env.action, self._game.snapshot(), self._signals(), atoms, step, info["success"])
            self._over = terminated or truncated
            if self._over and self._folder is not None:
                _write(self._folder, self.episode)
        return observation, reward, terminated, truncated, info

    def _signals(self) -> list[float]:
        sample = self._judge.sample
        return [float(sample[name]) for name in self._names]


class _EpisodeRows:
    """The data of an episode that is still being played, with a row for each time step.

    ``snapshots`` and ``signals`` have one more row: the first is for the moment of the reset.
    """

    def __init__(self, level: StealthLevel, seed: int, snapshot: Snapshot, signals: list[float]) -> None:
        self.level, self.seed = level, seed
        self.snapshots, self.signals = [snapshot], [signals]
        self.actions: list[list[int]] = []
        self.atoms: list[tuple[float, ...]] = []
        self.steps: list[Step] = []
        self.success = False

    def add(
        self,
        action: list[int],
        snapshot: Snapshot,
        signals: list[float],
        atoms: tuple[float, ...],
        step: Step,
        success: bool,
    ) -> None:
        """Append a row: an ``action``, and the state of the game and of the spec after this action."""
        self.actions.append(action)
        self.snapshots.append(snapshot)
        self.signals.append(signals)
        self.atoms.append(atoms)
        self.steps.append(step)
        self.success = success

    def episode(self, judge: TltlEnv, player: str) -> Episode:
        """Return the episode so far; ``judge`` is the environment wrapper that evaluated the spec in it."""
        fspa, steps, count = judge.task.fspa, self.steps, len(self.steps)
        return Episode(
            level=self.level,
            fspa=fspa,
            params=dict(judge.task.params),
            player=player,
            seed=self.seed,
            actions=np.array(self.actions, dtype=np.uint8).reshape(count, len(BRANCHES)),
            snapshots=tuple(self.snapshots),
            signals=np.array(self.signals, dtype=np.float64).reshape(count + 1, len(fspa.signals)),
            atoms=np.array(self.atoms, dtype=np.float64).reshape(count, len(fspa.atoms)),
            states=np.array([0, *(step.state for step in steps)], dtype=np.int32),
            progress=np.array([0.0, *(step.progress for step in steps)], dtype=np.float64),
            rewards=np.array([step.reward for step in steps], dtype=np.float64),
            verdict=steps[-1].verdict if steps else fspa.states[0].verdict,
            success=self.success,
            end=recorded_end(steps[-1] if steps else None, self.success),
            reward=judge.task.reward,
            versions=versions(),
        )


def _unwrapped_game(env: gymnasium.Env[Any, Any]) -> GameEnv:
    inner = env.unwrapped
    if not isinstance(inner, GameEnv):
        raise TypeError(f"only the stealth game can be recorded, not {type(inner).__name__}: make_env(LEVEL) makes one")
    return inner


def _write(folder: Path, episode: Episode) -> None:
    from tltl_runtime.game.recording_path import file_stem, new_path
    from tltl_runtime.stealth.recordings.file import write_episode

    write_episode(new_path(folder, file_stem(episode)), episode)
