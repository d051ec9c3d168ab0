"""Reward the robustness of the whole trace, at the end of the episode.

See :mod:`tltlc.monitor.reward_modes.sparse`.
"""

from __future__ import annotations

from typing import Final

import torch
from torch import Tensor

from tltl_runtime.spec.batch.guards import PrimeSets
from tltl_runtime.spec.batch.reward_modes import BatchTransition
from tltlc.api import Fspa, RewardOptions


class SparseReward:
    """Rewards the robustness of the whole trace at the end of the episode, and 0 before.

    A run is a path through the automaton with one edge for each sample so far, whether or not the
    guards of these edges are true. The width of a run is the least robustness of its edges. The
    memory has the width of the widest run to each state, shape [states, N]; -2 if no run leads there.
    """

    def __init__(self, fspa: Fspa, _: RewardOptions, device: torch.device, dtype: torch.dtype) -> None:
        self._guards = PrimeSets([edge.guard.primes for edge in fspa.edges], len(fspa.atoms), device, -1.0)
        incoming: list[list[int]] = [[] for _ in fspa.states]
        for number, edge in enumerate(fspa.edges):
            incoming[edge.target].append(number)
        self._incoming = [torch.tensor(row, dtype=torch.int64, device=device) for row in incoming]
        self._sources = torch.tensor([edge.source for edge in fspa.edges], dtype=torch.int64, device=device)
        self._accepting = torch.tensor([state.accepting for state in fspa.states], device=device)
        self._dtype = dtype

    def start(self, count: int) -> Tensor:
        """Return the width of the widest run to each state before the first sample, [states, count].

        It is 1 for the initial state, and -2 for all others.
        """
        widths = torch.full((len(self._incoming), count), -2.0, dtype=self._dtype, device=self._sources.device)
        widths[0] = 1.0
        return widths

    def reward(self, step: BatchTransition, memory: Tensor) -> tuple[Tensor, Tensor]:
        """Return the rewards, [N] in [-1, 1], and the width of the widest run to each state, [states, N]."""
        widths_through_edges = torch.minimum(
            memory.index_select(0, self._sources), self._guards.all_robustness(step.values)
        )
        after = torch.full_like(memory, -2.0)
        for state, edges in enumerate(self._incoming):
            if len(edges):
                after[state] = widths_through_edges.index_select(0, edges).amax(0)
        accepted = self._accepting.index_select(0, step.target)
        opposite_width = after.masked_fill(self._accepting[:, None] == accepted, -1.0).amax(0)
        distance = -opposite_width.clamp_(-1.0, 0.0)
        return torch.where(accepted, distance, -distance).masked_fill_(~step.done, 0.0) + 0.0, after


MODE: Final = SparseReward
