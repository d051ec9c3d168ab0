"""Find the ``exclusive`` groups that a comparison of two specs assumes.

These can be more groups than the specs themselves use.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tltlc.tools.diff.relation import ExclusiveGroup, different_atoms

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Vocabulary

Declared = tuple["Vocabulary | None", "Vocabulary | None"]
"""The atoms and ``exclusive`` groups that the files A and B declare, used or not.

An entry is None for an artefact, which does not have unused groups.
"""


def assumed(a: Fspa, b: Fspa, declared: Declared, *, by_name: bool = False) -> tuple[ExclusiveGroup, ...]:
    """Return the groups that two specs are compared with, whether or not the specs use them.

    If both files are sources, both must declare that atoms are exclusive. An artefact only has the
    groups of which its spec uses at least two atoms. For other groups, the source decides. Atoms
    that are different in A and B are in no group. ``by_name`` is as in
    :func:`~tltlc.tools.diff.relation.compare`.
    """
    in_a, in_b = declared
    if in_a is not None and in_b is not None:
        return tuple(_of_both(in_a, in_b, () if by_name else different_atoms(in_a, in_b)))
    if in_a is not None:
        return tuple(ExclusiveGroup(names, True, False) for names in _unknown(b, in_a, by_name=by_name))
    if in_b is not None:
        return tuple(ExclusiveGroup(names, False, True) for names in _unknown(a, in_b, by_name=by_name))
    return ()


def _of_both(in_a: Vocabulary, in_b: Vocabulary, different: tuple[str, ...]) -> Iterator[ExclusiveGroup]:
    for group_a in _groups(in_a):
        for group_b in _groups(in_b):
            names = tuple(name for name in group_a if name in group_b and name not in different)
            if len(names) > 1:
                yield ExclusiveGroup(names, True, True)


def _unknown(artefact: Fspa, source: Vocabulary, *, by_name: bool) -> Iterator[tuple[str, ...]]:
    """Yield the groups of a source that an artefact does not contradict.

    If the artefact used two atoms of a group, it would have the group itself.
    """
    known = {atom.name for atom in artefact.atoms}
    own = [set(group) for group in _groups(artefact)]
    different = () if by_name else different_atoms(artefact, source)
    for group in _groups(source):
        names = tuple(name for name in group if name not in different)
        used = known.intersection(names)
        if len(names) > 1 and (len(used) < 2 or any(used <= own_group for own_group in own)):
            yield names


def _groups(of: Fspa | Vocabulary) -> Iterator[tuple[str, ...]]:
    return (tuple(of.atoms[atom].name for atom in group) for group in of.exclusive)
