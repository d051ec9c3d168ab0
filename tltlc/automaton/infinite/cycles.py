"""The alternating cycle decomposition: a tree of sets of edges, each accepted or rejected.

It is from A. Casares, T. Colcombet, N. Fijalkow, "Optimal Transformations of Games and Automata
Using Muller Conditions" (ICALP 2021). A set of edges is accepted if a run that takes exactly these
edges infinitely often is accepted. A node is a strongly connected set of edges. The children of an
accepted node are its maximal rejected subsets; the children of a rejected node are its maximal
accepted subsets. To judge a run, take the edges that the run takes infinitely often, and find a
node that contains all of them but has no child that contains all of them. The run is accepted if
this node is accepted.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Final

from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.mark_conditions import MarkClause, Marks
from tltlc.automaton.work import Work
from tltlc.core.record import record

MarkedEdge = tuple[Any, Any, Marks]
"""The source, the target and the marks of an edge; a state is any hashable value."""

MarkedEdges = frozenset[MarkedEdge]

LOOKS_PER_STEP: Final = 16
"""How many edges a function may look at for one step of work."""


@record
class CycleNode:
    """A node of an alternating cycle decomposition: a strongly connected set of edges, accepted or rejected.

    ``index`` is the number of the node in its tree, from 0. ``states`` are the sources and targets
    of ``edges``. ``children`` are maximal subsets that are judged the other way: rejected if this
    node is accepted, and accepted if it is rejected.
    """

    index: int
    edges: MarkedEdges
    states: frozenset[Any]
    accepted: bool
    children: tuple[CycleNode, ...]


def decomposition(edges: Iterable[MarkedEdge], clauses: Sequence[MarkClause], work: Work) -> CycleNode:
    """Return the root of the alternating cycle decomposition of a strongly connected set of edges.

    A set of edges is accepted if one of ``clauses`` accepts the marks of its edges. Children are
    sorted by the position of their first edge in ``edges``. Takes steps of ``work`` for the edges
    that it visits, and raises :class:`~tltlc.automaton.work.OutOfWork` if no steps are left.
    """
    order = {edge: place for place, edge in enumerate(edges)}
    count = 0

    def node(members: MarkedEdges) -> CycleNode:
        nonlocal count
        index, count = count, count + 1
        accepted = _accepts(members, clauses, work)
        inside = (rejecting_parts if accepted else accepting_parts)(members, clauses, work)
        maximal = _maximal(inside, work)
        maximal = sorted(maximal, key=lambda part: sorted(map(order.__getitem__, part)))
        children = tuple(node(part) for part in maximal)
        states = frozenset(state for source, target, _ in members for state in (source, target))
        return CycleNode(index, members, states, accepted, children)

    return node(frozenset(order))


def _maximal(sets: Sequence[MarkedEdges], work: Work) -> list[MarkedEdges]:
    """Return the sets that are not a subset of another set, without duplicates."""
    distinct = sorted(dict.fromkeys(sets), key=len, reverse=True)
    maximal: list[MarkedEdges] = []
    for candidate in distinct:
        work.spend(1 + len(maximal) // LOOKS_PER_STEP)
        if not any(candidate < other for other in maximal):
            maximal.append(candidate)
    return maximal


def _accepts(edges: MarkedEdges, clauses: Sequence[MarkClause], work: Work) -> bool:
    work.spend((len(edges) + len(clauses)) // LOOKS_PER_STEP)
    marks = marks_of(edges)
    return any(clause.accepts(marks) for clause in clauses)


def marks_of(edges: Iterable[MarkedEdge]) -> Marks:
    """Return the union of the marks of the edges."""
    return frozenset().union(*(edge[2] for edge in edges))


def accepting_parts(edges: MarkedEdges, clauses: Sequence[MarkClause], work: Work) -> list[MarkedEdges]:
    """Return, in one list, the maximal strongly connected subsets of ``edges`` that each clause accepts.

    A clause accepts a set if it accepts the marks of all its edges together.
    """
    work.spend(len(edges) * len(clauses) // LOOKS_PER_STEP)
    return [
        part
        for clause in clauses
        for part in parts((edge for edge in edges if not edge[2] & clause.fins), work)
        if clause.infs <= marks_of(part)
    ]


def rejecting_parts(edges: MarkedEdges, clauses: Sequence[MarkClause], work: Work) -> list[MarkedEdges]:
    """Return strongly connected subsets of ``edges`` that no clause accepts.

    The result has all maximal subsets, and possibly smaller ones. ``edges`` must be strongly
    connected.
    """
    rejected: dict[MarkedEdges, None] = {}
    seen: set[MarkedEdges] = set()
    stack = [edges]
    while stack:
        part = stack.pop()
        if part in seen:
            continue
        seen.add(part)
        work.spend((len(part) + len(clauses)) // LOOKS_PER_STEP)
        marks = marks_of(part)
        accepting = next((clause for clause in clauses if clause.accepts(marks)), None)
        if accepting is None:
            rejected[part] = None
            continue
        for mark in accepting.infs:
            work.spend(len(part) // LOOKS_PER_STEP)
            stack += parts((edge for edge in part if mark not in edge[2]), work)
    return list(rejected)


def parts(edges: Iterable[MarkedEdge], work: Work) -> list[MarkedEdges]:
    """Return the maximal strongly connected subsets of ``edges``, without empty sets."""
    leaving: dict[Any, list[MarkedEdge]] = {}
    for edge in edges:
        leaving.setdefault(edge[0], []).append(edge)
        work.spend()
    groups = components(list(leaving), lambda state: (edge[1] for edge in leaving.get(state, ())))
    maximal = []
    for group in groups:
        members = set(group)
        inside = frozenset(edge for state in group for edge in leaving.get(state, ()) if edge[1] in members)
        if inside:
            maximal.append(inside)
    return maximal
