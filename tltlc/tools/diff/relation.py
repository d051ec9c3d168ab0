"""How the traces that two specs accept relate, with shortest traces that tell them apart."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations, islice
from typing import TYPE_CHECKING, Final, Literal

from tltlc.automaton.compare import Literals, Trace, separating
from tltlc.automaton.infinite.work import DEFAULT_WORK, OutOfWork
from tltlc.core.record import record, replace
from tltlc.tools.diff.values import apart, meaning

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Vocabulary

Relation = Literal["equivalent", "stricter", "looser", "incomparable"]

_STEPS_OF_A_PAIR: Final = 100
"""Steps of work that a pair of atoms takes at least of which one excludes the other."""

OF_A: Final = " of A"
OF_B: Final = " of B"
"""What stands behind the names of two atoms that share theirs."""


@record
class Group:
    """Atoms of which at most one holds at a time, and which of the two say so."""

    names: tuple[str, ...]
    in_a: bool
    in_b: bool


@record
class Comparison:
    """What became of A in B.  ``stricter``: every trace that B accepts A accepts, too, and not the other way round.

    ``only_a`` is a trace that A alone accepts, ``only_b`` one that B alone accepts, over finite traces shortest ones.
    The names in ``split`` stand for two atoms, which are called ``NAME of A`` and ``NAME of B`` in traces.
    ``impossible`` are literals that no sample was found to make true together: traces with such samples are left out,
    and so are those with samples at which two atoms of a group of ``exclusive`` hold.
    ``relation`` is None where one is over finite traces and the other over infinite ones.  Then ``beginnings`` compares
    the beginnings of traces that do not break them for good, each as if it accepted these.
    """

    relation: Relation | None
    only_a: Trace | None = None
    only_b: Trace | None = None
    split: tuple[str, ...] = ()
    impossible: tuple[Literals, ...] = ()
    exclusive: tuple[Group, ...] = ()
    beginnings: Comparison | None = None


def compare(
    a: Fspa,
    b: Fspa,
    *,
    by_name: bool = False,
    real: bool = False,
    work: int = DEFAULT_WORK,
    exclusive: Iterable[Group] = (),
) -> Comparison:
    """How the traces that B accepts relate to those that A does, over the atoms of both.

    Atoms of one name are one if their expressions are equal, and no sample in the ranges of both was found at which
    only one of them holds, by other params; with ``by_name``, always.  With ``real``, traces count only if samples were
    found that are such: ``fuel > 30`` does not hold without ``fuel > 20``.  ``exclusive`` are groups beside those that
    the automata have.

    Raises:
        OutOfWork: the comparison takes more than ``work`` steps, each way.
    """
    if a.semantics != b.semantics:
        one, other = _unbroken(a), _unbroken(b)
        found = compare(one, other, by_name=by_name, real=real, work=work, exclusive=exclusive)
        return replace(found, relation=None, only_a=None, only_b=None, beginnings=found)
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
        from tltlc.tools.diff.feasible_letters import Reality

        reality = Reality(one, other, never)
        only_a, only_b = reality.real(only_a, one, other, work), reality.real(only_b, other, one, work)
        impossible = reality.impossible
    relation: Relation = (
        ("equivalent" if only_b is None else "looser")
        if only_a is None
        else ("stricter" if only_b is None else "incomparable")
    )
    return Comparison(relation, only_a, only_b, split, tuple(impossible), groups)


def _unbroken(fspa: Fspa) -> Fspa:
    """An automaton over finite traces that accepts what does not break another one for good."""
    states = tuple(replace(state, accepting=state.verdict != "violated") for state in fspa.states)
    return replace(fspa, semantics="finite", acceptance=(), states=states)


def _own_groups(one: Fspa, other: Fspa) -> list[Group]:
    """The groups that the automata have."""
    return [
        Group(tuple(fspa.atoms[atom].name for atom in group), fspa is one, fspa is other)
        for fspa in (one, other)
        for group in fspa.exclusive
    ]


def _together(groups: Iterable[Group], known: set[str]) -> tuple[Group, ...]:
    """The groups as far as their atoms are known, each once; one that is split is called otherwise, and not known."""
    of_known = [replace(group, names=tuple(name for name in group.names if name in known)) for group in groups]
    found: dict[frozenset[str], Group] = {}
    for group in of_known:
        wider = [each for each in of_known if set(group.names) <= set(each.names)]
        in_a, in_b = any(each.in_a for each in wider), any(each.in_b for each in wider)
        if len(group.names) > 1:
            found.setdefault(frozenset(group.names), Group(group.names, in_a, in_b))
    return tuple(found.values())


def _never(groups: Iterable[Group], own: Iterable[Group]) -> Iterator[Literals]:
    """The pairs of atoms in groups that the automata do not have themselves."""
    known = [set(group.names) for group in own]
    for group in groups:
        if not any(each.issuperset(group.names) for each in known):
            yield from (((first, True), (second, True)) for first, second in combinations(group.names, 2))


def different_atoms(a: Fspa | Vocabulary, b: Fspa | Vocabulary) -> tuple[str, ...]:
    """The names that stand for different atoms in two automata or vocabularies, in the order of A."""
    places = {atom.name: index for index, atom in enumerate(b.atoms)}
    found = []
    for index, atom in enumerate(a.atoms):
        if atom.name not in places:
            continue
        one, other = meaning(a, index), meaning(b, places[atom.name])
        if one.expression != other.expression or ((sample := apart(one, other)) and sample.is_judged_otherwise):
            found.append(atom.name)
    return tuple(found)


def _renamed(fspa: Fspa, names: tuple[str, ...], ending: str) -> Fspa:
    if not names:
        return fspa
    atoms = tuple(replace(atom, name=atom.name + ending) if atom.name in names else atom for atom in fspa.atoms)
    return replace(fspa, atoms=atoms)
