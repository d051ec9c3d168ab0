"""Reward success, shaped with progress as the potential.

See :mod:`tltlc.monitor.reward_modes.potential`.
"""

from __future__ import annotations

from typing import Final

import torch
from torch import Tensor

from tltl_runtime.spec.batch.guards import PrimeSets
from tltl_runtime.spec.batch.progress_and_reward import approach
from tltl_runtime.spec.batch.reward_modes import BatchTransition
from tltlc.api import Fspa, RewardOptions, monitors


class PotentialReward:
    """Rewards success with 1, and shapes this reward with progress as the potential.

    The reward of a step is 1 on success, else 0, plus ``gamma * potential after - potential before``.
    The memory is the potential before the step, [N].
    """

    def __init__(self, fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> None:
        scalar = monitors.tables(fspa)
        primes = [tuple(prime for edge in improving for prime in edge.guard.primes) for improving in scalar.improving]
        self._improving = PrimeSets(primes, len(fspa.atoms), device, -1.0)
        self._base = torch.tensor(scalar.base_progress, dtype=dtype, device=device)
        self._size = torch.tensor([float(fspa.spec_size or 1)], dtype=dtype, device=device)
        self._gamma = options.gamma

    def start(self, count: int) -> Tensor:
        """Return the memory before the first sample: the base progress of the initial state, [count]."""
        return self._base[:1].repeat(count)

    def reward(self, step: BatchTransition, memory: Tensor) -> tuple[Tensor, Tensor]:
        """Return the rewards and the potential after the step, each [N].

        The potential is 0 if the step ends the episode.
        """
        nearest = self._improving.robustness_of(step.target, step.values)
        potential = self._base.index_select(0, step.target) + approach(nearest, self._size)
        after = potential.masked_fill_(step.done, 0.0)
        return (step.success + self._gamma * after).sub_(memory), after


MODE: Final = PotentialReward
