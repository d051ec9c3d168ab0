"""What an environment offers beside steps and signals: optional methods, which ``docs/games.md`` describes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, Literal

import gymnasium

Capability = Literal["params", "clock", "positions", "outline", "cause", "snapshot", "expert", "render"]

ATTRIBUTES: Final[Mapping[Capability, tuple[str, ...]]] = {
    "params": ("tltl_params",),
    "clock": ("tltl_clock_s",),
    "positions": ("tltl_positions",),
    "outline": ("tltl_outline",),
    "cause": ("tltl_cause",),
    "snapshot": ("tltl_snapshot", "tltl_restore"),
    "expert": ("tltl_expert",),
}
"""The attributes of the environment that make up each capability; ``render`` has no attribute of ours."""


def capabilities(env: gymnasium.Env[Any, Any]) -> tuple[Capability, ...]:
    """Return what an environment, or an environment that it wraps, offers.

    ``render`` means that the environment can draw its frames as arrays.
    """
    capabilities: list[Capability] = [
        capability for capability, names in ATTRIBUTES.items() if all(map(env.has_wrapper_attr, names))
    ]
    if "rgb_array" in (env.metadata or {}).get("render_modes", ()):
        capabilities.append("render")
    return tuple(capabilities)
