"""Actions as a training stores them: rows of numbers, for every kind of action space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from tltl_runtime.policies.spaces.action_layout import action_layout
from tltl_runtime.policies.spaces.layouts import is_plain_action
from tltl_runtime.policies.spaces.values import action_value, squashed

Row = Sequence[float]
"""An action as a policy outputs it: first its discrete choices, which count from 0, then its continuous numbers.

The numbers are not squashed to their bounds yet.
"""
Actions = Sequence[Row]

_MOST_CHOICES: Final = 1 << 7
"""Up to this many choices can be stored in int8."""


class ActionEncoding:
    """Converts the actions of a space between three forms: rows, flat actions and values.

    - A *row* [width] is what a policy outputs: first the discrete choices, which count from 0, then
      the continuous numbers, before they are squashed to their bounds.
    - A *flat action* [width] is a row whose numbers are squashed.
    - A *value* is an element of the Gymnasium space.

    A training stores rows, because imitation needs the numbers before squashing, and squashing
    cannot be undone for a number at its bound. ``layout`` describes the space, ``dtype`` is the
    type in which files and messages to workers store actions.

    Raises:
        TltlError: TLT0844, policies do not support the space.
    """

    def __init__(self, space: spaces.Space[Any]) -> None:
        self.layout = action_layout(space)
        self._is_plain = is_plain_action(space)
        choices: Any = np.int8 if max(self.layout.sizes, default=0) <= _MOST_CHOICES else np.int32
        self.dtype: np.dtype[Any] = np.dtype(np.float64 if self.layout.number_count else choices)

    def rows(self, outputs: NDArray[Any]) -> NDArray[Any]:
        """Return a policy's outputs [n, width] as rows, in int64 if all are choices, else float64.

        Raises:
            ValueError: an output is not finite.
        """
        if not np.isfinite(outputs).all():
            raise ValueError("an action is not a finite number")
        return outputs.astype(np.float64 if self.layout.number_count else np.int64)

    def values(self, rows: NDArray[Any]) -> Any:
        """Convert rows [n, width] to a batch of n values of the space."""
        return rows if self._is_plain else action_value(self.layout, squashed(self.layout, rows), len(rows))

    def flat(self, rows: Sequence[Row]) -> NDArray[Any]:
        """Convert rows to flat actions [n, width], for :meth:`value`; without rows, the shape is [0]."""
        array = np.array(rows, self.dtype)
        return squashed(self.layout, array) if array.size and self.layout.number_count else array

    def value(self, flat: NDArray[Any]) -> Any:
        """Convert a flat action [width] to a value of the space."""
        return flat if self._is_plain else action_value(self.layout, flat)

    def check(self, stored: NDArray[Any], count: int) -> None:
        """Raise ValueError unless ``stored`` is an array of ``count`` valid rows.

        It must have the type ``dtype`` and the shape [count, width], or [0] if ``count`` is 0.
        """
        shape = (count, self.layout.width) if count else (0,)
        if stored.dtype != self.dtype or stored.shape != shape:
            raise ValueError(f"must be {self.dtype} of the shape {list(shape)}, not {stored.dtype} of {stored.shape}")
        rows, sizes = stored.reshape(-1, self.layout.width), np.array(self.layout.sizes, np.int64)
        choices = rows[:, : len(sizes)]
        if (choices < 0).any() or (choices >= sizes).any() or (choices % 1).any() or not np.isfinite(rows).all():
            raise ValueError("contains a value that is not an action")
