"""Alternative rewards to compare with Algorithm 1: a module for each mode, imported on first use.

A module defines a pure function ``reward(tables, transition, options, memory) -> (reward,
memory)``. ``memory`` is what the mode remembers from step to step; it is None at the start of an
episode. The function computes the whole reward: the penalties of Algorithm 1 are not subtracted
from it. To add a mode, write its module. To compute the reward faster for many environments, also
write a module of the same name in ``tltl_runtime.spec.batch.reward_modes`` that uses tensors.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from typing import Any

from tltlc.core.record import record
from tltlc.monitor.progress_and_reward import RewardOptions
from tltlc.monitor.tables import MonitorTables


@record
class Transition:
    """One step of the automaton, from ``state`` to ``target``.

    ``values`` are the values of the atoms at the sample of this step, in [-1, 1]. ``done`` says
    whether the episode ends with this step, and ``success`` whether it ends in success.
    """

    state: int
    target: int
    values: Sequence[float]
    done: bool
    success: bool


ModeFunction = Callable[[MonitorTables, Transition, RewardOptions, Any], tuple[float, Any]]


def mode_function(name: str) -> ModeFunction:
    """Return the function ``reward`` of a mode, given the mode's name, such as ``sparse``."""
    function: ModeFunction = importlib.import_module(f"{__name__}.{name}").reward
    return function
