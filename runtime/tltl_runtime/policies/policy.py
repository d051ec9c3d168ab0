"""A policy: the network of an actor and its card."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.policies.actor import Actor
from tltl_runtime.policies.card import Card


class NotFiniteError(ValueError):
    """Raised if weights, input or output of a network are infinite or NaN; the message says which."""


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

    def __init__(self, card: Card, weights: Mapping[str, NDArray[Any]]) -> None:
        with np.errstate(over="ignore"):  # A weight that is too large becomes infinite.
            # In one memory layout: with another one, NumPy would add in another order.
            rounded = {name: np.array(weight, np.float16, order="C") for name, weight in weights.items()}
        if not all(np.isfinite(weight).all() for weight in rounded.values()):
            raise NotFiniteError(
                "a weight of the actor is not a finite number in half precision: its training has diverged"
            )
        self.card = card
        self._weights = rounded
        self._actor = Actor(card.network, dict(card.shapes), card.branches, rounded)

    def __reduce__(self) -> tuple[Any, ...]:
        # The weights in half precision make the network again, and take a third of the space of both.
        return Policy, (self.card, self._weights)

    def weights(self) -> dict[str, NDArray[np.float16]]:
        """Return copies of the weights by name, in half precision, as in the policy's file."""
        return {name: weight.copy() for name, weight in self._weights.items()}

    def weight_count(self) -> int:
        """Return how many numbers the weights have."""
        return sum(weight.size for weight in self._weights.values())

    def logits(self, observation: Mapping[str, NDArray[Any]]) -> NDArray[np.float32]:
        """Return the logits [sum(branches)] for the observation of one environment."""
        return self._actor.logits(observation)

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
