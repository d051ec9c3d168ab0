"""Entropy bonus, penalty weight and inverse temperature, by how often the spec is met."""

from __future__ import annotations

from collections.abc import Callable

from tltl_runtime.training.run.run_file import Run
from tltl_runtime.training.run.settings import Ppo
from tltlc.api import monitors, record, replace


@record
class Weighing:
    """The weights of a training.

    ``entropy`` is the weight of the entropy bonus; None: it stays as it is.  ``severity`` is the
    penalty weight of failures, in [0, 1]: see
    :class:`~tltl_runtime.training.ppo.environment.TrainingEnv`.  ``sharpness`` is the inverse
    temperature, at least 1: the total factor on the actor's logits.
    """

    entropy: float | None
    severity: float
    sharpness: float


def weighing(ppo: Ppo, met: float) -> Weighing:
    """Return the weights for the share ``met``, in [0, 1], of the last episodes that met the spec.

    The entropy bonus fades as the spec is met more often, because less exploration is needed.  From
    one half on, the penalty weight rises: the discounted penalty costs less than a longer, safe
    trajectory.  At that stage, most failures come from unlikely actions that were sampled by
    chance, so the inverse temperature rises, too.
    """
    rise = max(0.0, 2 * met - 1)
    return Weighing(
        entropy=ppo.entropy * (1 - met) if ppo.entropy_schedule == "fading" else None,
        severity=rise,
        sharpness=1 + (ppo.sharpening - 1) * rise,
    )


def raised_penalty(run: Run) -> Callable[[int], float] | None:
    """Return a function of the steps: the undiscounted terminal penalty minus the configured one.

    Returns None if the penalty does not rise during the training.
    """
    limit, options = run.fspa.limit_steps, run.settings.reward.options
    if limit is None or run.settings.imitates or not run.settings.reward.rises:
        return None
    whole = replace(options, terminal_penalty="undiscounted")
    return lambda steps: (
        monitors.terminal_penalty(limit, steps, whole) - monitors.terminal_penalty(limit, steps, options)
    )
