"""Algorithm 1 and the other reward modes for N environments (semantics, section 4).

The order of operations is the same as in :mod:`tltlc.monitor.reward` and
:mod:`tltlc.monitor.reward_modes`, which list the deviations from the paper. Lookup tables by edge
store what depends only on states.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import torch
from torch import Tensor

from tltl_runtime.spec.batch.guards import PrimeSets
from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.monitor.reward import RewardOptions
from tltlc.monitor.tables import Tables, tables

VERDICTS: Final = ("satisfied", "holding", "pending", "violated")
"""The verdicts, in the order of their indices."""


class Outcomes:
    """Progress, ends and rewards of Algorithm 1; all argument and result tensors have shape [N]."""

    def __init__(self, fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> None:
        self._options, self._limit = options, fspa.limit_steps
        scalar = tables(fspa)
        states, edges = fspa.states, fspa.edges
        self._by_share = fspa.judge == "limit" and options.termination == "entry"

        def numbers(values: Sequence[float]) -> Tensor:
            return torch.tensor(values, dtype=dtype, device=device)

        self._accepting = torch.tensor([states[e.target].accepting for e in edges], device=device)
        self._ends = torch.tensor([_ends(scalar, e.source, e.target, options) for e in edges], device=device)
        verdicts = [states[e.target].verdict for e in edges]
        self._violated = numbers([float(verdict == "violated") for verdict in verdicts])
        self._base = numbers([scalar.base_progress[e.target] for e in edges])
        # The progress of a spec judged at its limit: 1 if satisfied, the share of T if undecided, else 0.
        self._settled = numbers([float(verdict == "satisfied") for verdict in verdicts])
        self._open = numbers([float(verdict in ("holding", "pending")) for verdict in verdicts])
        staying = [scalar.improving[e.source] if e.source == e.target else () for e in edges]
        primes = [tuple(prime for edge in chosen for prime in edge.guard.primes) for chosen in staying]
        self.nearest = PrimeSets(primes, len(fspa.atoms), device, -1.0)
        """Per edge on which the automaton stays, the primes of the edges that would have improved."""
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
        return base.add_(approach(self.nearest.of(edge, values), self._size))

    def done(self, edge: Tensor, steps: Tensor) -> Tensor:
        """Return whether an episode ends with this step."""
        ends = self._ends.index_select(0, edge)
        return ends if self._limit is None else ends.logical_or_(steps >= self._limit)

    def accepting(self, edge: Tensor) -> Tensor:
        """Return whether the target of the edge is accepting."""
        return self._accepting.index_select(0, edge)

    def reward(self, edge: Tensor, rise: Tensor, steps: Tensor) -> Tensor:
        """Return the rise of progress less the step penalty and, on a violation, the terminal penalty."""
        if self._limit is None:
            return rise
        reward = rise - 1 / self._limit
        if self._options.termination == "entry":
            violated = self._violated.index_select(0, edge)
        else:
            violated = self._violated.index_select(0, edge) * self.done(edge, steps)
        return reward.sub_(self._penalty(steps).mul_(violated))

    def _penalty(self, steps: Tensor) -> Tensor:
        """Return the step penalties that a violation saves: ``(T - t) / T``, or their discounted sum."""
        assert self._limit is not None
        remaining = self._limit - steps
        gamma = self._options.gamma
        if self._options.terminal_penalty == "undiscounted" or gamma == 1.0:
            return remaining.div_(self._limit_number)
        return torch.pow(gamma, remaining).neg_().add_(1.0).div_((1 - gamma) * self._limit_number)


class EdgeMode:
    """The robustness of leaving the state, except into a trap; 0 if no edge leaves it."""

    def __init__(self, fspa: Fspa, device: torch.device) -> None:
        leaving: list[list[Implicant]] = [[] for _ in fspa.states]
        for edge in fspa.edges:
            if edge.target != edge.source and fspa.states[edge.target].distance is not None:
                leaving[edge.source] += edge.guard.primes
        self._leaving = PrimeSets([tuple(primes) for primes in leaving], len(fspa.atoms), device, 0.0)

    def reward(self, source: Tensor, values: Tensor) -> Tensor:
        """Return the reward, in [-1, 1]; ``source`` are the states before the step."""
        return self._leaving.of(source, values) + 0.0


class PotentialMode:
    """Success, shaped with progress as the potential."""

    def __init__(self, fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> None:
        scalar = tables(fspa)
        primes = [tuple(prime for edge in improving for prime in edge.guard.primes) for improving in scalar.improving]
        self._improving = PrimeSets(primes, len(fspa.atoms), device, -1.0)
        self._base = torch.tensor(scalar.base_progress, dtype=dtype, device=device)
        self._size = torch.tensor([float(fspa.spec_size or 1)], dtype=dtype, device=device)
        self._gamma = options.gamma

    def start(self, count: int) -> Tensor:
        """Return the potential before the first sample."""
        return self._base[:1].repeat(count)

    def reward(
        self, before: Tensor, target: Tensor, values: Tensor, done: Tensor, success: Tensor
    ) -> tuple[Tensor, Tensor]:
        """Return the reward and the potential after the step."""
        potential = self._base.index_select(0, target) + approach(self._improving.of(target, values), self._size)
        after = potential.masked_fill_(done, 0.0)
        return (success + self._gamma * after).sub_(before), after


class SparseMode:
    """The robustness of the whole trace, once, at the end of the episode."""

    def __init__(self, fspa: Fspa, device: torch.device, dtype: torch.dtype) -> None:
        self._guards = PrimeSets([edge.guard.primes for edge in fspa.edges], len(fspa.atoms), device, -1.0)
        incoming: list[list[int]] = [[] for _ in fspa.states]
        for number, edge in enumerate(fspa.edges):
            incoming[edge.target].append(number)
        self._incoming = [torch.tensor(row, dtype=torch.int64, device=device) for row in incoming]
        self._sources = torch.tensor([edge.source for edge in fspa.edges], dtype=torch.int64, device=device)
        self._accepting = torch.tensor([state.accepting for state in fspa.states], device=device)
        self._dtype = dtype

    def start(self, count: int) -> Tensor:
        """Return the initial width of the run to each state, [states, N].

        The width is the maximum over runs of the least edge robustness; -2 stands for no run.
        """
        widths = torch.full((len(self._incoming), count), -2.0, dtype=self._dtype, device=self._sources.device)
        widths[0] = 1.0
        return widths

    def reward(self, widths: Tensor, target: Tensor, values: Tensor, done: Tensor) -> tuple[Tensor, Tensor]:
        """Return the reward, in [-1, 1], and the widths after the step."""
        widths_through_edges = torch.minimum(widths.index_select(0, self._sources), self._guards.all(values))
        after = torch.full_like(widths, -2.0)
        for state, edges in enumerate(self._incoming):
            if len(edges):
                after[state] = widths_through_edges.index_select(0, edges).amax(0)
        accepted = self._accepting.index_select(0, target)
        opposite_width = after.masked_fill(self._accepting[:, None] == accepted, -1.0).amax(0)
        distance = -opposite_width.clamp_(-1.0, 0.0)
        return torch.where(accepted, distance, -distance).masked_fill_(~done, 0.0) + 0.0, after


def approach(nearest: Tensor, size: Tensor) -> Tensor:
    """Return what line 14 adds, ``(1 + min(0, nearest)) / S``; modifies ``nearest`` in place."""
    return nearest.clamp_(max=0.0).add_(1.0).div_(size)


def _ends(scalar: Tables, source: int, target: int, options: RewardOptions) -> bool:
    """Whether an edge ends an episode, apart from the limit."""
    reached = scalar.fspa.states[target]
    if options.termination == "paper":
        return source == target and not scalar.improving[target]
    settled = reached.verdict in ("satisfied", "violated")
    return settled or (scalar.fspa.judge == "goal" and reached.accepting)
