"""Self-imitation: of known ways, where the agent does not succeed yet.  The imitation baseline is ``gail.py``.

Whether a way succeeds may hang on a few of its decisions, such as a jump at the right place, which a policy that has
come to prefer others does not try any more.  Imitated are the ways that the search found and the agent's own
successes, and only where the agent has yet to learn: Oh et al., Self-imitation learning, ICML 2018.
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

from tltl_runtime.training.exploration.reverse_curriculum import Restarts
from tltl_runtime.training.exploration.search import Way

BATCH: Final = 256
"""Decisions that are drawn for a step of the optimiser."""


class Lessons:
    """Decisions on the ways of ``restarts``, with what the agent senses there: they are played again in an environment
    that ``make`` makes.
    """

    def __init__(self, make: Callable[[], gymnasium.Env[Any, Any]], restarts: Restarts) -> None:
        self._make, self._restarts = make, restarts
        self._env: gymnasium.Env[Any, Any] | None = None
        self._sensed: dict[int, tuple[Way, Mapping[str, NDArray[Any]]]] = {}
        """Ways by their identity, with what is sensed along each."""

    def draw(self) -> tuple[TensorDict, Tensor] | None:
        """Observations and actions [n, branches] of up to ``BATCH`` decisions; None where there is nothing to learn."""
        decisions = self._restarts.lessons(BATCH)
        if not decisions:
            return None
        known = {id(way) for ways in self._restarts.ways.values() for way in ways}
        self._sensed = {key: sensed for key, sensed in self._sensed.items() if key in known}
        for way, _ in decisions:
            if id(way) not in self._sensed:
                self._sensed[id(way)] = way, self._along(way)
        rows = [(self._sensed[id(way)][1], index) for way, index in decisions]
        sensed = {
            name: torch.from_numpy(np.stack([along[name][index] for along, index in rows])).to(torch.float32)
            for name in rows[0][0]
        }
        actions = torch.tensor([way.actions[index] for way, index in decisions], dtype=torch.float32)
        return TensorDict(sensed, batch_size=[len(rows)]), actions

    def close(self) -> None:
        """Free the game."""
        if self._env is not None:
            self._env.close()

    def _along(self, way: Way) -> Mapping[str, NDArray[Any]]:
        """What is sensed before each decision of a way."""
        self._env = self._env or self._make()
        first, _ = self._env.reset(seed=way.seed)
        along = [first, *(self._env.step(action)[0] for action in way.actions[:-1])]
        return {name: np.stack([each[name] for each in along]) for name in first}


def imitate(ppo: PPO, observations: TensorDict, actions: Tensor) -> float:
    """Take a step of the optimiser towards these actions; the loss, their negative log-likelihood.

    It is divided by ``BATCH`` however few they are: the less there is to learn, the less it counts.
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
