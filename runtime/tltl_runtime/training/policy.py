"""The policy of a training."""

from __future__ import annotations

from collections.abc import Mapping

from torch import Tensor

from tltl_runtime.policies.card import Card
from tltl_runtime.policies.identity import level_hash
from tltl_runtime.policies.policy import Policy, actor_of
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.training.environment import TrainingEnv
from tltl_runtime.training.run import Run
from tltl_runtime.training.versions import versions
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


def card_of(run: Run, env: TrainingEnv) -> Card:
    """What a policy says that is trained by ``run`` in ``env``, on the level as its file is now; without a record."""
    level = load_level(run.level, run.variant)
    return Card(
        level=level.name,
        variant=level.variant,
        level_hash=level_hash(level),
        fspa=run.fspa,
        params=run.params,
        reward=run.settings.reward,
        sensors=run.sensors,
        shapes=tuple(env.shapes.items()),
        branches=env.branches,
        network=run.settings.network,
        versions=versions(),
        training={},
    )


def policy_of(card: Card, weights: Mapping[str, Tensor]) -> Policy:
    """The actor of these ``weights`` with its card.

    Raises:
        TltlError: TLT0866, a weight is no finite number in half precision.
    """
    actor = actor_of(card, {name: each.cpu() for name, each in weights.items()})
    try:
        return Policy(card, actor)
    except ValueError as error:
        help_ = "train anew with a smaller `learning_rate` or `max_gradient`"
        raise TltlError([Diagnostic("TLT0866", str(error), help=help_)]) from None
