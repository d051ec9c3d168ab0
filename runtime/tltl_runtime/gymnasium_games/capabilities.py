"""What an environment offers beside steps and signals: optional methods, which ``docs/games.md`` describes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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

_WITHOUT: Final[Mapping[Capability, str]] = {
    "clock": "results and recordings count each step as 1 s",
    "positions": "reports have no maps, and sentences name no places",
    "outline": "maps show positions alone, and sentences name no regions",
    "cause": "sentences do not say who or what ended an episode",
    "snapshot": "a training replays actions to return to a place",
    "render": "there are no films, and `tltlc play` has nothing to show",
}
"""What tltlc does not do, or does more slowly, without a capability. A game needs none of them."""


def missing(offered: Sequence[Capability]) -> dict[Capability, str]:
    """Return what an environment does not offer, and what follows from that; ``offered`` is what it offers.

    Without positions, an outline is not missed.
    """
    lacks = {capability: text for capability, text in _WITHOUT.items() if capability not in offered}
    return {capability: text for capability, text in lacks.items() if capability != "outline" or "positions" in offered}


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
