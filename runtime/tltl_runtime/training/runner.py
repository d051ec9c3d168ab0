"""The runner: rollouts and updates of rsl-rl, an iteration at a time."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import torch
from rsl_rl.runners import OnPolicyRunner
from rsl_rl.utils import check_nan

from tltl_runtime.training.environment import Finished, TrainingEnv
from tltlc.record import record


@record
class Iteration:
    """What a rollout and the update after it gave: ``number`` counts from 1, ``steps`` are those of all environments.

    ``losses`` are those of rsl-rl's PPO by name, ``collect_s`` and ``learn_s`` are wall-clock seconds.
    """

    number: int
    steps: int
    finished: tuple[Finished, ...]
    losses: dict[str, float]
    collect_s: float
    learn_s: float


class Runner(OnPolicyRunner):
    """rsl-rl's runner whose loop yields after each iteration, so that who drives it sees, keeps and stops."""

    env: TrainingEnv

    def iterations(self, most: int) -> Iterator[Iteration]:
        """Run up to ``most`` iterations, each as soon as it is asked for."""
        self.alg.train_mode()
        if self.is_distributed:
            self.alg.broadcast_parameters()
        observation = self.env.get_observations().to(self.device)
        for _ in range(most):
            began = time.perf_counter()
            with torch.inference_mode():
                for _ in range(self.cfg["num_steps_per_env"]):
                    observation = self._step(observation)
                self.alg.compute_returns(observation)
            collected = time.perf_counter()
            losses = self.alg.update()
            self.current_learning_iteration += 1
            yield Iteration(
                number=self.current_learning_iteration,
                steps=self.cfg["num_steps_per_env"] * self.env.num_envs,
                finished=self.env.finished(),
                losses=losses,
                collect_s=collected - began,
                learn_s=time.perf_counter() - collected,
            )

    def learn(self, num_learning_iterations: int, init_at_random_ep_len: bool = False) -> None:
        """Run all of the iterations, as rsl-rl's own does; raises ValueError for ``init_at_random_ep_len``."""
        if init_at_random_ep_len:
            raise ValueError("an episode's length is its automaton's business: it begins at its beginning")
        for _ in self.iterations(num_learning_iterations):
            pass

    def _step(self, observation: Any) -> Any:
        actions = self.alg.act(observation)
        observation, rewards, dones, extras = self.env.step(actions)
        check_nan(observation, rewards, dones)
        observation, rewards, dones = (each.to(self.device) for each in (observation, rewards, dones))
        self.alg.process_env_step(observation, rewards, dones, extras)
        return observation
