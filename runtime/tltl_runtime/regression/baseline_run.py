"""The baseline of a suite is recorded: its policies play all episodes, on the levels as they are now."""

from __future__ import annotations

from collections.abc import Iterator

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.regression.account import Account
from tltl_runtime.regression.baseline import Reference
from tltl_runtime.regression.play import Ready, Told, episodes, ready
from tltl_runtime.regression.suite import Suite


def record_baseline(suite: Suite, pool: Pool, told: Told) -> Iterator[Reference]:
    """Play all episodes of each level, variant, spec and policy that the suite's cases are compared with.

    Of cases that are compared with the same, that counts which asks for most episodes.

    Raises:
        TltlError: something does not fit, before anything is played; TLT0905, a level was edited since; what playing
            raises.
    """
    wanted: list[Ready] = []
    for case in suite.cases:
        one = ready(case, suite.seed, case.reference)
        rows = [row for row, other in enumerate(wanted) if other.played == one.played]
        if not rows:
            wanted.append(one)
        elif wanted[rows[0]].case.episodes < case.episodes:
            wanted[rows[0]] = one
    for one in wanted:
        accounts: list[Account] = []
        for each in episodes(one, pool):
            accounts.append(each.account)
            told(one.case, len(accounts), each.account)
        yield Reference(one.played, tuple(accounts))
