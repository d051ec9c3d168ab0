"""A policy: the network of an actor and its card."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.policies.actor import Actor
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.spaces.encoder_plan import NORMALIZER
from tltl_runtime.policies.spaces.space_actor import SpaceActor
from tltl_runtime.policies.spaces.values import action_value, observation_arrays, squashed


class NotFiniteError(ValueError):
    """Raised if weights, input or output of a network are infinite or NaN; the message says which."""


class Policy:
    """The weights of an actor, with the card (metadata) that describes its network and its training.

    ``weights``, by name, are copied and rounded to half precision. So a policy plays with exactly
    the weights in its file, and further training does not change the policy. An action depends only
    on the observation, and on the generator if the action is sampled. Observations are never
    batched, because the batch size would change the last bits of the logits.

    Raises:
        NotFiniteError: a weight is not finite in half precision.
        ValueError: the weights do not fit the network that the card describes.
    """

    def __init__(self, card: Card, weights: Mapping[str, NDArray[Any]]) -> None:
        with np.errstate(over="ignore"):  # A weight that is too large becomes infinite.
            # In one memory layout: with another one, NumPy would add in another order.
            rounded = {name: np.array(weight, weight_dtype(name), order="C") for name, weight in weights.items()}
        if not all(np.isfinite(weight).all() for weight in rounded.values()):
            raise NotFiniteError(
                "a weight of the actor is not a finite number in half precision: its training has diverged"
            )
        self.card = card
        self._weights = rounded
        self._actor = (
            Actor(card.network, dict(card.shapes), card.branches, rounded)
            if card.spaces is None
            else SpaceActor(card.network, card.spaces, rounded)
        )

    def __reduce__(self) -> tuple[Any, ...]:
        # The weights in half precision make the network again, and take a third of the space of both.
        return Policy, (self.card, self._weights)

    def weights(self) -> dict[str, NDArray[Any]]:
        """Return copies of the weights, by name, in half precision, as in the policy's file.

        Only the means and deviations that scale observations are in single precision.
        """
        return {name: weight.copy() for name, weight in self._weights.items()}

    def weight_count(self) -> int:
        """Return how many numbers all weights have together."""
        return sum(weight.size for weight in self._weights.values())

    def logits(self, observation: Any) -> NDArray[np.float32]:
        """Return the output of the network for the observation of one environment, as a vector.

        The vector has the logits of all choices of an action, and then the means of its continuous
        numbers, before they are squashed to their bounds.
        """
        if isinstance(self._actor, SpaceActor):
            return self._actor.outputs(self._arrays(observation))
        return self._actor.logits(observation)

    def choose(self, observation: Any, generator: np.random.Generator | None = None) -> Any:
        """Return an action for the observation of one environment.

        With a ``generator``, the action is sampled. Without one, it is the likeliest action; on
        ties, the first. It is an int64 array [branches], or if the card has ``spaces``, a value of
        the action space.

        Raises:
            NotFiniteError: the observation or the output of the network is not finite.
        """
        row = self.choose_row(observation, generator)
        if self.card.spaces is None:
            return row
        layout = self.card.spaces.action
        return action_value(layout, squashed(layout, row))

    def choose_row(self, observation: Any, generator: np.random.Generator | None = None) -> NDArray[Any]:
        """Return an action like :meth:`choose`, but as a row of numbers [width].

        The row has the choices of the action, which count from 0, and then its continuous numbers,
        before they are squashed to their bounds.

        Raises:
            NotFiniteError: the observation or the output of the network is not finite.
        """
        logits = self.logits(observation)
        if not np.isfinite(logits).all():
            raise NotFiniteError(_not_finite_message(self._arrays(observation)))
        if isinstance(self._actor, SpaceActor):
            return self._actor.choose(logits, generator)
        return self._branch_choices(logits.astype(np.float64), generator)

    def _branch_choices(self, logits: NDArray[np.float64], generator: np.random.Generator | None) -> NDArray[np.int64]:
        if generator is not None:
            # The Gumbel-max trick: the argmax of logits plus Gumbel noise is a sample of their softmax.
            logits += generator.gumbel(size=len(logits))
        ends = np.cumsum(self.card.branches)
        return np.array([logits[end - size : end].argmax() for size, end in zip(self.card.branches, ends, strict=True)])

    def _arrays(self, observation: Any) -> Mapping[str, NDArray[Any]]:
        """Return the parts of an observation by key."""
        if self.card.spaces is None:
            parts: Mapping[str, NDArray[Any]] = observation
            return parts
        return observation_arrays(self.card.spaces.observation, observation)


def weight_dtype(name: str) -> type[np.floating[Any]]:
    """Return the type in which a policy stores the weight with this name: float16 or float32.

    The means and deviations that scale observations are float32, because they may be too large or
    too exact for half precision.
    """
    return np.float32 if name.startswith(NORMALIZER) else np.float16


def _not_finite_message(observation: Mapping[str, NDArray[Any]]) -> str:
    parts = [key for key, values in observation.items() if not np.isfinite(values).all()]
    cause = f"`{parts[0]}` of the observation has values" if parts else "the policy's network gives values"
    return f"{cause} that are not finite numbers"
