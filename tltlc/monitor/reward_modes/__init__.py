"""Rewards to compare Algorithm 1 with: one module per mode, loaded when asked for.

A module has ``reward(tables, transition, options, memory) -> (reward, memory)``, a pure function.
``memory`` is what the mode carries from step to step, None at the start of an episode.  None of these
modes has step or terminal penalties.  Adding a mode means adding its file and its name to
:data:`tltlc.monitor.reward.Mode`.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from typing import Any

from tltlc.core.record import record
from tltlc.monitor.reward import RewardOptions
from tltlc.monitor.tables import Tables


@record
class Transition:
    """One step of the automaton, at the ``values`` of the atoms, and whether the episode ends with it, and how."""

    state: int
    target: int
    values: Sequence[float]
    done: bool
    success: bool


ModeFunction = Callable[[Tables, Transition, RewardOptions, Any], tuple[float, Any]]


def mode_function(name: str) -> ModeFunction:
    """The function of a mode, by name."""
    function: ModeFunction = importlib.import_module(f"{__name__}.{name}").reward
    return function
