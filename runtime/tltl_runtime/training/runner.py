"""The runner: it makes rollouts and updates with rsl-rl, one iteration at a time."""

from __future__ import annotations

import io
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import redirect_stdout
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from rsl_rl.runners import OnPolicyRunner
from rsl_rl.utils import check_nan
from torch import Tensor, nn

from tltl_runtime.policies.spaces.distribution import IndependentParts
from tltl_runtime.policies.spaces.torch_model import Normalizer
from tltl_runtime.training.exploration.self_imitation import imitate
from tltl_runtime.training.files.report import Iteration
from tltl_runtime.training.ppo.distributed import process_group
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.ppo.torch_threads import threads
from tltlc.api import Diagnostic, TltlError

__all__ = ["Iteration", "Runner"]


class Runner(OnPolicyRunner):
    """An rsl-rl runner whose learning loop is a generator: it yields after each iteration.

    The runner prints nothing. Updates run in ``cfg["threads"]`` threads, because the environments
    wait during an update. In the first ``cfg["warm_up"]`` iterations only the critic learns. If the
    training has several processes, each must use the runner within
    :func:`~tltl_runtime.training.ppo.distributed.join_process_group`.
    """

    env: TrainingEnv
    is_out_of_time: Callable[[], bool]
    """Says whether the limit of minutes has passed; by default, there is none."""

    def __init__(
        self, env: TrainingEnv, train_cfg: dict[str, Any], log_dir: str | None = None, device: str = "cpu"
    ) -> None:
        self.is_out_of_time = lambda: False
        with redirect_stdout(io.StringIO()):
            super().__init__(env, train_cfg, log_dir, device)
        if not self.is_distributed:
            # In the channels-last layout, convolutions of small maps take two thirds of the time. rsl-rl cannot
            # average gradients in this layout over processes.
            for model in (self.alg.actor, self.alg.critic):
                model.to(memory_format=torch.channels_last)
        for group in self.alg.optimizer.param_groups:
            if "fused" in group:
                # Fused, the optimiser takes the same steps in a tenth of the time.
                group["fused"] = True

    def load_algorithm(self, saved: Mapping[str, Any]) -> None:
        """Restore what ``alg.save`` returned; the weights may have been saved in another memory layout."""
        self.alg.load(saved, None, strict=True)
        for parameter, state in self.alg.optimizer.state.items():
            # The fused optimiser assumes that its averages have the memory layout of the weights.
            state |= {
                name: _in_layout_of(value, parameter) for name, value in state.items() if value.shape == parameter.shape
            }
        _keep_old_scales(self.alg.actor, self.alg.critic)

    def load_actor(self, weights: Mapping[str, NDArray[np.float16]]) -> None:
        """Load weights, by name, into the actor. The critic keeps its random weights."""
        self.alg.actor.load_state_dict({name: torch.from_numpy(weight).float() for name, weight in weights.items()})
        _keep_old_scales(self.alg.actor)

    def scale_inverse_temperature(self, factor: float) -> None:
        """Multiply the actor's logits by ``factor``; above 1, this makes likely choices likelier.

        The continuous numbers of an action have normal distributions. Their variances are divided
        by ``factor``. Do nothing until more than ``cfg["warm_up"]`` iterations have ended.
        """
        if self.current_learning_iteration <= self.cfg.get("warm_up", 0):
            return
        last = [layer for layer in self.alg.actor.mlp if isinstance(layer, nn.Linear)][-1]
        distribution = self.alg.actor.distribution
        if isinstance(distribution, IndependentParts):
            distribution.sharpen(last, factor)
            return
        with torch.no_grad():
            for parameter in last.parameters():
                parameter.mul_(factor)

    def iterations(self) -> Iterator[Iteration]:
        """Run iterations; yield the result of each.

        Before each step, ask :attr:`is_out_of_time`. If it says so after the first iteration, drop the
        steps of the current iteration, and end.
        """
        self.alg.train_mode()
        if self.is_distributed:
            self.alg.broadcast_parameters()
        while True:
            started = time.perf_counter()
            observation = self.env.get_observations().to(self.device)
            with torch.inference_mode():
                for _ in range(self.cfg["num_steps_per_env"]):
                    if self.current_learning_iteration and self.is_out_of_time():
                        return
                    observation = self._step(observation)
                self.alg.compute_returns(observation)
            collected = time.perf_counter()
            warms_up = self.current_learning_iteration < self.cfg.get("warm_up", 0)
            # PPO's optimiser skips parameters without gradients and leaves their moments as they are.
            self.alg.actor.requires_grad_(not warms_up)
            with threads(self.cfg.get("threads", 1)):
                losses = {**self.alg.update(), **({} if warms_up else self._imitate())}
            self.current_learning_iteration += 1
            yield Iteration(
                number=self.current_learning_iteration,
                steps=self.cfg["num_steps_per_env"] * self.env.num_envs,
                finished=self.env.pop_finished(),
                losses=losses,
                collect_s=collected - started,
                learn_s=time.perf_counter() - collected,
                lost=self.env.pop_lost(),
            )

    def _configure_multi_gpu(self) -> None:
        """Set the attributes for several processes; unlike rsl-rl's method, allow any device.

        If there are several processes, they must have joined torch's process group before.
        """
        group = process_group()
        self.gpu_world_size, self.gpu_global_rank, self.gpu_local_rank = group.count, group.rank, group.local_rank
        self.is_distributed = group.count > 1
        names = {"global_rank": group.rank, "local_rank": group.local_rank, "world_size": group.count}
        self.cfg["multi_gpu"] = names if self.is_distributed else None

    def _step(self, observation: Any) -> Any:
        actions = self.alg.act(observation)
        observation, rewards, dones, extras = self.env.step(actions)
        self._check(observation, rewards, dones)
        observation, rewards, dones = (values.to(self.device) for values in (observation, rewards, dones))
        self.alg.process_env_step(observation, rewards, dones, extras)
        return observation

    def _imitate(self) -> dict[str, float]:
        """Take the self-imitation steps of an iteration; return their mean loss under ``imitation``.

        Return an empty dict if there is nothing to imitate. If any process has a batch to imitate,
        all processes take the step together, so that their weights stay equal.
        """
        self_imitation, losses = self.env.self_imitation, []
        for _ in range(self.cfg["imitation"] if self_imitation else 0):
            batch = self_imitation.draw() if self_imitation else None
            if not any(process_group().gather(batch is not None)):
                break
            observations, actions = batch or (self.env.get_observations()[:0], torch.zeros(0, self.env.num_actions))
            losses.append(imitate(self.alg, observations.to(self.device), actions.to(self.device)))
        return {"imitation": sum(losses) / len(losses)} if losses else {}

    def _check(self, observation: Any, rewards: Tensor, dones: Tensor) -> None:
        """Raise TltlError, TLT0854, if the environment gave values that are not finite numbers."""
        try:
            check_nan(observation, rewards, dones)
            for key, values in observation.items():
                if values.is_floating_point() and values.isinf().any():
                    raise ValueError(f"the part `{key}` of the observation has infinite values")
        except ValueError as error:
            title = f"iteration {self.current_learning_iteration + 1}: {error}"
            help_ = "fix the environment, or the sensor or signal that gives these values"
            raise TltlError([Diagnostic("TLT0854", title, help=help_)]) from None


def _keep_old_scales(*models: nn.Module) -> None:
    """Keep the scales of numbers that bounds alone scale in models whose weights were loaded."""
    for model in models:
        normalizer = getattr(model, "normalizer", None)
        if isinstance(normalizer, Normalizer):
            normalizer.freeze_if_unused()


def _in_layout_of(tensor: Tensor, parameter: Tensor) -> Tensor:
    """Return a copy of a tensor in the memory layout of a parameter."""
    return torch.empty_like(parameter, requires_grad=False).copy_(tensor)
