"""The confirmation of a policy in fresh episodes, before a training ends.

Success in all windows is not enough: policies of several iterations played them, and windows
without a failure also occur by chance.  A policy with a pass rate of 0.99 meets the spec in 300
episodes in a row with probability 1/20.
"""

from __future__ import annotations

import numpy as np

from tltl_runtime.evaluation.evaluate import evaluate
from tltl_runtime.policies.policy import Policy
from tltl_runtime.training.run.checkpoint import level_changed
from tltl_runtime.training.run.report import Confirmation
from tltl_runtime.training.run.run_file import Run, current_level_hash


def confirm(run: Run, policy: Policy, stream: np.random.SeedSequence) -> Confirmation:
    """Let a policy play the number of fresh episodes in the settings, or up to the first failure.

    Raises:
        TltlError: TLT0868, the level has changed since the training.
    """
    _check_level(run, policy)
    seed, count, met = int(stream.generate_state(1)[0]), run.settings.stop.confirmation, 0
    for played in evaluate(policy, run.level, run.variant, episodes=count, seed=seed):
        if not played.success:
            break
        met += 1
    return Confirmation(met, count)


def _check_level(run: Run, policy: Policy) -> None:
    if current_level_hash(run) != policy.card.level_hash:
        raise level_changed(run.folder)
