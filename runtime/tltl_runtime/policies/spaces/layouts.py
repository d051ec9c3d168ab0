"""The layouts of observations and actions: how their values become arrays for a network."""

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
    """The parts of an observation and of an action; a policy's card stores them.

    Raises:
        ValueError: ``observation`` is empty, or two of its parts have the same key.
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
    """Return the layouts of two spaces; None if the network can use their values without conversion.

    No conversion is needed if an observation has only what ``sensors`` give and the keys that
    :class:`~tltl_runtime.spec.wrapper.TltlEnv` adds, and an action is one row of choices that count
    from 0.

    Raises:
        TltlError: TLT0844, policies do not support one of the spaces.
    """
    if isinstance(observation, spaces.Dict) and _is_plain(observation, sensors) and is_plain_action(action):
        return None
    return SpaceLayouts(observation_layout(observation), action_layout(action))


def is_plain_action(space: spaces.Space[Any]) -> bool:
    """Whether an action is one row of choices that count from 0, and so equal to its flat action."""
    return isinstance(space, spaces.MultiDiscrete) and space.nvec.ndim == 1 and not space.start.any()


def _is_plain(space: spaces.Dict, sensors: Sensors) -> bool:
    """Whether an observation has only what ``sensors`` give and the keys that the wrapper adds.

    Its parts must be vectors in [-1, 1] and maps of zeros and ones.
    """
    shapes = {key: part.shape for key, part in space.spaces.items() if key not in ADDED_KEYS}
    if shapes != sensor_shapes(sensors):
        return False
    return all(isinstance(part, spaces.Box) and _is_plain_part(part) for part in space.spaces.values())


def _is_plain_part(part: spaces.Box) -> bool:
    if len(part.shape) == 1:
        return part.dtype == np.float32 and bool((part.low >= -1).all() and (part.high <= 1).all())
    return len(part.shape) == 3 and part.dtype == np.uint8 and bool((part.low == 0).all() and (part.high == 1).all())
