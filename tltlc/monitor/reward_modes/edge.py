"""Reward the robustness of leaving the state, at every step (Li, Serlin, Yang, Belta, Science Robotics 2019)."""

from __future__ import annotations

from tltlc.monitor.guards import robustness
from tltlc.monitor.progress_and_reward import RewardOptions
from tltlc.monitor.reward_modes import Transition
from tltlc.monitor.tables import MonitorTables


def reward(tables: MonitorTables, transition: Transition, _: RewardOptions, memory: None) -> tuple[float, None]:
    """Return the robustness of the disjunction of the edges that leave the state, in [-1, 1]; 0 without such edges.

    ▲ Edges into a trap are left out: with them, the disjunction would reward a violation.
    """
    states = tables.fspa.states
    leaving = [
        robustness(edge.guard, transition.values)
        for edge in tables.edges[transition.state]
        if edge.target != transition.state and states[edge.target].distance is not None
    ]
    return max(leaving, default=0.0) + 0.0, memory
