"""Run an automaton on samples: compute the atoms, take a transition, and return progress and reward.

A sample has the values of a game's signals at one step. Begin with `Monitor`.
"""

from __future__ import annotations

from tltlc.monitor.errors import MonitorError
from tltlc.monitor.monitor import Monitor, Step
from tltlc.monitor.progress_and_reward import RewardOptions

__all__ = ["Monitor", "MonitorError", "RewardOptions", "Step"]
