"""Compute the paper's Algorithm 1 for N environments (``docs/semantics.md``, "Reward").

The order of operations is the same as in :mod:`tltlc.monitor.progress_and_reward`, which lists the
deviations from the paper. Values that depend only on the states before and after a step are in
lookup tables, by the index of the edge.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import torch
from torch import Tensor

from tltl_runtime.spec.batch.guards import PrimeSets
from tltlc.api import Fspa, RewardOptions, monitors

VERDICTS: Final = ("satisfied", "holding", "pending", "violated")
"""The verdicts, in the order of their indices."""


class Outcomes:
    """Computes progress, rewards and whether episodes end, by Algorithm 1, for N environments.

    All arguments and results of the methods are tensors of shape [N], except ``values``, the values
    of the atoms, [atoms, N]. ``edge`` has the indices of the edges that are taken, and ``steps`` the
    numbers of the steps in their episodes, from 1.
    """

    def __init__(self, fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> None:
        self._options, self._limit = options, fspa.limit_steps
        scalar = monitors.tables(fspa)
        states, edges = fspa.states, fspa.edges
        self._by_share = fspa.judge == "limit" and options.termination == "entry"

        def numbers(values: Sequence[float]) -> Tensor:
            return torch.tensor(values, dtype=dtype, device=device)

        self._accepting = torch.tensor([states[e.target].accepting for e in edges], device=device)
        self._ends = torch.tensor(
            [monitors.ends_episode(scalar, e.source, e.target, options) for e in edges], device=device
        )
        verdicts = [states[e.target].verdict for e in edges]
        self._violated = numbers([float(verdict == "violated") for verdict in verdicts])
        self._base = numbers([scalar.base_progress[e.target] for e in edges])
        # The progress of a spec that is judged at its limit: 1 if satisfied, the share of the limit
        # that has passed if undecided, else 0.
        self._settled = numbers([float(verdict == "satisfied") for verdict in verdicts])
        self._open = numbers([float(verdict in ("holding", "pending")) for verdict in verdicts])
        staying = [scalar.improving[e.source] if e.source == e.target else () for e in edges]
        primes = [tuple(prime for edge in chosen for prime in edge.guard.primes) for chosen in staying]
        self.nearest = PrimeSets(primes, len(fspa.atoms), device, -1.0)
        """For each self-loop, the primes of the edges from its state towards acceptance.

        There is a set for each edge; for edges that are not self-loops, it is empty.
        """
        self._approaches = any(primes) and not self._by_share
        self._size = numbers([float(fspa.spec_size or 1)])
        self._limit_number = numbers([float(self._limit or 1)])

    def progress(self, edge: Tensor, values: Tensor, steps: Tensor) -> Tensor:
        """Return the progress of this step alone, in [0, 1]: lines 11 to 18 of Algorithm 1."""
        if self._by_share:
            settled = self._settled.index_select(0, edge)
            if self._limit is None:
                return settled
            share = torch.clamp(steps, max=float(self._limit)).div_(self._limit_number)
            return share.mul_(self._open.index_select(0, edge)).add_(settled)
        base = self._base.index_select(0, edge)
        if not self._approaches:
            return base
        # Without improving edges, the nearest robustness is -1, which adds 0.
        return base.add_(approach(self.nearest.robustness_of(edge, values), self._size))

    def done(self, edge: Tensor, steps: Tensor) -> Tensor:
        """Return whether the episode ends with this step, by the spec or at its limit, bool [N]."""
        ends = self._ends.index_select(0, edge)
        return ends if self._limit is None else ends.logical_or_(steps >= self._limit)

    def accepting(self, edge: Tensor) -> Tensor:
        """Return whether the edge leads to an accepting state, bool [N]."""
        return self._accepting.index_select(0, edge)

    def reward(self, edge: Tensor, rise: Tensor, steps: Tensor) -> Tensor:
        """Return the reward of a step.

        It is the ``rise`` of the best progress in this step, minus 1 / T, where T is the spec's limit
        in steps. On a violation that ends the episode, the terminal penalty is subtracted, too. If
        the spec has no limit, the reward is the rise alone.
        """
        if self._limit is None:
            return rise
        reward = rise - 1 / self._limit
        if self._options.termination == "entry":
            violated = self._violated.index_select(0, edge)
        else:
            violated = self._violated.index_select(0, edge) * self.done(edge, steps)
        return reward.sub_(self._penalty(steps).mul_(violated))

    def _penalty(self, steps: Tensor) -> Tensor:
        """Return the terminal penalty: the sum of the penalties of all steps that remain to the limit.

        Without it, a violation would save these penalties. The sum is ``(T - t) / T``, where T is
        the spec's limit and t the number of ``steps`` so far. If the options ask for it, the sum is
        discounted by ``gamma``.
        """
        assert self._limit is not None
        remaining = self._limit - steps
        gamma = self._options.gamma
        if self._options.terminal_penalty == "undiscounted" or gamma == 1.0:
            return remaining.div_(self._limit_number)
        return torch.pow(gamma, remaining).neg_().add_(1.0).div_((1 - gamma) * self._limit_number)


def approach(nearest: Tensor, size: Tensor) -> Tensor:
    """Return what line 14 of Algorithm 1 adds to the progress: ``(1 + min(0, nearest)) / size``.

    ``nearest`` is the robustness of the most robust edge towards acceptance; the tensor is modified
    in place. ``size`` is the automaton's ``spec_size``.
    """
    return nearest.clamp_(max=0.0).add_(1.0).div_(size)
