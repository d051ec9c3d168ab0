"""The layouts of a game's observations and actions."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces

from tltl_runtime.game.sensors import NO_SENSORS, Sensors, sensor_shapes
from tltl_runtime.policies.spaces.action_layout import ActionLayout, action_layout
from tltl_runtime.policies.spaces.observation_layout import ObservationPart, observation_layout
from tltl_runtime.policies.spaces.refusals import ADDED_KEYS
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


def space_layouts(
    observation: spaces.Space[Any], action: spaces.Space[Any], sensors: Sensors = NO_SENSORS
) -> SpaceLayouts | None:
    """Return the layouts of two spaces; None if the network takes and gives their values as they are.

    That is so if the observation has the keys that :class:`~tltl_runtime.spec.wrapper.TltlEnv` adds,
    the parts that ``sensors`` give, and no others.

    Raises:
        TltlError: TLT0844, no policy can have one of the spaces.
    """
    if isinstance(observation, spaces.Dict) and _is_plain(observation, sensors) and is_plain_action(action):
        return None
    return SpaceLayouts(observation_layout(observation), action_layout(action))


def is_plain_action(space: spaces.Space[Any]) -> bool:
    """Whether an action is one row of choices that count from 0: a flat action is then the action."""
    return isinstance(space, spaces.MultiDiscrete) and space.nvec.ndim == 1 and not space.start.any()


def _is_plain(space: spaces.Dict, sensors: Sensors) -> bool:
    """Whether an observation has what sensors give alone: vectors in [-1, 1] and maps of zeros and ones."""
    shapes = {key: part.shape for key, part in space.spaces.items() if key not in ADDED_KEYS}
    if shapes != sensor_shapes(sensors):
        return False
    return all(isinstance(part, spaces.Box) and _is_plain_part(part) for part in space.spaces.values())


def _is_plain_part(part: spaces.Box) -> bool:
    if len(part.shape) == 1:
        return part.dtype == np.float32 and bool((part.low >= -1).all() and (part.high <= 1).all())
    return len(part.shape) == 3 and part.dtype == np.uint8 and bool((part.low == 0).all() and (part.high == 1).all())
