"""Reward success, with progress as the potential of a shaping reward.

Shaping does not change the optimal policies: they are optimal for the reward of success alone (Ng,
Harada, Russell, Policy invariance under reward transformations, ICML 1999).
"""

from __future__ import annotations

from tltlc.monitor.progress_and_reward import RewardOptions, approach
from tltlc.monitor.reward_modes import Transition
from tltlc.monitor.tables import MonitorTables


def reward(
    tables: MonitorTables, transition: Transition, options: RewardOptions, memory: float | None
) -> tuple[float, float]:
    """Return ``1`` on success, plus ``gamma * potential after - potential before``.

    The potential of a state at a sample is its base progress plus what line 14 of Algorithm 1 adds,
    whether or not the state changed. After the end of the episode the potential is 0; before the
    first sample it is the base progress of the initial state.
    """
    before = tables.base_progress[0] if memory is None else memory
    after = 0.0 if transition.done else _potential(tables, transition)
    return float(transition.success) + options.gamma * after - before, after


def _potential(tables: MonitorTables, transition: Transition) -> float:
    state = transition.target
    base = tables.base_progress[state]
    return base + approach(tables, state, transition.values) if tables.improving[state] else base
