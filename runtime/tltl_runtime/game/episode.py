"""What every game says about a recorded episode."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.level import Level
from tltl_runtime.spec.episode_summary import End
from tltlc.api import Fspa, record


class RecordedEpisode(Protocol):
    """An episode of n decisions.

    Resetting the level with ``seed`` and playing ``actions`` gives the same episode, bit for bit.
    """

    @property
    def level(self) -> Level:
        """The level, as it was then."""

    @property
    def fspa(self) -> Fspa:
        """The automaton of the spec."""

    @property
    def params(self) -> Mapping[str, float]:
        """The values of the spec's params, in SI units."""

    @property
    def player(self) -> str:
        """The player: ``expert``, ``keyboard``, or a policy's name."""

    @property
    def seed(self) -> int:
        """The seed of the reset."""

    @property
    def actions(self) -> NDArray[Any]:
        """The choices of each branch, (n, branches)."""

    @property
    def success(self) -> bool:
        """Whether the episode met the spec."""


@record
class Trajectory:
    """The player's path, the automaton's states, and the end of an episode of n decisions.

    It is small enough to keep hundreds of them in memory.  ``points`` is (n + 1, 2), in metres;
    ``states`` is (n + 1,).
    """

    points: NDArray[np.float32]
    states: NDArray[np.int32]
    end: End
