"""How the traces that two specs accept relate, with shortest traces that tell them apart."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from itertools import combinations
from typing import TYPE_CHECKING, Final, Literal

from tltlc.comparison import Literals, Trace, separating
from tltlc.diff.values import apart, meaning
from tltlc.rabin.work import DEFAULT_WORK
from tltlc.record import record, replace

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa

Relation = Literal["equivalent", "stricter", "looser", "incomparable"]

OF_A: Final = " of A"
OF_B: Final = " of B"
"""What stands behind the names of two atoms that share theirs."""


@record
class Comparison:
    """What became of A in B.  ``stricter``: every trace that B accepts A accepts, too, and not the other way round.

    ``only_a`` is a trace that A alone accepts, ``only_b`` one that B alone accepts, over finite traces shortest ones.
    The names in ``split`` stand for two atoms, which are called ``NAME of A`` and ``NAME of B`` in traces.
    ``impossible`` are literals that no sample was found to make true together: traces with such samples are left out.
    ``relation`` is None where one is over finite traces and the other over infinite ones.
    """

    relation: Relation | None
    only_a: Trace | None = None
    only_b: Trace | None = None
    split: tuple[str, ...] = ()
    impossible: tuple[Literals, ...] = ()


def compare(
    a: Fspa,
    b: Fspa,
    *,
    by_name: bool = False,
    real: bool = False,
    work: int = DEFAULT_WORK,
    exclusive: Iterable[Collection[str]] = (),
) -> Comparison:
    """How the traces that B accepts relate to those that A does, over the atoms of both.

    Atoms of one name are one if their expressions are equal, and no sample in the ranges of both was found at which
    only one of them holds, by other params; with ``by_name``, always.  With ``real``, traces count only if samples were
    found that are such: ``fuel > 30`` does not hold without ``fuel > 20``.  Atoms of a group of ``exclusive`` never
    hold together, nor do those of the groups that the automata have.

    Raises:
        OutOfWork: the comparison takes more than ``work`` steps, each way.
    """
    if a.semantics != b.semantics:
        return Comparison(None)
    split = () if by_name else different_atoms(a, b)
    one, other = _renamed(a, split, OF_A), _renamed(b, split, OF_B)
    never = _never(exclusive, one, other)
    only_a, only_b = separating(one, other, work, never), separating(other, one, work, never)
    impossible: dict[Literals, None] = {}
    if real and (only_a or only_b):
        from tltlc.diff.reality import Reality

        reality = Reality(one, other, never)
        only_a, only_b = reality.real(only_a, one, other, work), reality.real(only_b, other, one, work)
        impossible = reality.impossible
    relation: Relation = (
        ("equivalent" if only_b is None else "looser")
        if only_a is None
        else ("stricter" if only_b is None else "incomparable")
    )
    return Comparison(relation, only_a, only_b, split, tuple(impossible))


def _never(groups: Iterable[Collection[str]], one: Fspa, other: Fspa) -> tuple[Literals, ...]:
    """Of each group the pairs that the automata have; an atom that is split, and so called otherwise, is in none."""
    names = {atom.name for fspa in (one, other) for atom in fspa.atoms}
    pairs = (pair for group in groups for pair in combinations(sorted(names.intersection(group)), 2))
    return tuple(((first, True), (second, True)) for first, second in pairs)


def different_atoms(a: Fspa, b: Fspa) -> tuple[str, ...]:
    """The names that two automata have different atoms for, in the order of A."""
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
