"""Count how many episodes visited each state of the automaton, took each edge, and failed in each state."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise

from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltlc.api import record


@record
class Traffic:
    """The traffic of ``episodes`` episodes through an automaton.

    ``visited`` and ``failed`` count, for each state, the episodes that visited it and that failed in it.
    ``edges`` are the edges (source, target) that each episode took, without self-loops.  An episode fails
    in the state that it could not leave, or in which the spec was broken.
    """

    episodes: int
    visited: Mapping[int, int]
    failed: Mapping[int, int]
    edges: tuple[frozenset[tuple[int, int]], ...]


def traffic(episodes: Sequence[ExplainedEpisode]) -> Traffic:
    """Return the traffic of some episodes.  An episode counts once for each state and edge."""
    visited: Counter[int] = Counter()
    edges = []
    for episode in episodes:
        states = [arrival.state for arrival in episode.arrivals]
        visited.update(set(states))
        edges.append(frozenset(pairwise(states)))
    failed = Counter(episode.summary.unmet for episode in episodes if not episode.summary.success)
    return Traffic(len(episodes), visited, failed, tuple(edges))
