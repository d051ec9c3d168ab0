"""Exact comparison of automata, letter by letter: slow, obvious, and with no code of the construction."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product

import networkx as nx

from tltlc.automaton.infinite.automaton import Rabin

Letter = tuple[bool, ...]
Mark = tuple[str, int, str]
"""The automaton, ``"one"`` or ``"other"``, then the pair and ``fin`` or ``inf``."""
Edge = tuple[tuple[int, int], tuple[int, int], frozenset[Mark]]


def letters(atoms: int, exclusive: Iterable[Sequence[int]] = ()) -> list[Letter]:
    """Every letter that keeps the declarations."""
    every = product((False, True), repeat=atoms)
    return [each for each in every if all(sum(each[atom] for atom in group) <= 1 for group in exclusive)]


def equal(one: Rabin, other: Rabin, possible: Sequence[Letter]) -> bool:
    """Whether the languages are the same."""
    edges = _edges(one, other, possible)
    return not _differ(edges, one.pairs, other.pairs) and not _differ(_swapped(edges), other.pairs, one.pairs)


def opposite(one: Rabin, other: Rabin, possible: Sequence[Letter]) -> bool:
    """Whether each infinite word is accepted by exactly one of them."""
    edges = _edges(one, other, possible)
    both = any(
        _cycle(edges, {("one", p, "fin"), ("other", q, "fin")}, {("one", p, "inf"), ("other", q, "inf")}, [])
        for p, q in product(range(one.pairs), range(other.pairs))
    )
    pairs = [*(("one", p) for p in range(one.pairs)), *(("other", q) for q in range(other.pairs))]
    return not both and not _cycle(edges, set(), set(), pairs)


def _edges(one: Rabin, other: Rabin, possible: Sequence[Letter]) -> list[Edge]:
    """The edges of the product that can be reached."""
    found = set()
    queue, seen = [(0, 0)], {(0, 0)}
    for left, right in queue:
        for letter in possible:
            (p, said), (q, answered) = one.step(left, letter), other.step(right, letter)
            marks = {("one", *mark) for mark in said} | {("other", *mark) for mark in answered}
            found.add(((left, right), (p, q), frozenset(marks)))
            if (p, q) not in seen:
                seen.add((p, q))
                queue.append((p, q))
    return list(found)


def _swapped(edges: Sequence[Edge]) -> list[Edge]:
    name = {"one": "other", "other": "one"}
    return [(source, target, frozenset((name[m[0]], m[1], m[2]) for m in marks)) for source, target, marks in edges]


def _differ(edges: Sequence[Edge], one_pairs: int, other_pairs: int) -> bool:
    """Whether a cycle is accepted by the one and rejected by the other."""
    rejected = [("other", pair) for pair in range(other_pairs)]
    return any(_cycle(edges, {("one", p, "fin")}, {("one", p, "inf")}, rejected) for p in range(one_pairs))


def _cycle(edges: Sequence[Edge], without: set[Mark], needed: set[Mark], rejected: Sequence[tuple[str, int]]) -> bool:
    """Whether a cycle has none of the marks ``without``, all that are ``needed``, and of no pair ``inf`` but no
    ``fin``.
    """
    stack = [[edge for edge in edges if not edge[2] & without]]
    while stack:
        some = stack.pop()
        graph = nx.DiGraph((source, target) for source, target, _ in some)
        for group in nx.strongly_connected_components(graph):
            inside = [edge for edge in some if edge[0] in group and edge[1] in group]
            marks = frozenset().union(*(edge[2] for edge in inside))
            if not inside or not needed <= marks:
                continue
            met = {(*pair, "inf") for pair in rejected if (*pair, "inf") in marks and (*pair, "fin") not in marks}
            if not met:
                return True
            stack.append([edge for edge in inside if not edge[2] & met])
    return False
