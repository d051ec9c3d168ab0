"""Run an automaton on samples: compute atoms, take the transition, and return progress and reward.

A sample is the signals of a game at one step. Begin with `Monitor`.
"""

from __future__ import annotations

from tltlc.monitor.monitor import Monitor, Step
from tltlc.monitor.progress_and_reward import RewardOptions
from tltlc.monitor.samples import MonitorError

__all__ = ["Monitor", "MonitorError", "RewardOptions", "Step"]
