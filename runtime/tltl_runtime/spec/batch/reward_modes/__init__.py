"""Alternative rewards for N environments: one module per mode, loaded on first use.

A module has the name of its mode and defines a class ``Reward``, which is a :class:`RewardMode`.
The module of that name in :mod:`tltlc.monitor.reward_modes` gives equal rewards, for one automaton.
"""

from __future__ import annotations

import importlib
from typing import NamedTuple, Protocol

import torch
from torch import Tensor

from tltlc.api import Fspa, RewardOptions


class BatchTransition(NamedTuple):
    """One step of N automata.

    - ``source`` and ``target``: the states before and after the step, int64 [N].
    - ``values``: the values of the atoms, [atoms, N], in [-1, 1].
    - ``done`` and ``success``: whether the step ends the episode, and whether in success, bool [N].
    """

    source: Tensor
    target: Tensor
    values: Tensor
    done: Tensor
    success: Tensor


class RewardMode(Protocol):
    """A reward of N environments.

    The memory of a mode is what it keeps from step to step: a tensor whose last dimension has size
    N.
    """

    def __init__(self, fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> None: ...

    def start(self, count: int) -> Tensor:
        """Return the memory of ``count`` environments before the first sample."""
        ...

    def reward(self, step: BatchTransition, memory: Tensor) -> tuple[Tensor, Tensor]:
        """Return the reward, shape [N], and the memory after the step.

        The caller may modify the reward.
        """
        ...


def reward_mode(fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> RewardMode:
    """Return the mode that the options name.

    Mode ``progress`` has no module: :class:`~tltl_runtime.spec.batch.progress_and_reward.Outcomes`
    computes it.
    """
    mode: RewardMode = importlib.import_module(f"{__name__}.{options.mode}").Reward(fspa, options, device, dtype)
    return mode
