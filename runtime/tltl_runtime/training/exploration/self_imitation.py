"""Self-imitation of known demonstrations, where the agent does not succeed yet.

The success of a demonstration may depend on a few decisions, for example a jump at the right place.
A policy that has come to prefer other actions no longer tries them. So the agent imitates the
demonstrations that the search found, and its own successes, but only where it still fails: Oh et
al., Self-imitation learning, ICML 2018. The imitation baseline is another method: see
:mod:`~tltl_runtime.training.imitation.gail`.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any, Final

import gymnasium
import numpy as np
import torch
from numpy.typing import NDArray
from rsl_rl.algorithms import PPO
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.exploration.observation_encoding import ObservationEncoding
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import SuccessfulEpisode
from tltl_runtime.wire.errors import WireError

BATCH: Final = 256
"""The number of decisions that are drawn for one optimiser step."""
_REPLAYS: Final = 3
"""How often a demonstration is replayed at most, if the game is lost each time."""


class SelfImitation:
    """Draws batches of decisions to imitate from the demonstrations of ``curriculum``.

    To get the observations, it replays the demonstrations in an environment that ``make`` returns.
    If a game in another process is lost there, it is started again. A demonstration in which it is lost
    each time is not imitated; a warning says so.
    ``layouts`` say how observations become arrays; None if the network uses them without
    conversion.
    """

    def __init__(
        self,
        make: Callable[[], gymnasium.Env[Any, Any]],
        curriculum: ReverseCurriculum,
        layouts: SpaceLayouts | None = None,
    ) -> None:
        self._make, self._curriculum = make, curriculum
        self._observations_encoding = ObservationEncoding(layouts)
        self._env: gymnasium.Env[Any, Any] | None = None
        self._observed: dict[int, tuple[SuccessfulEpisode, Mapping[str, NDArray[Any]] | None]] = {}
        """The demonstrations and their observations, by the ``id`` of the demonstration.

        The observations are None if the game was lost each time.
        The demonstrations are kept so that their ``id`` stays valid.
        """

    def draw(self) -> tuple[TensorDict, Tensor] | None:
        """Draw up to ``BATCH`` decisions to imitate; return None if there is nothing to imitate.

        The result has the observations, as tensors [n, ...] by key, and the actions, as rows
        [n, width].
        """
        decisions = self._curriculum.draw_decisions(BATCH)
        if not decisions:
            return None
        current_ids = {
            id(demonstration)
            for demonstrations in self._curriculum.demonstrations.values()
            for demonstration in demonstrations
        }
        self._observed = {key: observations for key, observations in self._observed.items() if key in current_ids}
        for demonstration, _ in decisions:
            if id(demonstration) not in self._observed:
                self._observed[id(demonstration)] = demonstration, self._observations(demonstration)
        rows = []
        for demonstration, index in decisions:
            if (values := self._observed[id(demonstration)][1]) is not None:
                rows.append((values, demonstration.actions, index))
        if not rows:
            return None
        observations = {name: np.stack([values[name][index] for values, _, index in rows]) for name in rows[0][0]}
        actions = torch.tensor([actions[index] for _, actions, index in rows], dtype=torch.float32)
        return self._observations_encoding.tensors(observations), actions

    def close(self) -> None:
        """Close the environment."""
        if self._env is not None:
            self._env.close()

    def _observations(self, demonstration: SuccessfulEpisode) -> Mapping[str, NDArray[Any]] | None:
        """Return the observations before the decisions of a demonstration: arrays by key.

        The arrays are [n, ...] for n decisions. Return None, with a warning, if the game is lost each time.
        """
        for _ in range(_REPLAYS):
            try:
                return self._replayed(demonstration)
            except WireError as error:
                lost = error.diagnostics[0]
        warnings.warn(
            f"{lost.code}: {lost.title}: the demonstration of seed {demonstration.seed} is not imitated", stacklevel=2
        )
        return None

    def _replayed(self, demonstration: SuccessfulEpisode) -> Mapping[str, NDArray[Any]]:
        """Replay a demonstration; return its observations. Raises WireError if the game is lost."""
        self._env = self._env or self._make()
        encoding = ActionEncoding(self._env.action_space)
        first, _ = self._env.reset(seed=demonstration.seed)
        actions = map(encoding.value, encoding.flat(demonstration.actions[:-1]))
        return self._observations_encoding.stacked([first, *(self._env.step(action)[0] for action in actions)])


def imitate(ppo: PPO, observations: TensorDict, actions: Tensor) -> float:
    """Take one optimiser step of ``ppo`` that makes these actions likelier; return the loss.

    ``observations`` [n, ...] and ``actions`` [n, width] are a batch of decisions. The loss is
    the sum of the actions' negative log-likelihoods in nats, divided by ``BATCH``. The divisor
    stays the same for smaller batches, so that a small batch counts less.
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
