"""Vector environments of Gymnasium as rsl-rl takes them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from numpy.typing import NDArray
from rsl_rl.env import VecEnv
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.training.exploration.reset_distribution import Episodes
from tltl_runtime.training.exploration.reverse_curriculum import Restarts
from tltl_runtime.training.exploration.search import end_of
from tltl_runtime.training.exploration.self_imitation import Lessons
from tltl_runtime.training.imitation.imitation_data import Demonstrated
from tltl_runtime.vector import WorkerVectorEnv
from tltlc.core.record import record


@record
class Finished:
    """An episode that ended in training: ``steps`` long, in ``state`` of the automaton; ``progress`` is in [0, 1].

    Of one that was ``violated`` it is the state before.
    """

    success: bool
    progress: float
    steps: int
    state: int
    violated: bool


class TrainingEnv(VecEnv):
    """A vector environment of :class:`~tltl_runtime.spec.wrapper.TltlEnv` with ``SAME_STEP`` autoreset, for rsl-rl.

    Observation groups are the keys of the observation, float32 tensors [num_envs, ...] on ``device``; ``shapes`` are
    those of one environment.  Episodes that end go to :meth:`finished`.  ``seed`` is for the vector environment's
    reset: a number, or one for each environment.

    With ``restarts`` they say where episodes begin, whose seeds ``seed`` then does not tell; those that do not begin at
    the level's start are not among the ``finished``.  ``replayed`` counts the decisions that led to their starts.
    ``lessons`` are decisions that the runner is to imitate; ``demonstrated`` are those that the algorithm is to.
    ``dearer`` says how much more an episode may cost that fails after so many steps; ``severity``, in [0, 1], 0 at
    first, is the share of that by which it does.

    Raises:
        TypeError: the spaces are not a Dict of Boxes and a MultiDiscrete.
    """

    def __init__(
        self,
        env: WorkerVectorEnv,
        seed: int | Sequence[int],
        device: str = "cpu",
        restarts: Restarts | None = None,
        lessons: Lessons | None = None,
        demonstrated: Demonstrated | None = None,
        dearer: Callable[[int], float] | None = None,
    ) -> None:
        if not isinstance(env.single_action_space, spaces.MultiDiscrete):
            raise TypeError(f"actions of several branches are needed, a MultiDiscrete, not {env.single_action_space}")
        if not isinstance(env.single_observation_space, spaces.Dict):
            raise TypeError(f"an observation of several parts is needed, a Dict, not {env.single_observation_space}")
        self.env = env
        self.num_envs = env.num_envs
        self.branches = tuple(int(each) for each in env.single_action_space.nvec)
        self.num_actions = len(self.branches)
        self.shapes = {key: tuple(each.shape or ()) for key, each in env.single_observation_space.items()}
        self.device = device
        self.restarts = restarts
        self.lessons = lessons
        self.demonstrated = demonstrated
        self._dearer = dearer
        self.severity = 0.0
        self.cfg: dict[str, Any] = {}
        # Nothing is cut by rsl-rl: the spec's limit ends an episode.
        self.max_episode_length = 2**31
        self.episode_length_buf = torch.zeros(self.num_envs, dtype=torch.long)
        self._replayed_before = 0
        self._episodes = Episodes(env, restarts.draw) if restarts else None
        observation = self._episodes.observation if self._episodes else env.reset(seed=seed)[0]
        self._observation = self._tensors(observation)
        self._finished: list[Finished] = []

    def get_observations(self) -> TensorDict:
        """The observations of all environments now."""
        return self._observation

    def step(self, actions: Tensor) -> tuple[TensorDict, Tensor, Tensor, dict[str, Any]]:
        """Take a step in each environment with actions [num_envs, branches].

        The extras tell of each whether the limit ended the episode (``time_outs``), and whether it met the spec
        (``successes``), bools [num_envs].
        """
        taken = actions.to("cpu", torch.int64).numpy()
        step = self._episodes.step if self._episodes else self.env.step
        observation, reward, terminated, truncated, infos = step(taken)
        over = terminated | truncated
        ended = _finished(infos["final_info"], np.flatnonzero(over)) if over.any() else {}
        successes = torch.zeros(self.num_envs, dtype=torch.bool)
        for row, each in ended.items():
            successes[row] = each.success
            if self._dearer and not each.success:
                reward[row] -= self.severity * self._dearer(self._taken(row, each))
        if self._episodes and self.restarts:
            ends = {row: end_of(infos["final_info"], row) for row, each in ended.items() if each.success}
            states = {row: each.state for row, each in ended.items()}
            cut = _learned(self.restarts, self._episodes, over, ends, states)
            ended = {row: each for row, each in ended.items() if self._episodes.starts[row].part is None}
            self._episodes.turn(over)
            if cut.any():
                observation = self._episodes.cut(cut)
                over, truncated = over | cut, truncated | cut
        self._finished += ended.values()
        self._observation = self._tensors(observation)
        return (
            self._observation,
            torch.from_numpy(reward).to(self.device, torch.float32),
            torch.from_numpy(over).to(self.device),
            {"time_outs": torch.from_numpy(truncated).to(self.device), "successes": successes.to(self.device)},
        )

    @property
    def replayed(self) -> int:
        """How many decisions were played again to begin where others had been."""
        return self._replayed_before + (self._episodes.replayed if self._episodes else 0)

    def begin_anew(self) -> None:
        """Break off all episodes, and begin others: something else has used the vector environment meanwhile."""
        assert self._episodes is not None
        assert self.restarts is not None
        self._replayed_before += self._episodes.replayed
        self._episodes = Episodes(self.env, self.restarts.draw)
        self._observation = self._tensors(self._episodes.observation)

    def finished(self) -> tuple[Finished, ...]:
        """The episodes that ended since this was last asked, in the order of their ends."""
        ended, self._finished = tuple(self._finished), []
        return ended

    def _taken(self, row: int, episode: Finished) -> int:
        """How many steps the monitor of the episode that ended in this row has seen, those played again too."""
        return len(self._episodes.actions[row]) if self._episodes else episode.steps

    def _tensors(self, observation: Mapping[str, NDArray[Any]]) -> TensorDict:
        tensors = {key: torch.from_numpy(each).to(self.device, torch.float32) for key, each in observation.items()}
        return TensorDict(tensors, batch_size=[self.num_envs], device=self.device)


def _learned(
    restarts: Restarts,
    episodes: Episodes,
    over: NDArray[np.bool_],
    ends: Mapping[int, int],
    states: Mapping[int, int],
) -> NDArray[np.bool_]:
    """Let the restarts learn from episodes that are over, with the ends of those that met the spec and the states of
    all, and from those that take too long: which these are.
    """
    spent = np.array([episodes.is_spent(row) for row in range(len(over))]) & ~over
    for row in [*np.flatnonzero(over).tolist(), *np.flatnonzero(spent).tolist()]:
        restarts.ended(episodes.starts[row], episodes.actions[row], ends.get(row), states.get(row))
    return spent


def _finished(infos: Mapping[str, Any], rows: NDArray[np.int64]) -> dict[int, Finished]:
    """The episodes that ended, by their environments."""
    episode = infos["episode"]
    return {
        int(row): Finished(
            success=bool(infos["success"][row]),
            progress=float(infos["progress"][row]),
            steps=int(episode["l"][row]),
            state=int(infos["unmet"][row]),
            violated=infos["verdict"][row] == "violated",
        )
        for row in rows
    }
