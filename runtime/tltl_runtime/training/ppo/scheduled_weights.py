"""Compute the entropy bonus, penalty weight and inverse temperature from the pass rate."""

from __future__ import annotations

from collections.abc import Callable

from tltl_runtime.training.files.run_file import TrainingRun
from tltl_runtime.training.files.settings import Ppo
from tltlc.api import monitors, record, replace


@record
class ScheduledWeights:
    """The weights that change during a training.

    ``entropy`` is the weight of the entropy bonus; None if this weight is fixed.
    ``penalty_weight``, in [0, 1], is how far the terminal penalty of failed episodes has risen from
    the discounted to the undiscounted one. ``inverse_temperature``, at least 1, is the total factor
    on the actor's logits.
    """

    entropy: float | None
    penalty_weight: float
    inverse_temperature: float


def scheduled_weights(ppo: Ppo, pass_rate: float) -> ScheduledWeights:
    """Return the weights for a ``pass_rate`` of the last episodes, in [0, 1].

    The entropy bonus fades as the spec is met more often, because less exploration is needed. From
    a pass rate of one half on, the penalty weight rises: with the discounted penalty, a failure
    would cost the agent less than a longer, safe trajectory. The inverse temperature rises, too,
    because most failures then come from unlikely actions that were sampled by chance.
    """
    rise = max(0.0, 2 * pass_rate - 1)
    return ScheduledWeights(
        entropy=ppo.entropy * (1 - pass_rate) if ppo.entropy_schedule == "fading" else None,
        penalty_weight=rise,
        inverse_temperature=1 + (ppo.sharpening - 1) * rise,
    )


def penalty_rise(run: TrainingRun) -> Callable[[int], float] | None:
    """Return a function from the length of a failed episode, in steps, to the rise of its penalty.

    The rise is the undiscounted terminal penalty minus the discounted one. Return None if the
    settings ask for no rising penalty, or the spec has no limit of steps.
    """
    limit, options = run.fspa.limit_steps, run.settings.reward.options
    if limit is None or run.settings.imitates or not run.settings.reward.penalty_rises:
        return None
    undiscounted = replace(options, terminal_penalty="undiscounted")
    return lambda steps: (
        monitors.terminal_penalty(limit, steps, undiscounted) - monitors.terminal_penalty(limit, steps, options)
    )
