"""Strongly connected components of graphs."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from typing import TypeVar

GraphNode = TypeVar("GraphNode", bound=Hashable)


def components(
    roots: Iterable[GraphNode], successors: Callable[[GraphNode], Iterable[GraphNode]]
) -> list[list[GraphNode]]:
    """Return the strongly connected components of the nodes that ``roots`` can reach.

    A component comes after all other components that it can reach.

    The algorithm is from R. Tarjan, "Depth-First Search and Linear Graph Algorithms", SIAM J.
    Comput. 1972.
    """
    index: dict[GraphNode, int] = {}
    low: dict[GraphNode, int] = {}
    on_stack: set[GraphNode] = set()
    stack: list[GraphNode] = []
    groups: list[list[GraphNode]] = []
    for root in roots:
        if root in index:
            continue
        work = [(root, iter(successors(root)))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on_stack.add(root)
        while work:
            node, left = work[-1]
            for target in left:
                if target not in index:
                    index[target] = low[target] = len(index)
                    stack.append(target)
                    on_stack.add(target)
                    work.append((target, iter(successors(target))))
                    break
                if target in on_stack:
                    low[node] = min(low[node], index[target])
            else:
                work.pop()
                if work:
                    above = work[-1][0]
                    low[above] = min(low[above], low[node])
                if low[node] == index[node]:
                    group = []
                    while True:
                        member = stack.pop()
                        on_stack.discard(member)
                        group.append(member)
                        if member == node:
                            break
                    group.reverse()
                    groups.append(group)
    return groups


def smallest_bottom(targets: Mapping[GraphNode, Sequence[GraphNode]], root: GraphNode) -> list[GraphNode]:
    """Return the smallest of the strongly connected components that ``root`` can reach and that no edge leaves.

    ``targets`` maps each node to its successors. If several are smallest, returns the first in the
    order of :func:`components`.
    """
    bottoms = []
    for group in components([root], targets.__getitem__):
        members = set(group)
        if all(target in members for node in group for target in targets[node]):
            bottoms.append(group)
    return min(bottoms, key=len)
