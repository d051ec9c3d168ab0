"""The layouts of a game's observations and actions."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces

from tltl_runtime.policies.spaces.action_layout import ActionLayout, action_layout
from tltl_runtime.policies.spaces.observation_layout import ObservationPart, observation_layout
from tltlc.api import record


@record
class SpaceLayouts:
    """The layouts of observation and action, which a policy's card stores.

    Raises:
        ValueError: there are no parts of an observation, or two have the same key.
    """

    observation: tuple[ObservationPart, ...]
    action: ActionLayout

    def __post_init__(self) -> None:
        keys = {part.key for part in self.observation}
        if not keys or len(keys) < len(self.observation):
            raise ValueError("the parts of an observation need different keys")

    @property
    def shapes(self) -> dict[str, tuple[int, ...]]:
        """The shapes of the parts of one observation, by key."""
        return {part.key: part.shape for part in self.observation}


def space_layouts(observation: spaces.Space[Any], action: spaces.Space[Any]) -> SpaceLayouts | None:
    """Return the layouts of two spaces; None if the network takes and gives their values as they are.

    Raises:
        TltlError: TLT0844, no policy can have one of the spaces.
    """
    if isinstance(observation, spaces.Dict) and _is_plain(observation) and is_plain_action(action):
        return None
    return SpaceLayouts(observation_layout(observation), action_layout(action))


def is_plain_action(space: spaces.Space[Any]) -> bool:
    """Whether an action is one row of choices that count from 0: a flat action is then the action."""
    return isinstance(space, spaces.MultiDiscrete) and space.nvec.ndim == 1 and not space.start.any()


def _is_plain(space: spaces.Dict) -> bool:
    """Whether an observation has only vectors in [-1, 1] and maps of zeros and ones, whose planes come first."""
    return all(isinstance(part, spaces.Box) and _is_plain_part(part) for part in space.spaces.values())


def _is_plain_part(part: spaces.Box) -> bool:
    if len(part.shape) == 1:
        return part.dtype == np.float32 and bool((part.low >= -1).all() and (part.high <= 1).all())
    return len(part.shape) == 3 and part.dtype == np.uint8 and bool((part.low == 0).all() and (part.high == 1).all())
