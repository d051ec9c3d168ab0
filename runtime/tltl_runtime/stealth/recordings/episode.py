"""A played episode: its actions, its snapshots, and how the automaton judged it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.spec.episode_summary import End
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.snapshot import Snapshot
from tltlc.api import EMPTY, Fspa, RewardOptions, record


@record
class Episode:
    """One episode of n time steps, with all data that is needed to draw it and to judge it again.

    If the level is reset with ``seed`` and ``actions`` are played, the same episode results, bit
    for bit. Arrays of length n + 1 begin with the moment of the reset. ``end`` is ``limit`` if the
    step limit of the spec or of the environment came before the verdict was final, and ``stopped``
    if the player left.
    """

    level: StealthLevel
    fspa: Fspa
    params: Mapping[str, float]
    """The values of the spec's params, in SI units."""
    player: str
    """The name of the player, such as ``expert``, ``keyboard``, or the name of a policy."""
    seed: int
    actions: NDArray[np.uint8]
    """(n, 5), elements of MultiDiscrete([3, 3, 2, 2, 2])."""
    snapshots: tuple[Snapshot, ...]
    """n + 1 snapshots."""
    signals: NDArray[np.float64]
    """(n + 1, signals), the signals of the spec, in its order and in SI units."""
    atoms: NDArray[np.float64]
    """(n, atoms), the robustness of the atoms, in the spec's order."""
    states: NDArray[np.int32]
    """(n + 1,), the states of the automaton, from 0."""
    progress: NDArray[np.float64]
    """(n + 1,), the best progress so far, in [0, 1]."""
    rewards: NDArray[np.float64]
    """(n,), the reward of each time step."""
    verdict: str
    """The verdict of the last step: ``holding``, ``pending``, ``satisfied`` or ``violated``."""
    success: bool
    end: End
    reward: RewardOptions = RewardOptions()
    """The options by which the rewards were computed."""
    versions: Mapping[str, str] = EMPTY
    """The versions of Python and of the packages that played the episode.

    The same versions play it again, bit for bit.
    """

    @property
    def times(self) -> NDArray[np.float64]:
        """The times of the snapshots, (n + 1,), in seconds since the reset."""
        return np.array([shot.time for shot in self.snapshots], dtype=np.float64)

    @property
    def positions(self) -> NDArray[np.float64]:
        """The positions of the player's feet in the snapshots, (n + 1, 3), in metres."""
        return np.array([shot.player.position for shot in self.snapshots], dtype=np.float64)
