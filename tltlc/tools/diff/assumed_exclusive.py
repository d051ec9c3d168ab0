"""Find the ``exclusive`` groups that a comparison of two specs assumes.

A group is a set of atoms of which at most one holds at a time. A comparison may also assume groups
that the files declare, but the specs themselves do not use.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tltlc.tools.diff.relation import ExclusiveGroup, different_atoms

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Vocabulary

DeclaredGroups = tuple["Vocabulary | None", "Vocabulary | None"]
"""The atoms and ``exclusive`` groups that the files A and B declare, whether or not a spec uses them.

The entry of an artefact is None, because an artefact stores only the groups that its spec uses.
"""


def assumed_groups(a: Fspa, b: Fspa, declared: DeclaredGroups, *, by_name: bool = False) -> tuple[ExclusiveGroup, ...]:
    """Return the groups that the comparison of specs A and B assumes, besides the groups of the specs themselves.

    Each file is a source text or an artefact (a compiled spec).

    - If both are sources, these are the groups that both declare: the atoms that a group of A and a
      group of B have in common, if there are at least two.
    - If one is an artefact, these are the groups of the source that the artefact does not
      contradict. An artefact stores a group only if its spec uses at least two of the atoms.
    - If both are artefacts, there are none.

    A group has no atoms whose name has different meanings in A and B. With ``by_name``, atoms with
    the same name always count as the same atom.
    """
    in_a, in_b = declared
    if in_a is not None and in_b is not None:
        return tuple(_common_groups(in_a, in_b, () if by_name else different_atoms(in_a, in_b)))
    if in_a is not None:
        return tuple(ExclusiveGroup(names, True, False) for names in _uncontradicted_groups(b, in_a, by_name=by_name))
    if in_b is not None:
        return tuple(ExclusiveGroup(names, False, True) for names in _uncontradicted_groups(a, in_b, by_name=by_name))
    return ()


def _common_groups(in_a: Vocabulary, in_b: Vocabulary, different: tuple[str, ...]) -> Iterator[ExclusiveGroup]:
    for group_a in _groups(in_a):
        for group_b in _groups(in_b):
            names = tuple(name for name in group_a if name in group_b and name not in different)
            if len(names) > 1:
                yield ExclusiveGroup(names, True, True)


def _uncontradicted_groups(artefact: Fspa, source: Vocabulary, *, by_name: bool) -> Iterator[tuple[str, ...]]:
    """Yield the groups of a source that an artefact does not contradict, as names of atoms.

    An artefact contradicts a group if it uses two atoms of the group, but does not declare them
    exclusive.
    """
    atoms = {atom.name for atom in artefact.atoms}
    own_groups = [set(group) for group in _groups(artefact)]
    different = () if by_name else different_atoms(artefact, source)
    for group in _groups(source):
        names = tuple(name for name in group if name not in different)
        used = atoms.intersection(names)
        if len(names) > 1 and (len(used) < 2 or any(used <= own_group for own_group in own_groups)):
            yield names


def _groups(vocabulary: Fspa | Vocabulary) -> Iterator[tuple[str, ...]]:
    return (tuple(vocabulary.atoms[atom].name for atom in group) for group in vocabulary.exclusive)
