"""Alternative rewards for N environments: one module per mode, loaded on first use.

A module has the name of its mode, and its ``MODE`` is a class, a :class:`RewardMode`.
The module of that name in :mod:`tltlc.monitor.reward_modes` gives equal rewards, for one automaton.
If a mode has no module here, :class:`RowByRow` calls the function there for each environment.
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
    """A way to reward N environments.

    The memory of a mode is what the mode keeps from step to step: a tensor whose last dimension has
    size N.
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
    """Return the reward mode with the name ``options.mode``.

    The mode ``progress`` has no module:
    :class:`~tltl_runtime.spec.batch.progress_and_reward.Outcomes` computes its rewards.
    """
    if importlib.util.find_spec(f"{__name__}.{options.mode}") is None:
        return RowByRow(fspa, options, device, dtype)
    mode: RewardMode = importlib.import_module(f"{__name__}.{options.mode}").MODE(fspa, options, device, dtype)
    return mode


class RowByRow:
    """A reward mode that calls the mode's function for one automaton, once for each environment.

    The function is in :mod:`tltlc.monitor.reward_modes` and runs on the CPU, so each step waits for
    the torch device. The memory, int64 [N], has an index for each environment into a list of the
    values that the function remembers. After the end of an episode the index is -1, and the
    function is not called. Each step makes a new list, so only the memory of the last step is
    valid.
    """

    def __init__(self, fspa: Fspa, options: RewardOptions, device: torch.device, dtype: torch.dtype) -> None:
        self._tables, self._options, self._device, self._dtype = monitors.tables(fspa), options, device, dtype
        self._function = monitors.mode_function(options.mode)
        self._remembered: list[Any] = [None]

    def start(self, count: int) -> Tensor:
        """Return 0 for each environment: the index of None, as nothing is remembered yet."""
        return torch.zeros(count, dtype=torch.int64, device=self._device)

    def reward(self, step: BatchTransition, memory: Tensor) -> tuple[Tensor, Tensor]:
        """Return the reward and the indices of what the function remembers after the step."""
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
