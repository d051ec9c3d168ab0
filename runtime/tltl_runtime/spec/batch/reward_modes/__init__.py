"""Alternative rewards for N environments: one module per mode, loaded on first use.

A module has the name of its mode. Its constant ``MODE`` is a class that implements
:class:`RewardMode`. The module of the same name in :mod:`tltlc.monitor.reward_modes` computes the same
rewards for one automaton. If a mode has a module only there, :class:`RowByRow` calls the function of
that module for each environment.
"""

from __future__ import annotations

import importlib
import importlib.util
from typing import Any, Final, NamedTuple, Protocol

import torch
from torch import Tensor

from tltlc.api import Fspa, RewardOptions, monitors

_ENDED: Final = -1
"""The memory of :class:`RowByRow` for an environment whose episode has ended."""


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
    """The interface of a reward mode for N environments.

    A mode may need values from earlier steps. They are its memory, a tensor whose last dimension has
    size N. The caller keeps the memory and passes it to the next step.
    """

    def __init__(self, fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> None: ...

    def start(self, count: int) -> Tensor:
        """Return the memory of ``count`` environments before their first sample."""
        ...

    def reward(self, step: BatchTransition, memory: Tensor) -> tuple[Tensor, Tensor]:
        """Return the rewards of a step, shape [N], and the memory after the step.

        ``memory`` is the memory before the step. The caller may modify the rewards in place.
        """
        ...


def reward_mode(fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> RewardMode:
    """Return an object that computes rewards in the mode ``options.mode``.

    The mode must not be ``progress``:
    :class:`~tltl_runtime.spec.batch.progress_and_reward.Outcomes` computes the rewards of that mode.
    """
    if importlib.util.find_spec(f"{__name__}.{options.mode}") is None:
        return RowByRow(fspa, options, device, dtype)
    mode: RewardMode = importlib.import_module(f"{__name__}.{options.mode}").MODE(fspa, options, device, dtype)
    return mode


class RowByRow:
    """A reward mode for N environments that calls a function for one automaton in each environment.

    The function is in :mod:`tltlc.monitor.reward_modes` and runs on the CPU, so each step waits for
    the torch device. The function may remember any Python value from step to step. This object keeps
    these values in a list. The memory, int64 [N], has an index into this list for each environment.
    After the end of an episode, the index is -1, and the function is not called. Each step makes a new
    list, so only the memory of the last step is valid.
    """

    def __init__(self, fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> None:
        self._tables, self._options, self._device, self._dtype = monitors.tables(fspa), options, device, dtype
        self._function = monitors.mode_function(options.mode)
        self._remembered: list[Any] = [None]

    def start(self, count: int) -> Tensor:
        """Return the memory before the first sample: 0 for each environment, the index of the value None."""
        return torch.zeros(count, dtype=torch.int64, device=self._device)

    def reward(self, step: BatchTransition, memory: Tensor) -> tuple[Tensor, Tensor]:
        """Return the rewards, [N], and the indices of the values that the function remembers after the step.

        The reward is 0 in an environment whose episode has ended before this step.
        """
        columns = step.source, step.target, step.values.T, step.done, step.success, memory
        rewards: list[float] = []
        indices: list[int] = []
        remembered: list[Any] = [None]
        for source, target, values, done, success, index in zip(*(column.tolist() for column in columns), strict=True):
            if index == _ENDED:
                rewards.append(0.0)
                indices.append(_ENDED)
                continue
            transition = monitors.Transition(source, target, values, done, success)
            reward, after = self._function(self._tables, transition, self._options, self._remembered[index])
            rewards.append(reward)
            indices.append(_ENDED if done else len(remembered))
            remembered.append(after)
        self._remembered = remembered
        return (
            torch.tensor(rewards, dtype=self._dtype, device=self._device),
            torch.tensor(indices, dtype=torch.int64, device=self._device),
        )
