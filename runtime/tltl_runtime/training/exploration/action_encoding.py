"""Actions as a training stores them: rows of numbers, whatever the action space."""

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
"""An action: the choices, which count from 0, and then the numbers before they are squashed to their bounds."""
Actions = Sequence[Row]

_MOST_CHOICES: Final = 1 << 7
"""Up to this many choices can be stored in int8."""


class ActionEncoding:
    """Converts the rows of an action space to its values.

    A training stores what its policy gave, before squashing: imitating an action needs it, and a
    number at its bound could not be turned back. ``layout`` describes the rows, ``dtype`` is the
    type in which files and messages to workers store them.

    Raises:
        TltlError: TLT0844, no policy can choose in the space.
    """

    def __init__(self, space: spaces.Space[Any]) -> None:
        self.layout = action_layout(space)
        self._is_plain = is_plain_action(space)
        choices: Any = np.int8 if max(self.layout.sizes, default=0) <= _MOST_CHOICES else np.int32
        self.dtype: np.dtype[Any] = np.dtype(np.float64 if self.layout.number_count else choices)

    def rows(self, outputs: NDArray[Any]) -> NDArray[Any]:
        """Return the outputs of a policy [n, width] as rows, in int64 if there are only choices.

        Raises:
            ValueError: an output is not finite.
        """
        if not np.isfinite(outputs).all():
            raise ValueError("an action is not a finite number")
        return outputs.astype(np.float64 if self.layout.number_count else np.int64)

    def values(self, rows: NDArray[Any]) -> Any:
        """Return the actions of rows [n, width] as a batch of the space."""
        return rows if self._is_plain else action_value(self.layout, squashed(self.layout, rows), len(rows))

    def flat(self, rows: Sequence[Row]) -> NDArray[Any]:
        """Return the flat actions [n, width] of rows, squashed, for :meth:`value`; [0] if there are none."""
        array = np.array(rows, self.dtype)
        return squashed(self.layout, array) if array.size and self.layout.number_count else array

    def value(self, flat: NDArray[Any]) -> Any:
        """Return the action of a flat action [width]."""
        return flat if self._is_plain else action_value(self.layout, flat)

    def check(self, stored: NDArray[Any], count: int) -> None:
        """Raise ValueError unless an array has ``count`` rows of this space."""
        shape = (count, self.layout.width) if count else (0,)
        if stored.dtype != self.dtype or stored.shape != shape:
            raise ValueError(f"must be {self.dtype} of the shape {list(shape)}, not {stored.dtype} of {stored.shape}")
        rows, sizes = stored.reshape(-1, self.layout.width), np.array(self.layout.sizes, np.int64)
        choices = rows[:, : len(sizes)]
        if (choices < 0).any() or (choices >= sizes).any() or (choices % 1).any() or not np.isfinite(rows).all():
            raise ValueError("contains a value that is not an action")
