"""What every game says about a recorded episode."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.geometry import Point
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
    def times(self) -> NDArray[np.float64]:
        """The seconds since the reset, (n + 1,)."""

    @property
    def positions(self) -> NDArray[np.float64]:
        """The positions of the player, (n + 1, 3), in metres."""

    @property
    def signals(self) -> NDArray[np.float64]:
        """The signals of the spec, (n + 1, signals), in its order and in SI units."""

    @property
    def atoms(self) -> NDArray[np.float64]:
        """The robustness of the atoms, (n, atoms), in the spec's order."""

    @property
    def states(self) -> NDArray[np.int32]:
        """The states of the automaton, (n + 1,), from 0."""

    @property
    def progress(self) -> NDArray[np.float64]:
        """The best progress so far, (n + 1,), in [0, 1]."""

    @property
    def success(self) -> bool:
        """Whether the episode met the spec."""

    @property
    def end(self) -> End:
        """How the episode ended."""


Kind = Literal["success", "killed", "violated", "limit", "no way", "stopped"]
"""Why an episode ended."""


@record
class Cause:
    """Why an episode ended: the ``kind`` of end, its cause, time and place, and a ``text``.

    ``by`` names the enemies and lasers that killed the player, those with the most damage first; or
    the atoms that violated the spec; or the entities that cannot be reached. ``time`` is in seconds
    since the reset; ``place`` is the position of the player's feet at that time. ``broke`` names
    the atoms that violated the spec, whatever the ``kind``; it is empty if the spec was not
    violated.
    """

    kind: Kind
    by: tuple[str, ...]
    time: float
    place: Point
    text: str
    broke: tuple[str, ...] = ()


@record
class Trajectory:
    """The player's path, the automaton's states, and the end of an episode of n decisions.

    It is small enough to keep hundreds of them in memory.  ``points`` is (n + 1, 2), in metres;
    ``states`` is (n + 1,).
    """

    points: NDArray[np.float32]
    states: NDArray[np.int32]
    end: End


def trajectory(episode: RecordedEpisode) -> Trajectory:
    """Return the trajectory of an episode."""
    return Trajectory(episode.positions[:, :2].astype(np.float32), episode.states, episode.end)
