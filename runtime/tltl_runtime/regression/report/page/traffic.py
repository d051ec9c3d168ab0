"""How many episodes came to which states of the automaton, by which edges, and where they failed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise

from tltl_runtime.regression.explain.account import Account
from tltlc.core.record import record


@record
class Traffic:
    """Of so many ``episodes``: how many ``visited`` each state and ``failed`` in it, and the edges that each ``took``.

    Edges are (source, target); loops, on which an episode stays where it is, are not counted.  An episode that fails
    does so in the state that it could not leave, or in which the spec was broken.
    """

    episodes: int
    visited: Mapping[int, int]
    failed: Mapping[int, int]
    took: tuple[frozenset[tuple[int, int]], ...]


def traffic(accounts: Sequence[Account]) -> Traffic:
    """The traffic of some episodes, each counted once for each state and edge."""
    visited: Counter[int] = Counter()
    took = []
    for each in accounts:
        states = [arrival.state for arrival in each.arrivals]
        visited.update(set(states))
        took.append(frozenset(pairwise(states)))
    failed = Counter(each.unmet for each in accounts if not each.success)
    return Traffic(len(accounts), visited, failed, tuple(took))
