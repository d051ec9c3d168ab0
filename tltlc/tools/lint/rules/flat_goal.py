"""TLT0417: a goal with an atom whose value is 0 wherever the atom does not hold."""

from __future__ import annotations

from collections.abc import Iterator, Set

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.resolve.spec import Atom
from tltlc.tools.lint.atom_signs import can_be, is_always
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each atom that an edge towards the goal needs, but whose value is never negative.

    Such a value is 0 until the atom holds, so progress does not tell near from far. There is no
    finding if the edge always needs an atom with negative values, too.
    """
    for spec in view.specs:
        flat = {index for index, atom in enumerate(spec.fspa.atoms) if _is_flat(atom, spec.fspa)}
        for index in _awaited(spec.fspa, flat) if flat else ():
            name = spec.fspa.atoms[index].name
            label = spec.atom_label(name, "0 until it holds, so progress cannot tell near from far")
            help_ = "give the predicate negative values where it does not hold: the farther away, the lower"
            yield RuleFinding(f"the value of `{name}` is never negative", (label,), help_)


def _is_flat(atom: Atom, fspa: Fspa) -> bool:
    """Whether the value of an atom is provably never negative, and can be 0."""
    can_fail = can_be("not positive", atom, fspa)
    return can_fail and not can_be("negative", atom, fspa) and is_always("not negative", atom, fspa)


def _awaited(fspa: Fspa, flat: Set[int]) -> list[int]:
    """Return the indices of the flat atoms that must begin to hold for some edge towards the goal.

    ``flat`` has the indices of the flat atoms: their value is never negative, and can be 0. An atom
    does not begin to hold if the self-loop of the edge's source needs it, too.

    The atoms of an edge are left out if the edge also needs an atom that is not flat, in each prime
    implicant of its guard. Progress uses the least value of the atoms, so the value of this other
    atom tells near from far.
    """
    stays: dict[int, list[Implicant]] = {}
    for edge in fspa.edges:
        if edge.source == edge.target:
            stays.setdefault(edge.source, []).extend(edge.guard.primes)
    kept = {state: set.intersection(*map(set, primes)) for state, primes in stays.items()}
    indices: set[int] = set()
    for edge in fspa.edges:
        here, there = fspa.states[edge.source].distance, fspa.states[edge.target].distance
        if edge.source in kept and here is not None and there is not None and there < here:
            missing = (set(prime) - kept[edge.source] for prime in edge.guard.primes)
            awaited = [{atom for atom, holds in literals if holds} for literals in missing]
            if any(atoms <= flat for atoms in awaited):
                indices |= set.intersection(*awaited)
    return sorted(indices)


RULE = LintRule("TLT0417", "note", check, lint_only=True)
