"""What weighs how much in a training, by how often the spec is met."""

from __future__ import annotations

from collections.abc import Callable

from tltl_runtime.training.run.run import Run
from tltl_runtime.training.run.settings import Ppo
from tltlc.core.record import record, replace
from tltlc.monitor.reward import terminal_penalty


@record
class Weighing:
    """The weight of the ``entropy`` bonus, None: it stays as it is; the ``severity`` of failures, in [0, 1], as
    :class:`~tltl_runtime.training.ppo.environment.TrainingEnv` takes it; and the ``sharpness``, by which the actor's
    logits are multiplied in all, 1 at least.
    """

    entropy: float | None
    severity: float
    sharpness: float


def weighing(ppo: Ppo, met: float) -> Weighing:
    """What weighs how much where the share ``met`` of the last episodes, in [0, 1], met the spec.

    The more often it is met, the less there is to try, so the entropy bonus fades.  From a half on failures cost more:
    the discounted penalty is less than what a longer way costs that is safe.  What is chosen by chance against what was
    learned makes most of the failures then, so the likelier choices become likelier.
    """
    rise = max(0.0, 2 * met - 1)
    return Weighing(
        entropy=ppo.entropy * (1 - met) if ppo.entropy_schedule == "fading" else None,
        severity=rise,
        sharpness=1 + (ppo.sharpening - 1) * rise,
    )


def dearer(run: Run) -> Callable[[int], float] | None:
    """How much more the undiscounted terminal penalty is after so many steps; None where it is not to rise to that."""
    limit, options = run.fspa.limit_steps, run.settings.reward.options
    if limit is None or run.settings.imitates or not run.settings.reward.rises:
        return None
    whole = replace(options, terminal_penalty="undiscounted")
    return lambda steps: terminal_penalty(limit, steps, whole) - terminal_penalty(limit, steps, options)
