"""The nearest edge that no trace has taken yet, found without searching the automaton again for each trace."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.infinite.graphs import components


class Nearest:
    """Ways to the nearest edge that is still wanted; edges only ever stop being wanted.

    ``leaving`` gives for each state its edges as pairs of an index and a target, in the order in which they are tried.
    At first every edge is wanted. A way is the one that a breadth-first search finds.

    ``_bound`` is a lower bound on the number of edges between a state and the next state that a wanted edge leaves. It
    only grows, so what one search learns stays true in all later ones. ``_next`` is the place of the first edge of a
    state whose target may be nearer than the state. ``looks`` counts the edges that searches have looked at.
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
        """Count what each strongly connected component can hope for: its wanted edges, and ways to others with hope."""
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
        """The edges of a way from a state whose last edge was wanted and no longer is; empty where there is none."""
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
        """The target of the first edge that may lead nearer, None where none does."""
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
        """Count one hope of a component less; one without any is a hope less to those that lead to it."""
        lost = [component]
        while lost:
            number = lost.pop()
            self._hopes[number] -= 1
            if not self._hopes[number]:
                lost += self._into[number]
