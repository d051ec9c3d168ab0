"""TLT0417: a goal that is an atom whose value is 0 wherever it does not hold."""

from __future__ import annotations

from collections.abc import Iterator, Set

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.resolve.spec import Atom
from tltlc.tools.lint.atom_signs import can_be, is_always
from tltlc.tools.lint.file_view import View
from tltlc.tools.lint.rule import Remark, Rule


def check(view: View) -> Iterator[Remark]:
    """A remark for each atom of a spec that is never negative and that a state waits for, with no other that is."""
    for spec in view.specs:
        flat = {index for index, atom in enumerate(spec.fspa.atoms) if _is_flat(atom, spec.fspa)}
        for index in _awaited(spec.fspa, flat) if flat else ():
            name = spec.fspa.atoms[index].name
            label = spec.atom_label(name, "0 until it holds: progress cannot tell near from far")
            way_out = "give the predicate negative values where it does not hold, the lower the farther"
            yield Remark(f"the value of `{name}` is never negative", (label,), way_out)


def _is_flat(atom: Atom, fspa: Fspa) -> bool:
    """Whether the value of an atom is proved never to be negative, and is 0 somewhere."""
    can_fail = can_be("not positive", atom, fspa)
    return can_fail and not can_be("negative", atom, fspa) and is_always("not negative", atom, fspa)


def _awaited(fspa: Fspa, flat: Set[int]) -> list[int]:
    """The flat atoms that an edge towards the goal needs, and without which the automaton stays where it is.

    Of several that it needs together the least value counts: one that can be negative tells near from far.
    """
    stays: dict[int, list[Implicant]] = {}
    for edge in fspa.edges:
        if edge.source == edge.target:
            stays.setdefault(edge.source, []).extend(edge.guard.primes)
    kept = {state: set.intersection(*map(set, primes)) for state, primes in stays.items()}
    found: set[int] = set()
    for edge in fspa.edges:
        here, there = fspa.states[edge.source].distance, fspa.states[edge.target].distance
        if edge.source in kept and here is not None and there is not None and there < here:
            missing = (set(prime) - kept[edge.source] for prime in edge.guard.primes)
            awaited = [{atom for atom, holds in literals if holds} for literals in missing]
            if any(atoms <= flat for atoms in awaited):
                found |= set.intersection(*awaited)
    return sorted(found)


RULE = Rule("TLT0417", "note", check)
