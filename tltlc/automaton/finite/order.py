"""Find an order of the atoms that keeps diagrams small: atoms of the same subformula are next to each other.

The heuristic is FORCE (Aloul, Markov and Sakallah, "FORCE: a fast and easy-to-implement
variable-ordering heuristic", GLSVLSI 2003). A group is the set of atoms of a subformula; its width
is the distance between its first and its last atom. Each atom moves to the middle of its groups,
again and again, until the groups get no narrower.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from tltlc.automaton.fspa import Edge, Fspa, Guard, Implicant
from tltlc.core.record import replace
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Spec

_LARGEST_GROUP: Final = 8
"""The most atoms in a group.

Subformulas with more atoms say little about which atoms belong together.
"""
_MOST_ROUNDS: Final = 50
_Group = frozenset[int]


def better_order(formula: Formula, names: Sequence[str]) -> list[int] | None:
    """Return an order of the atoms in which atoms of the same subformula are closer together.

    The order is a list of indices into ``names``. The width of a subformula is the distance between
    its first and its last atom. The order at least halves the sum of all widths. Returns None if
    the heuristic finds no such order.
    """
    groups = _groups(formula, {name: index for index, name in enumerate(names)})
    best = order = list(range(len(names)))
    width = before = _width(order, groups)
    for _ in range(_MOST_ROUNDS):
        order = _move_to_middles(order, groups)
        if (moved_width := _width(order, groups)) >= width:
            break
        best, width = order, moved_width
    return best if 2 * width <= before and width < before else None


def reorder(spec: Spec, order: Sequence[int]) -> Spec:
    """Return the spec with its atoms in another order: atom ``order[0]`` comes first, then ``order[1]``, and so on."""
    place = {index: number for number, index in enumerate(order)}
    atoms = tuple(spec.atoms[index] for index in order)
    return replace(spec, atoms=atoms, exclusive=tuple(tuple(place[atom] for atom in group) for group in spec.exclusive))


def restore_order(fspa: Fspa, spec: Spec, order: Sequence[int]) -> Fspa:
    """Return the automaton of ``reorder(spec, order)`` with its atoms back in the order of ``spec``."""
    restored_guards: dict[Guard, Guard] = {}
    edges = []
    for edge in fspa.edges:
        if edge.guard not in restored_guards:
            restored_guards[edge.guard] = Guard(edge.guard.formula, _primes(edge.guard.primes, order))
        edges.append(Edge(edge.source, edge.target, restored_guards[edge.guard]))
    return replace(fspa, atoms=spec.atoms, exclusive=spec.exclusive, edges=tuple(edges))


def _primes(primes: Iterable[Implicant], order: Sequence[int]) -> tuple[Implicant, ...]:
    """Return the prime implicants with atom ``i`` replaced by ``order[i]``.

    Sorts them by length, then by atom, as :meth:`~tltlc.automaton.guards.Guards.primes` does.
    """
    renumbered = (tuple(sorted((order[atom], polarity) for atom, polarity in prime)) for prime in primes)
    return tuple(sorted(renumbered, key=lambda prime: (len(prime), [(atom, not polarity) for atom, polarity in prime])))


def _groups(formula: Formula, index: dict[str, int]) -> list[_Group]:
    """Return the set of atoms of each subformula that has 2 to :data:`_LARGEST_GROUP` atoms, without duplicates."""
    group_of: dict[Formula, _Group | None] = {}
    for node in formula.bottom_up(known=group_of):
        if node.op == "atom":
            group_of[node] = frozenset((index[node.name],))
            continue
        parts = [group_of[argument] for argument in node.args]
        joined = frozenset().union(*(part for part in parts if part is not None))
        group_of[node] = None if None in parts or len(joined) > _LARGEST_GROUP else joined
    groups = {group for group in group_of.values() if group and len(group) > 1}
    return sorted(groups, key=sorted)


def _width(order: Sequence[int], groups: Iterable[_Group]) -> int:
    """Return the sum, over all groups, of the distance between the group's first and last atom."""
    place = {index: number for number, index in enumerate(order)}
    return sum(max(places) - min(places) for group in groups for places in [[place[atom] for atom in group]])


def _move_to_middles(order: Sequence[int], groups: Iterable[_Group]) -> list[int]:
    """Return a new order, which moves each atom to the middle of its groups.

    The middle of a group is the mean position of its atoms. An atom in several groups moves to the
    mean of their middles.
    """
    place = {index: number for number, index in enumerate(order)}
    middles: dict[int, list[float]] = {index: [] for index in order}
    for group in groups:
        middle = sum(place[atom] for atom in group) / len(group)
        for atom in group:
            middles[atom].append(middle)
    mean = {index: sum(values) / len(values) if values else place[index] for index, values in middles.items()}
    return sorted(order, key=lambda index: (mean[index], index))
