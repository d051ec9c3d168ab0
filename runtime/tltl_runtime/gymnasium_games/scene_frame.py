"""The frames that the environment of a scene renders."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

from tltl_runtime.game.capability_error import capability_error
from tltl_runtime.game.films import Picture
from tltl_runtime.game.level import Level

NO_PICTURES = "renders no pictures (`render_mode` `rgb_array`)"
"""What a game lacks if its environments cannot render frames as arrays."""


def scene_frame(env: gymnasium.Env[Any, Any], level: Level, advice: str) -> Picture:
    """Return what an environment with the render mode ``rgb_array`` shows now, (height, width, 3).

    Raises:
        TltlError: TLT0731, with ``advice`` as its help, if the environment renders no pictures; TLT0781,
            if its method ``render`` raises an exception.
    """
    frame = env.render()
    if not isinstance(frame, np.ndarray) or frame.ndim != 3 or frame.shape[2] < 3 or not frame.size:
        raise capability_error(level, NO_PICTURES, advice)
    return np.ascontiguousarray(frame[..., :3]).astype(np.uint8)
