"""rsl-rl's configuration of the network for spaces of any kind; importing this module needs no torch."""

from __future__ import annotations

from typing import Any

from tltl_runtime.policies.network import Network
from tltl_runtime.policies.spaces.layouts import SpaceLayouts


def space_model_config(network: Network, layouts: SpaceLayouts, *, is_actor: bool) -> dict[str, Any]:
    """Return rsl-rl's configuration of an actor for these layouts, or of a critic if not ``is_actor``."""
    config: dict[str, Any] = {
        "class_name": "tltl_runtime.policies.spaces.torch_model:SpaceModel",
        "network": network,
        "layouts": layouts,
    }
    if is_actor:
        distribution = "tltl_runtime.policies.spaces.distribution:IndependentParts"
        config["distribution_cfg"] = {"class_name": distribution, "layout": layouts.action}
    return config
