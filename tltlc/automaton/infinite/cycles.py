"""The alternating cycle decomposition: which sets of edges that a run may take for ever are accepted.

A. Casares, T. Colcombet, N. Fijalkow, "Optimal Transformations of Games and Automata Using Muller Conditions" (ICALP
2021).  A node is a strongly connected set of edges; below it stand the greatest ones inside that are accepted where it
is not, or rejected where it is accepted.  A run is accepted if the lowest node that has all edges that it takes for
ever is.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Final

from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.mark_conditions import Clause, Marks
from tltlc.automaton.infinite.work import Work
from tltlc.core.record import record

Edge = tuple[Any, Any, Marks]
"""From a state, which is anything that can be hashed, to another one, with marks."""

Edges = frozenset[Edge]

LOOKS_PER_STEP: Final = 16
"""How many edges are looked at in a step of work, where that is all that is done with them."""


@record
class Node:
    """A node; its ``index`` counts all nodes of a tree, ``states`` are those that its edges touch."""

    index: int
    edges: Edges
    states: frozenset[Any]
    accepted: bool
    below: tuple[Node, ...]


def decomposition(edges: Iterable[Edge], clauses: Sequence[Clause], work: Work) -> Node:
    """The tree of a strongly connected set of edges, children in the order of their edges.

    Here and below, work is counted by the edges that are looked at; raises
    :class:`~tltlc.automaton.infinite.work.OutOfWork`.
    """
    order = {edge: place for place, edge in enumerate(edges)}
    count = 0

    def node(some: Edges) -> Node:
        nonlocal count
        index, count = count, count + 1
        accepted = _accepts(some, clauses, work)
        inside = (rejecting_parts if accepted else accepting_parts)(some, clauses, work)
        greatest = _greatest(inside, work)
        greatest = sorted(greatest, key=lambda each: sorted(map(order.__getitem__, each)))
        below = tuple(node(each) for each in greatest)
        states = frozenset(state for source, target, _ in some for state in (source, target))
        return Node(index, some, states, accepted, below)

    return node(frozenset(order))


def _greatest(sets: Sequence[Edges], work: Work) -> list[Edges]:
    """The sets that lie in no other one, each once."""
    distinct = sorted(dict.fromkeys(sets), key=len, reverse=True)
    found: list[Edges] = []
    for some in distinct:
        work.spend(1 + len(found) // LOOKS_PER_STEP)
        if not any(some < other for other in found):
            found.append(some)
    return found


def _accepts(edges: Edges, clauses: Sequence[Clause], work: Work) -> bool:
    work.spend((len(edges) + len(clauses)) // LOOKS_PER_STEP)
    marks = marks_of(edges)
    return any(clause.accepts(marks) for clause in clauses)


def marks_of(edges: Iterable[Edge]) -> Marks:
    """All marks of the edges."""
    return frozenset().union(*(edge[2] for edge in edges))


def accepting_parts(edges: Edges, clauses: Sequence[Clause], work: Work) -> list[Edges]:
    """The accepted sets inside that are greatest for a clause."""
    work.spend(len(edges) * len(clauses) // LOOKS_PER_STEP)
    return [
        part
        for clause in clauses
        for part in parts((edge for edge in edges if not edge[2] & clause.fins), work)
        if clause.infs <= marks_of(part)
    ]


def rejecting_parts(edges: Edges, clauses: Sequence[Clause], work: Work) -> list[Edges]:
    """Rejected sets inside, among them the greatest ones."""
    found: dict[Edges, None] = {}
    seen: set[Edges] = set()
    stack = [edges]
    while stack:
        some = stack.pop()
        if some in seen:
            continue
        seen.add(some)
        work.spend((len(some) + len(clauses)) // LOOKS_PER_STEP)
        marks = marks_of(some)
        met = next((clause for clause in clauses if clause.accepts(marks)), None)
        if met is None:
            found[some] = None
            continue
        for mark in met.infs:
            work.spend(len(some) // LOOKS_PER_STEP)
            stack += parts((edge for edge in some if mark not in edge[2]), work)
    return list(found)


def parts(edges: Iterable[Edge], work: Work) -> list[Edges]:
    """The greatest strongly connected sets of edges."""
    leaving: dict[Any, list[Edge]] = {}
    for edge in edges:
        leaving.setdefault(edge[0], []).append(edge)
        work.spend()
    groups = components(list(leaving), lambda state: (edge[1] for edge in leaving.get(state, ())))
    found = []
    for group in groups:
        members = set(group)
        inside = frozenset(edge for state in group for edge in leaving.get(state, ()) if edge[1] in members)
        if inside:
            found.append(inside)
    return found
