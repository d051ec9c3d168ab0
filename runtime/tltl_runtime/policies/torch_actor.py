"""Convert policies to torch modules, and weights of torch modules to NumPy arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from numpy.typing import NDArray
from rsl_rl.models import MLPModel
from rsl_rl.utils import resolve_class
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.policies.card import Card
from tltl_runtime.policies.network import model_config
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.spaces.model_config import space_model_config


def new_actor(card: Card) -> MLPModel:
    """Return a new torch module for the network that the card describes, with random weights.

    Raises ValueError if the card describes no valid network.
    """
    model, arguments = resolve_class(_config(card))
    blank = TensorDict({key: torch.zeros(1, *shape) for key, shape in card.shapes}, batch_size=[1])
    width = len(card.branches) if card.spaces is None else card.spaces.action.width
    actor: MLPModel = model(blank, {"actor": [key for key, _ in card.shapes]}, "actor", width, **arguments)
    return actor


def _config(card: Card) -> dict[str, Any]:
    if card.spaces is None:
        return model_config(card.network, dict(card.shapes), card.branches)
    return space_model_config(card.network, card.spaces, is_actor=True)


def torch_actor(policy: Policy) -> MLPModel:
    """Return the network of a policy as a torch module, in evaluation mode and without gradients."""
    with torch.device("meta"):
        actor = new_actor(policy.card)
    weights = {name: torch.from_numpy(weight).float() for name, weight in policy.weights().items()}
    actor.load_state_dict(weights, assign=True)
    return actor.requires_grad_(False).eval()


def arrays(weights: Mapping[str, Tensor]) -> dict[str, NDArray[Any]]:
    """Convert weights by name, such as the state dict of a module, to NumPy arrays by name."""
    return {name: weight.detach().cpu().numpy() for name, weight in weights.items()}
