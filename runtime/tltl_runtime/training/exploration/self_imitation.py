"""Self-imitation of known ways, where the agent does not succeed yet.

The success of a way may depend on a few decisions, for example a jump at the right place.  A policy
that has come to prefer other actions no longer tries them.  So the agent imitates the ways that the
search found, and its own successes, but only where it still fails: Oh et al., Self-imitation
learning, ICML 2018.  The imitation baseline is another method: see ``gail.py``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

import gymnasium
import numpy as np
import torch
from numpy.typing import NDArray
from rsl_rl.algorithms import PPO
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import SuccessfulEpisode

BATCH: Final = 256
"""The number of decisions that are drawn for an optimiser step."""


class SelfImitation:
    """Draws self-imitation batches from the ways of ``restarts``.

    Observations come from replaying the ways in an environment of ``make``.
    """

    def __init__(self, make: Callable[[], gymnasium.Env[Any, Any]], restarts: ReverseCurriculum) -> None:
        self._make, self._restarts = make, restarts
        self._env: gymnasium.Env[Any, Any] | None = None
        self._sensed: dict[int, tuple[SuccessfulEpisode, Mapping[str, NDArray[Any]]]] = {}
        """Ways and their observations, by ``id`` of the way, which is valid as the way is kept."""

    def draw(self) -> tuple[TensorDict, Tensor] | None:
        """Draw up to ``BATCH`` decisions: observations and actions [n, branches].

        Returns None if there is nothing to imitate.
        """
        decisions = self._restarts.lessons(BATCH)
        if not decisions:
            return None
        known = {id(way) for ways in self._restarts.ways.values() for way in ways}
        self._sensed = {key: sensed for key, sensed in self._sensed.items() if key in known}
        for way, _ in decisions:
            if id(way) not in self._sensed:
                self._sensed[id(way)] = way, self._observations(way)
        rows = [(self._sensed[id(way)][1], index) for way, index in decisions]
        sensed = {
            name: torch.from_numpy(np.stack([values[name][index] for values, index in rows])).to(torch.float32)
            for name in rows[0][0]
        }
        actions = torch.tensor([way.actions[index] for way, index in decisions], dtype=torch.float32)
        return TensorDict(sensed, batch_size=[len(rows)]), actions

    def close(self) -> None:
        """Free the game."""
        if self._env is not None:
            self._env.close()

    def _observations(self, way: SuccessfulEpisode) -> Mapping[str, NDArray[Any]]:
        """Return the observations before each decision of a way."""
        self._env = self._env or self._make()
        first, _ = self._env.reset(seed=way.seed)
        observations = [first, *(self._env.step(action)[0] for action in way.actions[:-1])]
        return {name: np.stack([observation[name] for observation in observations]) for name in first}


def imitate(ppo: PPO, observations: TensorDict, actions: Tensor) -> float:
    """Take an optimiser step towards these actions; return the loss, their negative log-likelihood.

    The sum is divided by ``BATCH`` even for smaller batches, so that a small batch counts less.
    """
    ppo.actor(observations, stochastic_output=True)
    loss = -ppo.actor.get_output_log_prob(actions).sum() / BATCH
    ppo.optimizer.zero_grad()
    loss.backward()
    if ppo.is_multi_gpu:
        ppo.reduce_parameters()
    torch.nn.utils.clip_grad_norm_(ppo.actor.parameters(), ppo.max_grad_norm)
    ppo.optimizer.step()
    return float(loss.item())
