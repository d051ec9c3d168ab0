"""The figures of a case: over its episodes, its baseline's, or those of a policy that was trained further."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.evaluation.statistics import Spread, spread_of, wilson
from tltl_runtime.regression.account import Account
from tltlc.record import record


@record
class Figures:
    """Over ``episodes``: the pass rate with its Wilson interval of 95 %, progress and reward."""

    episodes: int
    pass_rate: float
    pass_interval: tuple[float, float]
    progress: Spread
    reward: Spread
    steps: Spread


def figures(accounts: Sequence[Account]) -> Figures:
    """The figures over some episodes; raises ValueError where there are none."""
    passed = sum(each.success for each in accounts)
    return Figures(
        episodes=len(accounts),
        pass_rate=passed / len(accounts),
        pass_interval=wilson(passed, len(accounts)),
        progress=spread_of([each.progress for each in accounts]),
        reward=spread_of([each.reward for each in accounts]),
        steps=spread_of([float(each.steps) for each in accounts]),
    )
