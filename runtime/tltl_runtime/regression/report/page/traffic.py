"""Count the episodes that visited each state of the automaton, failed in it, or took each edge."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise

from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltlc.api import record


@record
class Traffic:
    """How episodes moved through an automaton: counts of the states and edges that they visited.

    ``episodes`` is the number of episodes. ``noun`` is the word for them in texts: ``episodes`` or
    ``traces``. ``visited`` counts, for each state, the episodes that visited it, and ``failed`` those
    that failed in it. An episode fails in the state in which it ends, or in the state before a
    violation. ``edges`` has, for each episode, the edges (source, target) that it took, without
    self-loops.
    """

    episodes: int
    visited: Mapping[int, int]
    failed: Mapping[int, int]
    edges: tuple[frozenset[tuple[int, int]], ...]
    noun: str = "episodes"


def traffic(episodes: Sequence[ExplainedEpisode], noun: str = "episodes") -> Traffic:
    """Count the states and edges that ``episodes`` visited.

    An episode that visits a state or an edge several times counts once for it.
    """
    visited: Counter[int] = Counter()
    edges = []
    for episode in episodes:
        states = [arrival.state for arrival in episode.arrivals]
        visited.update(set(states))
        edges.append(frozenset(pairwise(states)))
    failed = Counter(episode.summary.unmet for episode in episodes if not episode.summary.success)
    return Traffic(len(episodes), visited, failed, tuple(edges), noun)
