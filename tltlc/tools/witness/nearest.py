"""Find the nearest edge that no trace has taken, without searching the automaton anew each time."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.infinite.graphs import components


class NearestEdges:
    """Finds paths to the nearest wanted edge. Edges can only stop being wanted.

    ``leaving`` has for each state its edges as pairs of an index and a target, in the order in
    which they are tried. Initially every edge is wanted. The paths are the same as those of a
    breadth-first search.

    ``_bound`` is a lower bound on the number of edges between a state and the nearest state that a
    wanted edge leaves. It never decreases, so what one search learns stays true in all later
    searches. ``_next`` is the index of the first edge of a state whose target may be nearer than
    the state. ``looks`` counts the edges that searches have looked at.
    """

    def __init__(self, leaving: Sequence[Sequence[tuple[int, int]]]) -> None:
        self.looks = 0
        self._leaving = leaving
        self._wanted = [[edge for edge, _ in reversed(edges)] for edges in leaving]
        self._bound = [0] * len(leaving)
        self._next = [0] * len(leaving)
        self._targets = [tuple(target for _, target in edges) for edges in leaving]
        self._component = [0] * len(leaving)
        self._hopes: list[int] = []
        self._into: list[list[int]] = []
        self._find_components()

    def _find_components(self) -> None:
        """Count the hopes of each strongly connected component.

        These are its wanted edges, and its edges to other components with hopes.
        """
        for group in components(range(len(self._leaving)), self._targets.__getitem__):
            number = len(self._hopes)
            for state in group:
                self._component[state] = number
            self._into.append([])
            self._hopes.append(0)
            for state in group:
                self._hopes[number] += len(self._wanted[state])
                for target in self._targets[state]:
                    other = self._component[target]
                    if other != number and self._hopes[other]:
                        self._into[other].append(number)
                        self._hopes[number] += 1

    def take(self, start: int) -> tuple[int, ...]:
        """Return the edges of a path from a state to a wanted edge, which is then no longer wanted.

        The path ends with the wanted edge. It is empty if no wanted edge can be reached.
        """
        if not self._has_hope(start):
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
        self._lose_hope(self._component[states[-1]])
        return (*(self._leaving[state][self._next[state]][0] for state in states[:-1]), last)

    def _nearer(self, state: int) -> int | None:
        """Return the target of the first edge that may lead nearer, or None if no edge does."""
        targets, bound = self._targets[state], self._bound[state]
        for place in range(self._next[state], len(targets)):
            self.looks += 1
            target = targets[place]
            if self._bound[target] < bound and self._has_hope(target):
                self._next[state] = place
                return target
        return None

    def _has_hope(self, state: int) -> bool:
        return self._hopes[self._component[state]] > 0

    def _lose_hope(self, component: int) -> None:
        """Remove one hope of a component.

        If none is left, each component that leads to it loses a hope, too.
        """
        lost = [component]
        while lost:
            number = lost.pop()
            self._hopes[number] -= 1
            if not self._hopes[number]:
                lost += self._into[number]
