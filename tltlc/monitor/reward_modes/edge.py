"""Reward, at every step, how near the automaton is to leaving its state (Li, Serlin, Yang, Belta, Sci. Robot. 2019)."""

from __future__ import annotations

from tltlc.monitor.guards import robustness
from tltlc.monitor.progress_and_reward import RewardOptions
from tltlc.monitor.reward_modes import Transition
from tltlc.monitor.tables import MonitorTables


def reward(tables: MonitorTables, transition: Transition, _: RewardOptions, memory: None) -> tuple[float, None]:
    """Return the robustness of the most robust edge to another state, in [-1, 1]; 0 if there is no such edge.

    ``memory`` is not used, and is returned unchanged.

    ▲ Unlike in the paper, edges into a trap are left out, because they would reward a violation.
    """
    states = tables.fspa.states
    leaving = [
        robustness(edge.guard, transition.values)
        for edge in tables.edges[transition.state]
        if edge.target != transition.state and states[edge.target].distance is not None
    ]
    return max(leaving, default=0.0) + 0.0, memory
