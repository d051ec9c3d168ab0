"""The stages of a spec: what has to be done in a state of its automaton, in the words of its atoms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltl_runtime.stealth.expert.goals import distant_entity
from tltlc.automaton.fspa import Fspa
from tltlc.expression import Signal, nodes
from tltlc.monitor.tables import tables
from tltlc.resolve.spec import Atom

_REACHES: Final = "reaches "


def target_of(atom: Atom) -> str | None:
    """The entity to which an atom measures the distance, None where it speaks of anything else, too."""
    names = {node.name for node in nodes(atom.expression) if isinstance(node, Signal)}
    return distant_entity(next(iter(names))) if len(names) == 1 else None


def deed(fspa: Fspa, state: int) -> str:
    """What leads from a state nearer to acceptance: ``reaches `s1```, ``reaches `a` or `b```, ``makes `open` true``."""
    found = [
        words
        for edge in tables(fspa).improving[state]
        for prime in edge.guard.primes
        if (words := _deed(fspa, [fspa.atoms[atom] for atom, holds in prime if holds]))
    ]
    distinct = list(dict.fromkeys(found))
    if distinct and all(each.startswith(_REACHES) for each in distinct):
        return _REACHES + " or ".join(each.removeprefix(_REACHES) for each in distinct)
    return " or ".join(distinct) or "meets the spec"


def _deed(fspa: Fspa, wanted: list[Atom]) -> str:
    """What makes these atoms true at once: where one is to go somewhere, that alone; of what is kept, nothing."""
    if targets := [f"`{target}`" for atom in wanted if (target := target_of(atom))]:
        return f"{_REACHES}{' and '.join(targets)}"
    others = [f"`{atom.name}`" for atom in wanted if not _is_kept(fspa, atom)]
    return f"makes {' and '.join(others)} true" if others else ""


def chain(fspa: Fspa) -> tuple[int, ...]:
    """The states from the first one to an accepting one, each of smaller distance than the one before."""
    found = [0]
    while fspa.states[found[-1]].distance:
        nearer = tables(fspa).improving[found[-1]]
        found.append(min(nearer, key=lambda edge: fspa.states[edge.target].distance or 0).target)
    return tuple(found)


def _is_kept(fspa: Fspa, atom: Atom) -> bool:
    """Whether all accepting runs need the atom all the time: every edge to no trap has it."""
    index = fspa.atoms.index(atom)
    kept = [edge for edge in fspa.edges if fspa.states[edge.target].distance is not None]
    return all((index, True) in prime for edge in kept for prime in edge.guard.primes)


def together(deeds: Sequence[str]) -> str:
    """Several deeds, one after the other: ``reaches `s1`, `s2```."""
    if deeds and all(each.startswith(_REACHES) for each in deeds):
        return _REACHES + ", ".join(each.removeprefix(_REACHES) for each in deeds)
    return ", ".join(deeds)
