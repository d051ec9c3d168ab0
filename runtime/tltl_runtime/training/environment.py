"""Vector environments of Gymnasium as rsl-rl takes them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import gymnasium
import numpy as np
import torch
from gymnasium import spaces
from numpy.typing import NDArray
from rsl_rl.env import VecEnv
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.training.exploration import Visits
from tltl_runtime.vector.env import TLTL_INFO
from tltlc.record import record


@record
class Finished:
    """An episode that ended in training: ``steps`` long, in ``state`` of the automaton.

    ``reward`` is the sum of its rewards as the training counts them, ``progress`` is in [0, 1].
    """

    success: bool
    progress: float
    reward: float
    steps: int
    state: int


PLACES: Final = {**TLTL_INFO, "cell": np.int64}
"""What a vector environment tells at each step where visits of places count."""


class TrainingEnv(VecEnv):
    """A vector environment of :class:`~tltl_runtime.wrapper.TltlEnv` with ``SAME_STEP`` autoreset, for rsl-rl.

    Observation groups are the keys of the observation, float32 tensors [num_envs, ...] on ``device``; ``shapes`` are
    those of one environment.  Episodes that end go to :meth:`finished`.  ``seed`` is for the vector environment's
    reset: a number, or one for each environment.

    With ``visits`` the agent is rewarded, beside what the environment gives, for places that are new, which the
    environment tells in the columns :data:`PLACES` of its ``infos``.

    Raises:
        TypeError: the spaces are not a Dict of Boxes and a MultiDiscrete.
    """

    def __init__(
        self,
        env: gymnasium.vector.VectorEnv[Any, Any, Any],
        seed: int | Sequence[int],
        device: str = "cpu",
        visits: Visits | None = None,
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
        self.visits = visits
        self.cfg: dict[str, Any] = {}
        # Nothing is cut by rsl-rl: the spec's limit ends an episode.
        self.max_episode_length = 2**31
        self.episode_length_buf = torch.zeros(self.num_envs, dtype=torch.long)
        observation, _ = env.reset(seed=seed)  # type: ignore[arg-type]
        self._observation = self._tensors(observation)
        self._finished: list[Finished] = []

    def get_observations(self) -> TensorDict:
        """The observations of all environments now."""
        return self._observation

    def step(self, actions: Tensor) -> tuple[TensorDict, Tensor, Tensor, dict[str, Any]]:
        """Take a step in each environment with actions [num_envs, branches]."""
        taken = actions.to("cpu", torch.int64).numpy()
        observation, reward, terminated, truncated, infos = self.env.step(taken)
        self._observation = self._tensors(observation)
        over = terminated | truncated
        if self.visits is not None:
            # The place that an ended episode came to is not among the infos: the next one's is.
            reward = reward + np.where(over, 0.0, self.visits.bonus(infos["cell"], infos["state"]))
        if over.any():
            self._finished += _finished(infos["final_info"], np.flatnonzero(over))
        return (
            self._observation,
            torch.from_numpy(reward).to(self.device, torch.float32),
            torch.from_numpy(over).to(self.device),
            {"time_outs": torch.from_numpy(truncated).to(self.device)},
        )

    def finished(self) -> tuple[Finished, ...]:
        """The episodes that ended since this was last asked, in the order of their ends."""
        ended, self._finished = tuple(self._finished), []
        return ended

    def close(self) -> None:
        """Close the environments."""
        self.env.close()

    def _tensors(self, observation: Mapping[str, NDArray[Any]]) -> TensorDict:
        tensors = {key: torch.from_numpy(each).to(self.device, torch.float32) for key, each in observation.items()}
        return TensorDict(tensors, batch_size=[self.num_envs], device=self.device)


def _finished(infos: Mapping[str, Any], rows: NDArray[np.int64]) -> list[Finished]:
    episode = infos["episode"]
    return [
        Finished(
            success=bool(infos["success"][row]),
            progress=float(infos["progress"][row]),
            reward=float(episode["r"][row]),
            steps=int(episode["l"][row]),
            state=int(infos["state"][row]),
        )
        for row in rows
    ]
