"""The properties that the recorded episodes of all games have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.geometry import Point
from tltl_runtime.game.level import Level
from tltl_runtime.spec.episode_summary import End
from tltlc.api import Fspa, RewardOptions, record


class RecordedEpisode(Protocol):
    """A recorded episode of n decisions.

    If the level is reset with ``seed`` and ``actions`` are played, the same episode results, bit
    for bit.
    """

    @property
    def level(self) -> Level:
        """The level, as it was when the episode was played."""

    @property
    def fspa(self) -> Fspa:
        """The automaton of the spec that judged the episode."""

    @property
    def params(self) -> Mapping[str, float]:
        """The values of the spec's params, in SI units."""

    @property
    def player(self) -> str:
        """The name of the player, such as ``expert``, ``keyboard``, or the name of a policy."""

    @property
    def seed(self) -> int:
        """The seed with which the level was reset."""

    @property
    def actions(self) -> NDArray[Any]:
        """The actions, (n, width), as numbers.

        In a game with ``Game.choices``, a row has the index, from 0, of the choice in each branch.
        """

    @property
    def times(self) -> NDArray[np.float64]:
        """The seconds since the reset, (n + 1,): at the reset and after each decision."""

    @property
    def positions(self) -> NDArray[np.float64] | None:
        """The positions of the player, (n + 1, 3), in metres: at the reset and after each decision.

        None if the game does not say where the player is.
        """

    @property
    def signals(self) -> NDArray[np.float64]:
        """The values of the spec's signals, (n + 1, signals), in the order of the spec and in SI units."""

    @property
    def atoms(self) -> NDArray[np.float64]:
        """The robustness of each atom at each decision, (n, atoms), in the order of the spec."""

    @property
    def states(self) -> NDArray[np.int32]:
        """The numbers of the automaton's states, (n + 1,), from 0: at the reset and after each decision."""

    @property
    def progress(self) -> NDArray[np.float64]:
        """The best progress so far, (n + 1,), in [0, 1]: at the reset and after each decision."""

    @property
    def rewards(self) -> NDArray[np.float64]:
        """The reward of each decision, (n,)."""

    @property
    def reward(self) -> RewardOptions:
        """The options by which the rewards were computed."""

    @property
    def verdict(self) -> str:
        """The verdict of the last step: ``holding``, ``pending``, ``satisfied`` or ``violated``."""

    @property
    def versions(self) -> Mapping[str, str]:
        """The versions of Python and of the packages that played the episode, by name."""

    @property
    def success(self) -> bool:
        """Whether the episode met the spec."""

    @property
    def end(self) -> End:
        """How the episode ended, for example ``success`` or ``violation``."""


EndKind = Literal["success", "killed", "violated", "blocked", "limit", "no way", "stopped"]
"""How an episode ended.

``killed``: the player died. ``violated``: the spec was broken, but the player lived. ``blocked``:
clauses of the spec can no longer be met together; only for recorded traces. ``limit``: time ran out.
``no way``: time ran out for the expert, which had no route to a goal. ``stopped``:
the episode is unfinished.
"""


@record
class Cause:
    """The reason why an episode ended.

    ``kind`` says how it ended, and ``text`` explains the reason to people. ``by`` depends on the
    kind: the enemies and lasers that killed the player, those with the most damage first; the atoms
    that violated the spec; or the entities that cannot be reached. ``time`` is in seconds since the
    reset. ``place`` is the position of the player's feet at that time; None if the game does not give
    it. ``broke`` names the atoms that violated the spec, whatever the ``kind``. It is empty if the
    spec was not violated.
    """

    kind: EndKind
    by: tuple[str, ...]
    time: float
    place: Point | None
    text: str
    broke: tuple[str, ...] = ()


@record
class Trajectory:
    """The player's path, the automaton's states, and the end of an episode of n decisions.

    A trajectory is much smaller than a recorded episode, so hundreds fit into memory. ``points`` are the
    x and y of the player's feet, (n + 1, 2), in metres. ``states`` are the numbers of the automaton's
    states, (n + 1,).
    """

    points: NDArray[np.float32]
    states: NDArray[np.int32]
    end: End


def trajectory(episode: RecordedEpisode) -> Trajectory | None:
    """Return the trajectory of an episode; None if the game does not say where the player is."""
    if episode.positions is None:
        return None
    return Trajectory(episode.positions[:, :2].astype(np.float32), episode.states, episode.end)
