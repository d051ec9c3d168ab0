"""A policy: the network of an actor and its card."""

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


class NotFiniteError(ValueError):
    """Raised if weights, input or output of a network are not finite; the message says which."""


class Policy:
    """The weights of an actor with their card.

    ``weights``, by name, are copied and rounded to half precision. So a policy plays with exactly
    the weights in its file, and a training that continues does not change the policy. An action
    depends only on the observation, and on the generator if the action is sampled. Observations are
    never batched, because the batch size would change the last bits of the logits.

    Raises:
        NotFiniteError: a weight is not finite in half precision.
        ValueError: the weights do not fit the network that the card describes.
    """

    def __init__(self, card: Card, weights: Mapping[str, Tensor]) -> None:
        # `contiguous`: with another memory layout, torch would compute in another order.
        rounded = {name: tensor.detach().cpu().half().contiguous() for name, tensor in weights.items()}
        if not all(bool(tensor.isfinite().all()) for tensor in rounded.values()):
            raise NotFiniteError(
                "a weight of the actor is not a finite number in half precision: its training has diverged"
            )
        self.card = card
        self.actor = _actor_of(card, rounded)

    def weights(self) -> dict[str, Tensor]:
        """Return the weights by name, in half precision, as in the policy's file."""
        return {name: tensor.to(torch.float16) for name, tensor in self.actor.state_dict().items()}

    def logits(self, observation: Mapping[str, NDArray[Any]]) -> NDArray[np.float32]:
        """Return the logits [sum(branches)] for the observation of one environment."""
        # The model accepts a plain dict. Making a TensorDict takes as long as running the network.
        batch = {key: torch.from_numpy(np.asarray(observation[key], np.float32)[None]) for key, _ in self.card.shapes}
        with torch.inference_mode():
            return self.actor.mlp(self.actor.get_latent(batch))[0].numpy()  # type: ignore[no-any-return]

    def choose(
        self, observation: Mapping[str, NDArray[Any]], generator: np.random.Generator | None = None
    ) -> NDArray[np.int64]:
        """Return an action [branches]: sampled with ``generator``, or the likeliest without one.

        On ties, the first choice is taken.

        Raises:
            NotFiniteError: the observation or the output of the network is not finite.
        """
        logits = self.logits(observation).astype(np.float64)
        if not np.isfinite(logits).all():
            raise NotFiniteError(_not_finite_message(observation))
        if generator is not None:
            # The Gumbel-max trick: the argmax of logits plus Gumbel noise is a sample of their softmax.
            logits += generator.gumbel(size=len(logits))
        ends = np.cumsum(self.card.branches)
        return np.array([logits[end - size : end].argmax() for size, end in zip(self.card.branches, ends, strict=True)])


def _not_finite_message(observation: Mapping[str, NDArray[Any]]) -> str:
    parts = [key for key, values in observation.items() if not np.isfinite(values).all()]
    cause = f"`{parts[0]}` of the observation has values" if parts else "the policy's network gives values"
    return f"{cause} that are not finite numbers"


def new_actor(card: Card) -> MLPModel:
    """Return the actor that the card describes, with random weights.

    Raises ValueError if the card describes no network.
    """
    return _actor(card.network, dict(card.shapes), card.branches)


def blank_actor(card: Card) -> MLPModel:
    """Return the actor that the card describes, with names and shapes of weights but no values.

    No random numbers are drawn.
    """
    with torch.device("meta"):
        return new_actor(card)


def weight_count(network: Network, shapes: Shapes, branches: Sequence[int]) -> int:
    """Return the number of weights of an actor, without allocating them."""
    with torch.device("meta"):
        return sum(tensor.numel() for tensor in _actor(network, shapes, branches).state_dict().values())


def _actor_of(card: Card, weights: Mapping[str, Tensor]) -> MLPModel:
    """Return an actor with a copy of the weights, in evaluation mode."""
    actor = blank_actor(card)
    try:
        actor.load_state_dict({name: tensor.float() for name, tensor in weights.items()}, assign=True)
    except RuntimeError as error:
        raise ValueError(f"the weights are of another network than the card describes: {error}") from None
    return actor.requires_grad_(False).eval()


def _actor(network: Network, shapes: Shapes, branches: Sequence[int]) -> MLPModel:
    model, arguments = resolve_class(model_config(network, shapes, branches))
    blank = TensorDict({key: torch.zeros(1, *shape) for key, shape in shapes.items()}, batch_size=[1])
    actor: MLPModel = model(blank, {"actor": list(shapes)}, "actor", len(branches), **arguments)
    return actor
