"""A recorded episode of a scene."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.gymnasium_games.entity_positions import EntityPositions
from tltl_runtime.gymnasium_games.scene_level import SceneLevel
from tltl_runtime.policies.spaces.action_layout import ActionLayout
from tltl_runtime.spec.episode_summary import End
from tltlc.api import EMPTY, Fspa, RewardOptions, record


@record
class SceneEpisode:
    """A recorded episode of n steps in a scene, with all data that is needed to judge it again.

    If the game is deterministic, and the scene is reset with ``seed`` and ``actions`` are played, the
    same episode results. Arrays of length n + 1 begin with the moment of the reset.
    """

    level: SceneLevel
    fspa: Fspa
    params: Mapping[str, float]
    """The values of the spec's params, in SI units."""
    player: str
    """The name of the player, such as ``keyboard``, or the name of a policy."""
    seed: int
    layout: ActionLayout
    """What the numbers of an action are."""
    actions: NDArray[np.float64]
    """(n, width), flat actions: see :mod:`~tltl_runtime.policies.spaces.action_layout`."""
    times: NDArray[np.float64]
    """(n + 1,), the seconds since the reset; the numbers of the steps if the game has no clock."""
    positions: NDArray[np.float64] | None
    """(n + 1, 3), the positions of the player, in metres; None if the game does not give them."""
    signals: NDArray[np.float64]
    """(n + 1, signals), the signals of the spec, in its order and in SI units."""
    atoms: NDArray[np.float64]
    """(n, atoms), the robustness of the atoms, in the spec's order."""
    states: NDArray[np.int32]
    """(n + 1,), the states of the automaton, from 0."""
    progress: NDArray[np.float64]
    """(n + 1,), the best progress so far, in [0, 1]."""
    rewards: NDArray[np.float64]
    """(n,), the reward of each step."""
    verdict: str
    """The verdict of the last step: ``holding``, ``pending``, ``satisfied`` or ``violated``."""
    success: bool
    end: End
    killer: str = ""
    """Who or what ended the episode, as the game says; empty if it says nothing."""
    reward: RewardOptions = RewardOptions()
    """The options by which the rewards were computed."""
    versions: Mapping[str, str] = EMPTY
    """The versions of Python and of the packages that played the episode."""
    entities: EntityPositions | None = None
    """Where the other entities were; None if the game does not give positions."""
