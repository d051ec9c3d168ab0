"""An order of atoms in which diagrams stay small: atoms that a formula reads together lie side by side.

By the heuristic of Aloul, Markov and Sakallah, FORCE: a fast and easy-to-implement variable-ordering heuristic, GLSVLSI
2003: each atom moves to the middle of the groups that it is in, until that helps no more.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from tltlc.automaton.fspa import Edge, Fspa, Guard, Implicant
from tltlc.core.record import replace
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Spec

_LARGEST_GROUP: Final = 8
"""Atoms; larger groups say little about which of their atoms belong together."""
_MOST_ROUNDS: Final = 50
_Group = frozenset[int]


def better_order(formula: Formula, names: Sequence[str]) -> list[int] | None:
    """The atoms, by index, in an order whose groups are at most half as wide; None where none is found."""
    groups = _groups(formula, {name: index for index, name in enumerate(names)})
    best = order = list(range(len(names)))
    width = before = _width(order, groups)
    for _ in range(_MOST_ROUNDS):
        order = _moved(order, groups)
        if (found := _width(order, groups)) >= width:
            break
        best, width = order, found
    return best if 2 * width <= before and width < before else None


def reordered(spec: Spec, order: Sequence[int]) -> Spec:
    """The same spec with its atoms in another order."""
    place = {index: number for number, index in enumerate(order)}
    atoms = tuple(spec.atoms[index] for index in order)
    return replace(spec, atoms=atoms, exclusive=tuple(tuple(place[each] for each in group) for group in spec.exclusive))


def restored(fspa: Fspa, spec: Spec, order: Sequence[int]) -> Fspa:
    """The automaton of a spec that was reordered, with the atoms in the order of ``spec``."""
    made: dict[Guard, Guard] = {}
    edges = []
    for edge in fspa.edges:
        if edge.guard not in made:
            made[edge.guard] = Guard(edge.guard.text, _primes(edge.guard.primes, order))
        edges.append(Edge(edge.source, edge.target, made[edge.guard]))
    return replace(fspa, atoms=spec.atoms, exclusive=spec.exclusive, edges=tuple(edges))


def _primes(primes: Iterable[Implicant], order: Sequence[int]) -> tuple[Implicant, ...]:
    """The prime implicants with other indices of atoms, in the order of :meth:`Guards.primes`."""
    found = (tuple(sorted((order[atom], polarity) for atom, polarity in prime)) for prime in primes)
    return tuple(sorted(found, key=lambda prime: (len(prime), [(atom, not polarity) for atom, polarity in prime])))


def _groups(formula: Formula, index: dict[str, int]) -> list[_Group]:
    """The sets of atoms of the subformulas that have a few of them."""
    own: dict[Formula, _Group | None] = {}
    for node in formula.bottom_up(known=own):
        if node.op == "atom":
            own[node] = frozenset((index[node.name],))
            continue
        parts = [own[each] for each in node.args]
        joined = frozenset().union(*(part for part in parts if part is not None))
        own[node] = None if None in parts or len(joined) > _LARGEST_GROUP else joined
    found = {group for group in own.values() if group and len(group) > 1}
    return sorted(found, key=sorted)


def _width(order: Sequence[int], groups: Iterable[_Group]) -> int:
    """How far the first and the last atom of each group are apart, in all."""
    place = {index: number for number, index in enumerate(order)}
    return sum(max(places) - min(places) for group in groups for places in [[place[each] for each in group]])


def _moved(order: Sequence[int], groups: Iterable[_Group]) -> list[int]:
    """The order in which each atom lies where the middles of its groups were."""
    place = {index: number for number, index in enumerate(order)}
    middles: dict[int, list[float]] = {index: [] for index in order}
    for group in groups:
        middle = sum(place[each] for each in group) / len(group)
        for each in group:
            middles[each].append(middle)
    wanted = {index: sum(own) / len(own) if own else place[index] for index, own in middles.items()}
    return sorted(order, key=lambda index: (wanted[index], index))
