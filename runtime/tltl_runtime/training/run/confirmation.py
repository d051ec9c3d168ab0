"""The last word on a policy: whether it meets the spec in fresh episodes, too.

The windows that seem to end a training were played by the policies of several iterations, and chance, too, makes
windows without a failure.  A policy whose pass rate is 0.99 meets it in 300 in a row once in twenty times.
"""

from __future__ import annotations

import numpy as np

from tltl_runtime.evaluation.evaluate import evaluate
from tltl_runtime.policies.identity import level_hash
from tltl_runtime.policies.policy import Policy
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.training.run.checkpoint import level_changed
from tltl_runtime.training.run.report import Confirmation
from tltl_runtime.training.run.run import Run


def confirm(run: Run, policy: Policy, stream: np.random.SeedSequence) -> Confirmation:
    """Have a policy play fresh episodes, as many as the settings say, up to the first one that fails.

    Raises:
        TltlError: TLT0868, the level is another now than the one that was trained on.
    """
    _check_level(run, policy)
    seed, count, met = int(stream.generate_state(1)[0]), run.settings.stop.confirmation, 0
    for played in evaluate(policy, run.level, run.variant, episodes=count, seed=seed):
        if not played.success:
            break
        met += 1
    return Confirmation(met, count)


def _check_level(run: Run, policy: Policy) -> None:
    if level_hash(load_level(run.level, run.variant)) != policy.card.level_hash:
        raise level_changed(run.folder)
