"""Memory that processes share: one row for each environment.

A row stores an observation, an action, the results of a step and the episode being played. The rows
are a structured NumPy array over one anonymous block, which the system frees when the processes
end, however they end.
"""

from __future__ import annotations

from collections.abc import Mapping
from multiprocessing.context import BaseContext
from typing import Any

import numpy as np
from gymnasium import Space, spaces
from numpy.typing import DTypeLike, NDArray

SharedColumns = Any
"""The values of all rows for a space, called the columns of the space.

This is an array with one row for each environment. For a Dict or Tuple space, it is a dict or tuple
with the columns of the space's parts.
"""


class Rows:
    """A table in shared memory with ``count`` rows, one for each environment.

    ``spaces`` are the observation space and the action space that all environments share, under the
    keys ``observation_space`` and ``action_space``. An instance can be passed to another process only
    as an argument when that process is started.

    - ``observation`` and ``action`` are the columns of the two spaces.
    - ``reward``, ``terminated`` and ``truncated`` are the results of a step.
    - ``episode`` counts the episodes since the last reset with a seed, from 1.
    - ``step`` counts the steps of the episode, including a step in progress; ``total`` is the sum of
      the episode's rewards.
    - ``busy`` says whether the environment is in a reset or a step.
    - ``made`` says whether the worker has made the environment.
    - ``info`` are further columns, by name.
    - ``table`` is the structured array with all columns of all rows.

    Raises:
        ValueError: a space has no fixed size.
    """

    def __init__(
        self,
        context: BaseContext,
        count: int,
        observation: Space[Any],
        action: Space[Any],
        info: Mapping[str, DTypeLike],
    ) -> None:
        self.count = count
        self.spaces = {"observation_space": observation, "action_space": action}
        self._dtype = np.dtype(
            [
                ("observation", _dtype(observation)),
                ("action", _dtype(action)),
                ("reward", np.float64),
                ("terminated", np.bool_),
                ("truncated", np.bool_),
                ("episode", np.int64),
                ("step", np.int64),
                ("total", np.float64),
                ("busy", np.bool_),
                ("made", np.bool_),
                ("info", np.dtype(list(info.items()), align=True)),
            ],
            align=True,
        )
        self._block = context.RawArray("b", count * self._dtype.itemsize)
        self._view()

    def __getstate__(self) -> tuple[Any, ...]:
        return self.count, self.spaces, self._dtype, self._block

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        self.count, self.spaces, self._dtype, self._block = state
        self._view()

    def _view(self) -> None:
        rows: NDArray[Any] = np.frombuffer(self._block, dtype=self._dtype)
        self.table = rows
        self.observation = _columns(self.spaces["observation_space"], rows["observation"])
        self.action = _columns(self.spaces["action_space"], rows["action"])
        self.reward, self.terminated, self.truncated = rows["reward"], rows["terminated"], rows["truncated"]
        self.episode, self.step, self.total, self.busy = rows["episode"], rows["step"], rows["total"], rows["busy"]
        self.made = rows["made"]
        self.info: dict[str, NDArray[Any]] = {name: rows["info"][name] for name in rows.dtype["info"].names or ()}


def write(columns: SharedColumns, row: int, value: Any) -> None:
    """Write ``value``, which is in a space, into one row of the space's columns."""
    if isinstance(columns, dict):
        for key, column in columns.items():
            write(column, row, value[key])
    elif isinstance(columns, tuple):
        for column, part in zip(columns, value, strict=True):
            write(column, row, part)
    else:
        columns[row] = value


def write_batch(columns: SharedColumns, batch: Any) -> None:
    """Write a batch of values of a space into the space's columns: one value into each row.

    :func:`tltl_runtime.vector.actions.check_batch` must have checked ``batch``.
    """
    if isinstance(columns, dict):
        for key, column in columns.items():
            write_batch(column, batch[key])
    elif isinstance(columns, tuple):
        for column, part in zip(columns, batch, strict=True):
            write_batch(column, part)
    else:
        columns[...] = batch


def read(columns: SharedColumns, rows: int | slice) -> Any:
    """Return a copy of the value in one row, or of the values in a slice of rows as a batch."""
    if isinstance(columns, dict):
        return {key: read(column, rows) for key, column in columns.items()}
    if isinstance(columns, tuple):
        return tuple(read(column, rows) for column in columns)
    return columns[rows].copy()


def _columns(space: Space[Any], rows: NDArray[Any]) -> SharedColumns:
    if isinstance(space, spaces.Dict):
        return {key: _columns(part, rows[key]) for key, part in space.items()}
    if isinstance(space, spaces.Tuple):
        return tuple(_columns(part, rows[str(index)]) for index, part in enumerate(space))
    return rows


def _dtype(space: Space[Any]) -> np.dtype[Any]:
    if isinstance(space, spaces.Dict):
        return np.dtype([(key, _dtype(part)) for key, part in space.items()], align=True)
    if isinstance(space, spaces.Tuple):
        return np.dtype([(str(index), _dtype(part)) for index, part in enumerate(space)], align=True)
    if not isinstance(space, (spaces.Box, spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary)):
        raise ValueError(f"{space} has no fixed size: workers share Box, Discrete, MultiDiscrete and MultiBinary")
    return np.dtype((space.dtype, space.shape))
