"""Compare the traces that two specs accept, with shortest traces that distinguish them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations, islice
from typing import TYPE_CHECKING, Final, Literal

from tltlc.automaton.compare import Literals, Trace, separating
from tltlc.automaton.work import DEFAULT_WORK, OutOfWork
from tltlc.core.record import record, replace
from tltlc.tools.diff.values import apart, meaning

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Vocabulary

Relation = Literal["equivalent", "stricter", "looser", "incomparable"]

_STEPS_OF_A_PAIR: Final = 100
"""The least number of work steps for a pair of atoms that exclude each other."""

OF_A: Final = " of A"
OF_B: Final = " of B"
"""Suffixes for two different atoms that have the same name."""


@record
class ExclusiveGroup:
    """Atoms of which at most one holds at a time, and which of the two specs declare this."""

    names: tuple[str, ...]
    in_a: bool
    in_b: bool


@record
class Comparison:
    """How B relates to A.

    ``stricter`` means that A accepts every trace that B accepts, but not vice versa. ``only_a`` is
    a trace that only A accepts, ``only_b`` one that only B accepts. Over finite traces they are
    shortest. Each name in ``split`` stands for two atoms, called ``NAME of A`` and ``NAME of B`` in
    traces. ``impossible`` are literals for which no sample was found that makes them true together.
    Traces with such samples are left out, and so are traces in which two atoms of an ``exclusive``
    group hold together.

    ``relation`` is None if one spec is over finite traces and the other over infinite ones. Then
    ``beginnings`` compares the finite beginnings that do not break A or B for good, as if each spec
    accepted its own.
    """

    relation: Relation | None
    only_a: Trace | None = None
    only_b: Trace | None = None
    split: tuple[str, ...] = ()
    impossible: tuple[Literals, ...] = ()
    exclusive: tuple[ExclusiveGroup, ...] = ()
    beginnings: Comparison | None = None


def compare(
    a: Fspa,
    b: Fspa,
    *,
    by_name: bool = False,
    real: bool = False,
    work: int = DEFAULT_WORK,
    exclusive: Iterable[ExclusiveGroup] = (),
) -> Comparison:
    """Return how the traces that B accepts relate to the traces that A accepts.

    Traces are over the atoms of both. Atoms with the same name are the same atom if their
    expressions are equal, and no sample in the ranges of both was found at which only one of them
    holds because of different params. With ``by_name``, they are always the same atom. With
    ``real``, traces count only if samples were found for them: ``fuel > 30`` does not hold without
    ``fuel > 20``. ``exclusive`` are groups in addition to the groups of the automata.

    Raises:
        OutOfWork: the comparison takes more than ``work`` steps in one direction.
    """
    if a.semantics != b.semantics:
        one, other = _unbroken(a), _unbroken(b)
        beginnings = compare(one, other, by_name=by_name, real=real, work=work, exclusive=exclusive)
        return replace(beginnings, relation=None, only_a=None, only_b=None, beginnings=beginnings)
    split = () if by_name else different_atoms(a, b)
    one, other = _renamed(a, split, OF_A), _renamed(b, split, OF_B)
    own = _own_groups(one, other)
    groups = _together((*own, *exclusive), {atom.name for fspa in (one, other) for atom in fspa.atoms})
    never = tuple(islice(_never(groups, own), work // _STEPS_OF_A_PAIR + 1))
    if len(never) > work // _STEPS_OF_A_PAIR:
        raise OutOfWork
    only_a, only_b = separating(one, other, work, never), separating(other, one, work, never)
    impossible: dict[Literals, None] = {}
    if real and (only_a or only_b):
        from tltlc.tools.diff.feasible_letters import FeasibleLetters

        reality = FeasibleLetters(one, other, never)
        only_a, only_b = reality.real(only_a, one, other, work), reality.real(only_b, other, one, work)
        impossible = reality.impossible
    relation: Relation = (
        ("equivalent" if only_b is None else "looser")
        if only_a is None
        else ("stricter" if only_b is None else "incomparable")
    )
    return Comparison(relation, only_a, only_b, split, tuple(impossible), groups)


def _unbroken(fspa: Fspa) -> Fspa:
    """Return an automaton over finite traces that accepts what does not break ``fspa`` for good."""
    states = tuple(replace(state, accepting=state.verdict != "violated") for state in fspa.states)
    return replace(fspa, semantics="finite", acceptance=(), states=states)


def _own_groups(one: Fspa, other: Fspa) -> list[ExclusiveGroup]:
    """Return the groups of the automata."""
    return [
        ExclusiveGroup(tuple(fspa.atoms[atom].name for atom in group), fspa is one, fspa is other)
        for fspa in (one, other)
        for group in fspa.exclusive
    ]


def _together(groups: Iterable[ExclusiveGroup], known: set[str]) -> tuple[ExclusiveGroup, ...]:
    """Return the groups restricted to known atoms, without duplicates.

    A split atom has another name and so is not known.
    """
    of_known = [replace(group, names=tuple(name for name in group.names if name in known)) for group in groups]
    merged: dict[frozenset[str], ExclusiveGroup] = {}
    for group in of_known:
        wider = [wide for wide in of_known if set(group.names) <= set(wide.names)]
        in_a, in_b = any(wide.in_a for wide in wider), any(wide.in_b for wide in wider)
        if len(group.names) > 1:
            merged.setdefault(frozenset(group.names), ExclusiveGroup(group.names, in_a, in_b))
    return tuple(merged.values())


def _never(groups: Iterable[ExclusiveGroup], own: Iterable[ExclusiveGroup]) -> Iterator[Literals]:
    """Yield the pairs of atoms in groups that the automata do not have themselves."""
    known = [set(group.names) for group in own]
    for group in groups:
        if not any(known_group.issuperset(group.names) for known_group in known):
            yield from (((first, True), (second, True)) for first, second in combinations(group.names, 2))


def different_atoms(a: Fspa | Vocabulary, b: Fspa | Vocabulary) -> tuple[str, ...]:
    """Return the names that stand for different atoms in ``a`` and ``b``, in the order of ``a``."""
    places = {atom.name: index for index, atom in enumerate(b.atoms)}
    names = []
    for index, atom in enumerate(a.atoms):
        if atom.name not in places:
            continue
        one, other = meaning(a, index), meaning(b, places[atom.name])
        if one.expression != other.expression or ((sample := apart(one, other)) and sample.is_judged_otherwise):
            names.append(atom.name)
    return tuple(names)


def _renamed(fspa: Fspa, names: tuple[str, ...], ending: str) -> Fspa:
    if not names:
        return fspa
    atoms = [
        replace(atom, base=atom.name + ending, arguments=()) if atom.name in names else atom for atom in fspa.atoms
    ]
    return replace(fspa, atoms=tuple(atoms))
