"""Reward success, and add a shaping reward with progress as its potential.

Shaping of this form does not change which policies are optimal (Ng, Harada, Russell, Policy
invariance under reward transformations, ICML 1999).
"""

from __future__ import annotations

from tltlc.monitor.progress_and_reward import RewardOptions, approach
from tltlc.monitor.reward_modes import Transition
from tltlc.monitor.tables import MonitorTables


def reward(
    tables: MonitorTables, transition: Transition, options: RewardOptions, memory: float | None
) -> tuple[float, float]:
    """Return 1 on success (0 otherwise), plus ``gamma * potential after - potential before``.

    The second result is the potential after this step; the caller passes it as ``memory`` at the
    next step. The base progress of a state says how near the state is to a goal: 1 in a goal, 0 in
    a trap or at the greatest distance. The potential is:

    - before the first sample, the base progress of the initial state;
    - after a sample, the base progress of the state, plus how near the automaton is to an edge
      towards a goal (line 14 of Algorithm 1, but also if the state changed);
    - after the end of the episode, 0.
    """
    before = tables.base_progress[0] if memory is None else memory
    after = 0.0 if transition.done else _potential(tables, transition)
    return float(transition.success) + options.gamma * after - before, after


def _potential(tables: MonitorTables, transition: Transition) -> float:
    state = transition.target
    base = tables.base_progress[state]
    return base + approach(tables, state, transition.values) if tables.improving[state] else base
