"""Which atoms of two specs are taken never to hold together, beside those of which the specs themselves say so."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tltlc.tools.diff.relation import Group, different_atoms

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Vocabulary

Declared = tuple["Vocabulary | None", "Vocabulary | None"]
"""Of the files A and B the atoms and groups of ``exclusive``, used or not; None of an artefact, which does not say."""


def assumed(a: Fspa, b: Fspa, declared: Declared, *, by_name: bool = False) -> tuple[Group, ...]:
    """The groups by which two specs are compared, whatever these use of them.

    Of two sources both have to declare that atoms are exclusive.  An artefact has the groups of which its spec uses two
    atoms, and does not know the others: there the source decides.  Atoms that are others in B than in A are in no
    group; ``by_name`` as of :func:`~tltlc.tools.diff.relation.compare`.
    """
    in_a, in_b = declared
    if in_a is not None and in_b is not None:
        return tuple(_of_both(in_a, in_b, () if by_name else different_atoms(in_a, in_b)))
    if in_a is not None:
        return tuple(Group(names, True, False) for names in _unknown(b, in_a, by_name=by_name))
    if in_b is not None:
        return tuple(Group(names, False, True) for names in _unknown(a, in_b, by_name=by_name))
    return ()


def _of_both(in_a: Vocabulary, in_b: Vocabulary, others: tuple[str, ...]) -> Iterator[Group]:
    for one in _groups(in_a):
        for other in _groups(in_b):
            names = tuple(name for name in one if name in other and name not in others)
            if len(names) > 1:
                yield Group(names, True, True)


def _unknown(artefact: Fspa, source: Vocabulary, *, by_name: bool) -> Iterator[tuple[str, ...]]:
    """The groups of a source that an artefact does not rule out: one of which it uses two atoms it would have."""
    known = {atom.name for atom in artefact.atoms}
    own = [set(group) for group in _groups(artefact)]
    others = () if by_name else different_atoms(artefact, source)
    for group in _groups(source):
        names = tuple(name for name in group if name not in others)
        used = known.intersection(names)
        if len(names) > 1 and (len(used) < 2 or any(used <= each for each in own)):
            yield names


def _groups(of: Fspa | Vocabulary) -> Iterator[tuple[str, ...]]:
    return (tuple(of.atoms[atom].name for atom in group) for group in of.exclusive)
