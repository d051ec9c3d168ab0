"""The runner: rollouts and updates of rsl-rl, an iteration at a time."""

from __future__ import annotations

import io
import time
from collections.abc import Iterator, Mapping
from contextlib import redirect_stdout
from typing import Any

import torch
from rsl_rl.runners import OnPolicyRunner
from rsl_rl.utils import check_nan
from torch import Tensor, nn

from tltl_runtime.policies.threads import threads
from tltl_runtime.training.exploration.self_imitation import imitate
from tltl_runtime.training.ppo.distributed import peers
from tltl_runtime.training.ppo.environment import Finished, TrainingEnv
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


@record
class Iteration:
    """What a rollout and the update after it gave: ``number`` counts from 1, ``steps`` are those of all environments.

    ``losses`` are those of rsl-rl's PPO by name, and that of the ``imitation`` where there was one; ``collect_s`` and
    ``learn_s`` are wall-clock seconds.
    """

    number: int
    steps: int
    finished: tuple[Finished, ...]
    losses: dict[str, float]
    collect_s: float
    learn_s: float


class Runner(OnPolicyRunner):
    """rsl-rl's runner whose loop yields after each iteration, so that who drives it sees, keeps and stops.

    It prints nothing.  Updates are computed in ``cfg["threads"]`` threads, since nobody plays meanwhile.  In the first
    ``cfg["warm_up"]`` iterations the critic alone learns.  With several processes,
    :func:`~tltl_runtime.training.ppo.distributed.joined` is around it.
    """

    env: TrainingEnv

    def __init__(
        self, env: TrainingEnv, train_cfg: dict[str, Any], log_dir: str | None = None, device: str = "cpu"
    ) -> None:
        with redirect_stdout(io.StringIO()):
            super().__init__(env, train_cfg, log_dir, device)
        if not self.is_distributed:
            # Convolutions of small maps take two thirds of the time so; rsl-rl cannot average such gradients.
            for model in (self.alg.actor, self.alg.critic):
                model.to(memory_format=torch.channels_last)
        for group in self.alg.optimizer.param_groups:
            if "fused" in group:
                # The same steps in a tenth of the time.
                group["fused"] = True

    def take_up(self, saved: Mapping[str, Any]) -> None:
        """Take up what ``alg.save`` gave, also of a runner whose weights lie in another order in memory."""
        self.alg.load(saved, None, strict=True)
        for parameter, state in self.alg.optimizer.state.items():
            # The fused optimiser takes it for granted that all of them lie as the weights do.
            state |= {name: _like(each, parameter) for name, each in state.items() if each.shape == parameter.shape}

    def begin_with(self, weights: Mapping[str, Tensor]) -> None:
        """Give the actor these weights, by name; the critic's stay as they were drawn."""
        self.alg.actor.load_state_dict({name: each.float() for name, each in weights.items()})

    def sharpen(self, factor: float) -> None:
        """Multiply the actor's logits: by more than 1, what is likelier becomes likelier still.

        In the first ``cfg["warm_up"]`` iterations they are left as they are.
        """
        if self.current_learning_iteration <= self.cfg.get("warm_up", 0):
            return
        last = [layer for layer in self.alg.actor.mlp if isinstance(layer, nn.Linear)][-1]
        with torch.no_grad():
            for each in last.parameters():
                each.mul_(factor)

    def iterations(self) -> Iterator[Iteration]:
        """Run an iteration each time that one is asked for, without end."""
        self.alg.train_mode()
        if self.is_distributed:
            self.alg.broadcast_parameters()
        while True:
            began = time.perf_counter()
            observation = self.env.get_observations().to(self.device)
            with torch.inference_mode():
                for _ in range(self.cfg["num_steps_per_env"]):
                    observation = self._step(observation)
                self.alg.compute_returns(observation)
            collected = time.perf_counter()
            warms_up = self.current_learning_iteration < self.cfg.get("warm_up", 0)
            # What has no gradient is left as it is by PPO's optimiser, its moments among it.
            self.alg.actor.requires_grad_(not warms_up)
            with threads(self.cfg.get("threads", 1)):
                losses = {**self.alg.update(), **({} if warms_up else self._imitate())}
            self.current_learning_iteration += 1
            yield Iteration(
                number=self.current_learning_iteration,
                steps=self.cfg["num_steps_per_env"] * self.env.num_envs,
                finished=self.env.finished(),
                losses=losses,
                collect_s=collected - began,
                learn_s=time.perf_counter() - collected,
            )

    def _configure_multi_gpu(self) -> None:
        """What rsl-rl's own does, but for any device, and for a group of processes that is there already."""
        own = peers()
        self.gpu_world_size, self.gpu_global_rank, self.gpu_local_rank = own.count, own.rank, own.local_rank
        self.is_distributed = own.count > 1
        names = {"global_rank": own.rank, "local_rank": own.local_rank, "world_size": own.count}
        self.cfg["multi_gpu"] = names if self.is_distributed else None

    def _step(self, observation: Any) -> Any:
        actions = self.alg.act(observation)
        observation, rewards, dones, extras = self.env.step(actions)
        self._check(observation, rewards, dones)
        observation, rewards, dones = (each.to(self.device) for each in (observation, rewards, dones))
        self.alg.process_env_step(observation, rewards, dones, extras)
        return observation

    def _imitate(self) -> dict[str, float]:
        """Imitate where there is something to; processes do it together, so that their weights stay equal."""
        lessons, losses = self.env.lessons, []
        for _ in range(self.cfg["imitation"] if lessons else 0):
            drawn = lessons.draw() if lessons else None
            if not any(peers().gather(drawn is not None)):
                break
            observations, actions = drawn or (self.env.get_observations()[:0], torch.zeros(0, self.env.num_actions))
            losses.append(imitate(self.alg, observations.to(self.device), actions.to(self.device)))
        return {"imitation": sum(losses) / len(losses)} if losses else {}

    def _check(self, observation: Any, rewards: Tensor, dones: Tensor) -> None:
        """Raise TltlError, TLT0854, where the environment gave values that are no numbers."""
        try:
            check_nan(observation, rewards, dones)
        except ValueError as error:
            title = f"iteration {self.current_learning_iteration + 1}: {error}"
            help_ = "mend the environment, or the sensor or signal that gives them"
            raise TltlError([Diagnostic("TLT0854", title, help=help_)]) from None


def _like(tensor: Tensor, parameter: Tensor) -> Tensor:
    """The same numbers, in the order in memory of a parameter."""
    return torch.empty_like(parameter, requires_grad=False).copy_(tensor)
