"""Find paths to the nearest edge that no path has ended with yet, without a new search for each path."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.infinite.graphs import components


class WantedEdges:
    """Finds paths to the nearest wanted edge.

    At first every edge is wanted. Once :meth:`take` has returned a path that ends with an edge, this
    edge is no longer wanted. ``leaving`` has, for each state, the edges that leave it, in the order
    in which they are tried: pairs of an edge index and a target state. The paths are the same as in
    a breadth-first search. ``visited_edges`` counts the edges that all searches together have
    visited.

    ``_bound`` has, for each state, a lower bound on the number of edges on a path to the nearest
    state with a wanted edge. Fewer and fewer edges are wanted, so the bounds remain valid for later
    searches. ``_next`` has, for each state, the position in ``leaving`` of the first edge whose
    target may be nearer.
    """

    def __init__(self, leaving: Sequence[Sequence[tuple[int, int]]]) -> None:
        self.visited_edges = 0
        self._leaving = leaving
        self._wanted = [[edge for edge, _ in reversed(edges)] for edges in leaving]
        self._bound = [0] * len(leaving)
        self._next = [0] * len(leaving)
        self._targets = [tuple(target for _, target in edges) for edges in leaving]
        self._component = [0] * len(leaving)
        self._live_edges: list[int] = []
        self._predecessors: list[list[int]] = []
        self._find_components()

    def _find_components(self) -> None:
        """Find the strongly connected components, and count the live edges of each.

        An edge is live if it is wanted, or if it leads to another component with live edges.
        """
        for group in components(range(len(self._leaving)), self._targets.__getitem__):
            number = len(self._live_edges)
            for state in group:
                self._component[state] = number
            self._predecessors.append([])
            self._live_edges.append(0)
            for state in group:
                self._live_edges[number] += len(self._wanted[state])
                for target in self._targets[state]:
                    successor = self._component[target]
                    if successor != number and self._live_edges[successor]:
                        self._predecessors[successor].append(number)
                        self._live_edges[number] += 1

    def take(self, start: int) -> tuple[int, ...]:
        """Return the edges of a path from a state to the nearest wanted edge.

        The path ends with that edge, which is then no longer wanted. The path is empty if no wanted
        edge can be reached.
        """
        if not self._is_live(start):
            return ()
        states = [start]
        while not self._wanted[states[-1]]:
            state = states[-1]
            target = self._nearer(state)
            if target is not None:
                states.append(target)
                continue
            self._bound[state] += 1
            self._next[state] = 0
            if state != start:
                states.pop()
        last = self._wanted[states[-1]].pop()
        self._remove_live_edge(self._component[states[-1]])
        return (*(self._leaving[state][self._next[state]][0] for state in states[:-1]), last)

    def _nearer(self, state: int) -> int | None:
        """Return the target of the first edge from ``state`` that may lead nearer to a wanted edge, or None."""
        targets, bound = self._targets[state], self._bound[state]
        for place in range(self._next[state], len(targets)):
            self.visited_edges += 1
            target = targets[place]
            if self._bound[target] < bound and self._is_live(target):
                self._next[state] = place
                return target
        return None

    def _is_live(self, state: int) -> bool:
        """Whether a wanted edge can be reached from a state."""
        return self._live_edges[self._component[state]] > 0

    def _remove_live_edge(self, component: int) -> None:
        """Remove a live edge from a component; :meth:`_find_components` says which edges are live.

        If the component has no live edge left, its predecessors lose a live edge, too.
        """
        pending = [component]
        while pending:
            number = pending.pop()
            self._live_edges[number] -= 1
            if not self._live_edges[number]:
                pending += self._predecessors[number]
