"""A policy: the actor's network, and what it was trained for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from rsl_rl.models import MLPModel
from rsl_rl.utils import resolve_class
from tensordict import TensorDict

from tltl_runtime.policies.card import Card
from tltl_runtime.policies.network import model_config


class Policy:
    """An actor's weights with their card.

    What it chooses depends on nothing but the observation, and on the generator where it samples: an observation is
    taken alone, never in a batch, whose size would change the last bits of the logits.
    """

    def __init__(self, card: Card, actor: MLPModel) -> None:
        self.card = card
        self.actor = actor.eval()

    def logits(self, observation: Mapping[str, NDArray[Any]]) -> NDArray[np.float32]:
        """The logits [sum(branches)] of the observation of one environment."""
        with torch.inference_mode():
            tensors = {key: torch.from_numpy(np.asarray(observation[key], np.float32)) for key, _ in self.card.shapes}
            batch = TensorDict({key: each.unsqueeze(0) for key, each in tensors.items()}, batch_size=[1])
            return self.actor.mlp(self.actor.get_latent(batch))[0].numpy()  # type: ignore[no-any-return]

    def choose(
        self, observation: Mapping[str, NDArray[Any]], generator: np.random.Generator | None = None
    ) -> NDArray[np.int64]:
        """The action [branches]: sampled with ``generator``, without one the likeliest choice of each branch."""
        logits = self.logits(observation).astype(np.float64)
        parts = np.split(logits, np.cumsum(self.card.branches)[:-1])
        if generator is not None:
            parts = [part + generator.gumbel(size=len(part)) for part in parts]
        return np.array([int(part.argmax()) for part in parts])


def new_actor(card: Card) -> MLPModel:
    """An actor as the card describes it, its weights as they are drawn; raises ValueError for what is no network."""
    shapes = dict(card.shapes)
    model, arguments = resolve_class(model_config(card.network, shapes, card.branches))
    blank = TensorDict({key: torch.zeros(1, *shape) for key, shape in shapes.items()}, batch_size=[1])
    actor: MLPModel = model(blank, {"actor": list(shapes)}, "actor", len(card.branches), **arguments)
    return actor
