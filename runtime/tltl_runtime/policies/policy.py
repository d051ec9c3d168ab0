"""A policy: the actor's network, and what it was trained for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from rsl_rl.models import MLPModel
from rsl_rl.utils import resolve_class
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.policies.card import Card
from tltl_runtime.policies.network import Network, Shapes, model_config


class NoNumbersError(ValueError):
    """What a network is made of, what goes into it, or what comes out of it, is not finite; the message says what."""


class Policy:
    """An actor's weights with their card.

    The ``weights``, by name, are taken as they are now and rounded to half precision: what a file holds is what plays,
    bit for bit, and a training that goes on changes nothing.  What a policy chooses depends on nothing but the
    observation, and on the generator where it samples: an observation is taken alone, never in a batch, whose size
    would change the last bits of the logits.

    Raises:
        NoNumbersError: a weight is no finite number in half precision.
        ValueError: the weights are not those of the network that the card describes.
    """

    def __init__(self, card: Card, weights: Mapping[str, Tensor]) -> None:
        # With an order of their own in memory they would be computed with in another one, too.
        rounded = {name: each.detach().cpu().half().contiguous() for name, each in weights.items()}
        if not all(bool(each.isfinite().all()) for each in rounded.values()):
            raise NoNumbersError(
                "a weight of the actor is no finite number in half precision: its training has diverged"
            )
        self.card = card
        self.actor = _actor_of(card, rounded)

    def weights(self) -> dict[str, Tensor]:
        """The weights by name, in half precision, without loss."""
        return {name: each.to(torch.float16) for name, each in self.actor.state_dict().items()}

    def logits(self, observation: Mapping[str, NDArray[Any]]) -> NDArray[np.float32]:
        """The logits [sum(branches)] of the observation of one environment."""
        # A plain dict will do for the model: a TensorDict takes as long to make as the network to run.
        batch = {key: torch.from_numpy(np.asarray(observation[key], np.float32)[None]) for key, _ in self.card.shapes}
        with torch.inference_mode():
            return self.actor.mlp(self.actor.get_latent(batch))[0].numpy()  # type: ignore[no-any-return]

    def choose(
        self, observation: Mapping[str, NDArray[Any]], generator: np.random.Generator | None = None
    ) -> NDArray[np.int64]:
        """The action [branches]: sampled with ``generator``, without one the likeliest choice of each branch.

        Of equally likely choices the first is taken.

        Raises:
            NoNumbersError: the observation, or what the network makes of it, has values that are no finite numbers.
        """
        logits = self.logits(observation).astype(np.float64)
        if not np.isfinite(logits).all():
            raise NoNumbersError(_no_numbers(observation))
        if generator is not None:
            # Of logits with such noise the greatest is a sample of their softmax.
            logits += generator.gumbel(size=len(logits))
        ends = np.cumsum(self.card.branches)
        return np.array([logits[end - size : end].argmax() for size, end in zip(self.card.branches, ends, strict=True)])


def _no_numbers(observation: Mapping[str, NDArray[Any]]) -> str:
    parts = [key for key, each in observation.items() if not np.isfinite(each).all()]
    what = f"`{parts[0]}` of the observation has values" if parts else "the policy's network gives values"
    return f"{what} that are no finite numbers"


def new_actor(card: Card) -> MLPModel:
    """An actor as the card describes it, its weights as they are drawn; raises ValueError for what is no network."""
    return _actor(card.network, dict(card.shapes), card.branches)


def blank_actor(card: Card) -> MLPModel:
    """An actor as the card describes it that has no weights yet but their names and shapes; nothing is drawn."""
    with torch.device("meta"):
        return new_actor(card)


def weight_count(network: Network, shapes: Shapes, branches: Sequence[int]) -> int:
    """How many weights an actor has; none is made."""
    with torch.device("meta"):
        return sum(each.numel() for each in _actor(network, shapes, branches).state_dict().values())


def _actor_of(card: Card, weights: Mapping[str, Tensor]) -> MLPModel:
    """An actor with a copy of such weights, ready to play."""
    actor = blank_actor(card)
    try:
        actor.load_state_dict({name: each.float() for name, each in weights.items()}, assign=True)
    except RuntimeError as error:
        raise ValueError(f"the weights are of another network than the card describes: {error}") from None
    return actor.requires_grad_(False).eval()


def _actor(network: Network, shapes: Shapes, branches: Sequence[int]) -> MLPModel:
    model, arguments = resolve_class(model_config(network, shapes, branches))
    blank = TensorDict({key: torch.zeros(1, *shape) for key, shape in shapes.items()}, batch_size=[1])
    actor: MLPModel = model(blank, {"actor": list(shapes)}, "actor", len(branches), **arguments)
    return actor
