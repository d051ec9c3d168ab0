"""Arrange a graph in columns from left to right, and order each column so that few edges cross.

The method is that of Sugiyama, Tagawa and Toda (1981). Edges that close a cycle are set aside. Each
state stands one column after the last state that leads to it. The nodes of a column are sorted by
the mean place of their neighbours.
"""

from __future__ import annotations

from bisect import bisect_right, insort
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Final

_SWEEPS: Final = 12

EdgeEnds = tuple[int, int]
"""The numbers of the source and the target of an edge."""
LayoutNode = tuple[int, ...]
"""``(state,)`` for a state, or ``(source, target, column)`` for an edge that passes a column."""


def columns_of(states: Sequence[int], edges: Iterable[EdgeEnds]) -> dict[int, int]:
    """Return the column of each state: the length of the longest path to it along edges that close no cycle."""
    after: dict[int, list[int]] = {state: [] for state in states}
    for a, b in edges:
        after[a].append(b)
    finished, forward = _postorder_and_forward_edges(after)
    column = dict.fromkeys(states, 0)
    for state in reversed(finished):
        for target in forward[state]:
            column[target] = max(column[target], column[state] + 1)
    return column


def chain(ends: EdgeEnds, column: Mapping[int, int]) -> list[LayoutNode]:
    """Return an edge as a list of nodes, from its source through each column that it passes to its target.

    ``column`` maps states to their columns: ``chain((0, 1), {0: 0, 1: 2}) == [(0,), (0, 1, 1), (1,)]``.
    """
    source, target = ends
    a, b = column[source], column[target]
    between = range(a + 1, b) if a < b else range(a - 1, b, -1)
    return [(source,), *((source, target, number) for number in between), (target,)]


def order_columns(column: Mapping[int, int], chains: Iterable[Sequence[LayoutNode]]) -> list[list[LayoutNode]]:
    """Return the nodes of each column from top to bottom, ordered so that few edges cross.

    ``column`` maps states to their columns, and ``chains`` has the nodes of each edge (:func:`chain`).
    """
    columns: list[list[LayoutNode]] = [[] for _ in range(max(column.values()) + 1)]
    for state, number in column.items():
        columns[number].append((state,))
    links = [link for nodes in chains for link in pairwise(nodes)]
    for node in dict.fromkeys(node for link in links for node in link):
        if len(node) > 1:
            columns[node[2]].append(node)
    beside = neighbours(links)
    best, least = [list(nodes) for nodes in columns], _crossings(columns, links)
    for sweep in range(_SWEEPS):
        place = {node: float(index) for nodes in columns for index, node in enumerate(nodes)}
        for nodes in columns if sweep % 2 else reversed(columns):
            mean_place = {
                node: mean([place[neighbour] for neighbour in beside.get(node, ())], place[node]) for node in nodes
            }
            nodes.sort(key=lambda node, mean_place=mean_place: mean_place[node])  # type: ignore[misc]
            place.update({node: float(index) for index, node in enumerate(nodes)})
        crossings = _crossings(columns, links)
        if crossings < least:
            best, least = [list(nodes) for nodes in columns], crossings
    return best


def neighbours(links: Iterable[tuple[LayoutNode, LayoutNode]]) -> dict[LayoutNode, list[LayoutNode]]:
    """Return, for each node, the nodes at the other ends of its links."""
    beside: dict[LayoutNode, list[LayoutNode]] = {}
    for node, neighbour in links:
        beside.setdefault(node, []).append(neighbour)
        beside.setdefault(neighbour, []).append(node)
    return beside


def mean(values: Sequence[float], default: float) -> float:
    """Return the mean, or the default if there are no values."""
    return sum(values) / len(values) if values else default


def _postorder_and_forward_edges(after: Mapping[int, Sequence[int]]) -> tuple[list[int], dict[int, list[int]]]:
    """Return the states in depth-first postorder, and for each state the targets of its edges that close no cycle."""
    finished: list[int] = []
    entered: set[int] = set()
    open_: set[int] = set()
    forward: dict[int, list[int]] = {state: [] for state in after}
    for root in after:
        stack = [] if root in entered else [(root, iter(after[root]))]
        while stack:
            state, rest = stack[-1]
            entered.add(state)
            open_.add(state)
            target = next(rest, None)
            if target is None:
                stack.pop()
                open_.discard(state)
                finished.append(state)
                continue
            if target not in open_:
                forward[state].append(target)
            if target not in entered:
                stack.append((target, iter(after[target])))
    return finished, forward


def _crossings(columns: Sequence[Sequence[LayoutNode]], links: Iterable[tuple[LayoutNode, LayoutNode]]) -> int:
    place = {node: (number, index) for number, nodes in enumerate(columns) for index, node in enumerate(nodes)}
    between: dict[int, list[tuple[int, int]]] = {}
    for link in links:
        (left, a), (_, b) = sorted(place[node] for node in link)
        between.setdefault(left, []).append((a, b))
    crossings = 0
    for pairs in between.values():
        before: list[tuple[int, int]] = []
        for a, b in sorted(pairs):
            # Count the earlier pairs that start above and end below.
            crossings += len(before) - bisect_right(before, (b, a))
            insort(before, (b, a))
    return crossings
