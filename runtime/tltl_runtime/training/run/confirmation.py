"""Confirm that a policy meets the spec, by testing it in new episodes before a training ends.

Success in the last episodes of the training is not enough: the policies of several iterations play
them, and many successes in a row also occur by chance. A policy with a pass rate of 0.99 meets the
spec in 300 episodes in a row with probability 1/20.
"""

from __future__ import annotations

import numpy as np

from tltl_runtime.evaluation.evaluate import evaluate
from tltl_runtime.policies.policy import Policy
from tltl_runtime.training.files.checkpoint import level_changed_error
from tltl_runtime.training.files.report import Confirmation
from tltl_runtime.training.files.run_file import TrainingRun, current_level_hash


def confirm(run: TrainingRun, policy: Policy, stream: np.random.SeedSequence) -> Confirmation:
    """Let a policy play as many new episodes as the settings ask for; stop at the first failure.

    The seed of the episodes is drawn from ``stream``.

    Raises:
        TltlError: TLT0868, the level has changed since the training began.
    """
    _check_level(run, policy)
    seed, count, successes = int(stream.generate_state(1)[0]), run.settings.stop.confirmation, 0
    for episode in evaluate(policy, run.level, run.variant, episodes=count, seed=seed):
        if not episode.success:
            return Confirmation(successes, count)
        successes += 1
    # An episode that was lost with its game is neither a success nor a failure.
    return Confirmation(successes, successes)


def _check_level(run: TrainingRun, policy: Policy) -> None:
    if current_level_hash(run) != policy.card.level_hash:
        raise level_changed_error(run.folder)
