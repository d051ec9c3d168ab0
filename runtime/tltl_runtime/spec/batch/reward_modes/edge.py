"""Reward, at every step, how near the automaton is to leaving its state.

See :mod:`tltlc.monitor.reward_modes.edge`.
"""

from __future__ import annotations

from typing import Final

import torch
from torch import Tensor

from tltl_runtime.spec.batch.guards import PrimeSets
from tltl_runtime.spec.batch.reward_modes import BatchTransition
from tltlc.api import Fspa, Implicant, RewardOptions


class EdgeReward:
    """Rewards each step with the robustness of the most robust edge to another state.

    Edges into traps do not count. The reward is 0 if no edge counts.
    """

    def __init__(self, fspa: Fspa, _: RewardOptions, device: torch.device, dtype: torch.dtype) -> None:
        self._device, self._dtype = device, dtype
        leaving: list[list[Implicant]] = [[] for _ in fspa.states]
        for edge in fspa.edges:
            if edge.target != edge.source and fspa.states[edge.target].distance is not None:
                leaving[edge.source] += edge.guard.primes
        self._leaving = PrimeSets([tuple(primes) for primes in leaving], len(fspa.atoms), device, 0.0)

    def start(self, count: int) -> Tensor:
        """Return zeros, because this mode needs no memory."""
        return torch.zeros(count, dtype=self._dtype, device=self._device)

    def reward(self, step: BatchTransition, memory: Tensor) -> tuple[Tensor, Tensor]:
        """Return the rewards, in [-1, 1], and the unchanged memory."""
        return self._leaving.robustness_of(step.source, step.values) + 0.0, memory


MODE: Final = EdgeReward
