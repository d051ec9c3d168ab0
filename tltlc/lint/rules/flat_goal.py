"""TLT0417: a goal that is an atom whose value is 0 wherever it does not hold."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.lint.rule import Remark, Rule
from tltlc.lint.signs import can_be, is_always
from tltlc.lint.view import View


def check(view: View) -> Iterator[Remark]:
    """A remark for each atom of a spec that is never negative and that a state waits for."""
    for spec in view.specs:
        for index in _awaited(spec.fspa):
            atom = spec.fspa.atoms[index]
            can_fail = can_be("not positive", atom, spec.fspa)
            if can_fail and not can_be("negative", atom, spec.fspa) and is_always("not negative", atom, spec.fspa):
                label = spec.atom_label(atom.name, "0 until it holds: progress cannot tell near from far")
                way_out = "give the predicate negative values where it does not hold, the lower the farther"
                yield Remark(f"the value of `{atom.name}` is never negative", (label,), way_out)


def _awaited(fspa: Fspa) -> list[int]:
    """The atoms that an edge towards the goal needs, and without which the automaton stays where it is."""
    stays: dict[int, list[Implicant]] = {}
    for edge in fspa.edges:
        if edge.source == edge.target:
            stays.setdefault(edge.source, []).extend(edge.guard.primes)
    found: set[int] = set()
    for edge in fspa.edges:
        here, there = fspa.states[edge.source].distance, fspa.states[edge.target].distance
        if here is not None and there is not None and there < here:
            needed = set.intersection(*({atom for atom, holds in prime if holds} for prime in edge.guard.primes))
            loops = stays.get(edge.source, [])
            found.update(atom for atom in needed - found if any((atom, True) not in prime for prime in loops))
    return sorted(found)


RULE = Rule("TLT0417", "note", check)
