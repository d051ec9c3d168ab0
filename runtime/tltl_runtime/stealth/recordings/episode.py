"""An episode that was played: what was done, what there was to see, and how the automaton judged it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.snapshot import Snapshot
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import EMPTY, record
from tltlc.monitor import RewardOptions

End = Literal["success", "violation", "limit", "stopped"]


@record
class Episode:
    """One episode of n decisions, with all that it takes to draw it and to judge it again.

    ``seed`` is the game's: the level, reset with it, and ``actions`` give the same episode, bit for bit.  Rows of
    length n + 1 begin with the moment of the reset.  ``end`` is ``limit`` where the spec's limit or the environment's
    came before its verdict was settled, and ``stopped`` where the player left off.
    """

    level: Level
    fspa: Fspa
    params: Mapping[str, float]
    """Values of the spec's params, in SI units."""
    player: str
    """Who played: ``expert``, ``keyboard``, or a policy's name."""
    seed: int
    actions: NDArray[np.uint8]
    """(n, 5), of MultiDiscrete([3, 3, 2, 2, 2])."""
    snapshots: tuple[Snapshot, ...]
    """n + 1 of them."""
    signals: NDArray[np.float64]
    """(n + 1, signals), those of the spec, in its order and in SI units."""
    atoms: NDArray[np.float64]
    """(n, atoms), robustness in the spec's order."""
    states: NDArray[np.int32]
    """(n + 1,), of the automaton, from 0."""
    progress: NDArray[np.float64]
    """(n + 1,), the best so far, in [0, 1]."""
    rewards: NDArray[np.float64]
    """(n,)"""
    verdict: str
    """Of the last step: ``holding``, ``pending``, ``satisfied`` or ``violated``."""
    success: bool
    end: End
    reward: RewardOptions = RewardOptions()
    """How the steps were rewarded."""
    versions: Mapping[str, str] = EMPTY
    """Of what recorded the episode, by name: the same ones give the same episode again."""
