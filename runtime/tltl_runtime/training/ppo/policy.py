"""Make policies from a training, and the cards (metadata) that describe them."""

from __future__ import annotations

from collections.abc import Mapping

from torch import Tensor

from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.policy import NotFiniteError, Policy
from tltl_runtime.policies.torch_actor import arrays
from tltl_runtime.training.files.run_file import TrainingRun
from tltl_runtime.training.files.versions import versions
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltlc.api import Diagnostic, TltlError


def card_of(run: TrainingRun, env: TrainingEnv) -> Card:
    """Return the card (the metadata) of a policy that ``run`` trains in ``env``.

    The card's field ``training`` is empty until the training ends. The level is read from its file
    as it is now.
    """
    game = game_of(run.level)
    level = game.load_level(run.level, run.variant)
    return Card(
        level=level.name,
        variant=level.variant,
        level_hash=game.level_hash(level),
        fspa=run.fspa,
        params=run.params,
        reward=run.settings.rewards,
        sensors=run.sensors,
        shapes=tuple(env.shapes.items()),
        branches=env.branches,
        network=run.settings.network,
        versions=versions(),
        training={},
        spaces=env.layouts,
    )


def policy_of(card: Card, weights: Mapping[str, Tensor]) -> Policy:
    """Return the policy that ``card`` describes, with the ``weights`` of an actor, by name.

    Raises:
        TltlError: TLT0866, a weight is not finite in half precision.
    """
    try:
        return Policy(card, arrays(weights))
    except NotFiniteError as error:
        help_ = "train again with a smaller `learning_rate` or `max_gradient`"
        raise TltlError([Diagnostic("TLT0866", str(error), help=help_)]) from None
