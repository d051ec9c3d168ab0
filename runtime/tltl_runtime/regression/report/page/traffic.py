"""Count how many episodes visited each state of the automaton, took each edge, and failed in each state."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise

from tltl_runtime.regression.explain.account import Account
from tltlc.api import record


@record
class Traffic:
    """The traffic of ``episodes`` episodes.

    ``visited`` and ``failed`` count the episodes that visited a state and that failed in it.  ``took``
    are the edges (source, target) of each episode, without self-loops.  An episode fails in the state
    that it could not leave, or in which the spec was broken.
    """

    episodes: int
    visited: Mapping[int, int]
    failed: Mapping[int, int]
    took: tuple[frozenset[tuple[int, int]], ...]


def traffic(accounts: Sequence[Account]) -> Traffic:
    """Return the traffic of some episodes.  Each counts once for each state and edge."""
    visited: Counter[int] = Counter()
    took = []
    for account in accounts:
        states = [arrival.state for arrival in account.arrivals]
        visited.update(set(states))
        took.append(frozenset(pairwise(states)))
    failed = Counter(account.summary.unmet for account in accounts if not account.summary.success)
    return Traffic(len(accounts), visited, failed, tuple(took))
