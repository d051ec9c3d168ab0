"""Compare automata exactly, letter by letter: slow, simple, and independent of the construction."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product

import networkx as nx

from tltlc.automaton.infinite.automaton import Rabin

Letter = tuple[bool, ...]
Mark = tuple[str, int, str]
"""The automaton (``"one"`` or ``"other"``), the pair, and ``fin`` or ``inf``."""
Edge = tuple[tuple[int, int], tuple[int, int], frozenset[Mark]]


def letters(atoms: int, exclusive: Iterable[Sequence[int]] = ()) -> list[Letter]:
    """Return every letter in which at most one atom of each exclusive group is true."""
    candidates = product((False, True), repeat=atoms)
    return [letter for letter in candidates if all(sum(letter[atom] for atom in group) <= 1 for group in exclusive)]


def equal(one: Rabin, other: Rabin, possible: Sequence[Letter]) -> bool:
    """Whether the languages are the same."""
    edges = _edges(one, other, possible)
    return not _differ(edges, one.pairs, other.pairs) and not _differ(_swapped(edges), other.pairs, one.pairs)


def opposite(one: Rabin, other: Rabin, possible: Sequence[Letter]) -> bool:
    """Whether exactly one of the automata accepts each infinite word."""
    edges = _edges(one, other, possible)
    both = any(
        _cycle(edges, {("one", p, "fin"), ("other", q, "fin")}, {("one", p, "inf"), ("other", q, "inf")}, [])
        for p, q in product(range(one.pairs), range(other.pairs))
    )
    pairs = [*(("one", p) for p in range(one.pairs)), *(("other", q) for q in range(other.pairs))]
    return not both and not _cycle(edges, set(), set(), pairs)


def _edges(one: Rabin, other: Rabin, possible: Sequence[Letter]) -> list[Edge]:
    """Return the reachable edges of the product."""
    edges = set()
    queue, seen = [(0, 0)], {(0, 0)}
    for left, right in queue:
        for letter in possible:
            (p, one_marks), (q, other_marks) = one.step(left, letter), other.step(right, letter)
            marks = {("one", *mark) for mark in one_marks} | {("other", *mark) for mark in other_marks}
            edges.add(((left, right), (p, q), frozenset(marks)))
            if (p, q) not in seen:
                seen.add((p, q))
                queue.append((p, q))
    return list(edges)


def _swapped(edges: Sequence[Edge]) -> list[Edge]:
    name = {"one": "other", "other": "one"}
    return [(source, target, frozenset((name[m[0]], m[1], m[2]) for m in marks)) for source, target, marks in edges]


def _differ(edges: Sequence[Edge], one_pairs: int, other_pairs: int) -> bool:
    """Whether the first automaton accepts a cycle that the second one rejects."""
    rejected = [("other", pair) for pair in range(other_pairs)]
    return any(_cycle(edges, {("one", p, "fin")}, {("one", p, "inf")}, rejected) for p in range(one_pairs))


def _cycle(edges: Sequence[Edge], without: set[Mark], needed: set[Mark], rejected: Sequence[tuple[str, int]]) -> bool:
    """Whether a cycle has no mark of ``without``, every mark of ``needed``, and satisfies no pair of ``rejected``.

    A cycle satisfies a pair if it has the pair's ``inf`` mark and not its ``fin`` mark.
    """
    stack = [[edge for edge in edges if not edge[2] & without]]
    while stack:
        remaining = stack.pop()
        graph = nx.DiGraph((source, target) for source, target, _ in remaining)
        for group in nx.strongly_connected_components(graph):
            inside = [edge for edge in remaining if edge[0] in group and edge[1] in group]
            marks = frozenset().union(*(edge[2] for edge in inside))
            if not inside or not needed <= marks:
                continue
            satisfied = {(*pair, "inf") for pair in rejected if (*pair, "inf") in marks and (*pair, "fin") not in marks}
            if not satisfied:
                return True
            stack.append([edge for edge in inside if not edge[2] & satisfied])
    return False
