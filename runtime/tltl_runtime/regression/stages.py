"""The stages of a spec: what has to be done in a state of its automaton, in the words of its atoms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltl_runtime.stealth.expert.goals import distant_entity
from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.expression import Signal, nodes
from tltlc.monitor.tables import tables
from tltlc.resolve.spec import Atom

REACHES: Final = "reaches "
"""How a deed begins that is to be somewhere."""


def target_of(atom: Atom) -> str | None:
    """The entity to which an atom measures the distance, None where it speaks of anything else, too."""
    names = {node.name for node in nodes(atom.expression) if isinstance(node, Signal)}
    return distant_entity(next(iter(names))) if len(names) == 1 else None


def deed(fspa: Fspa, state: int) -> str:
    """What leads from a state nearer to acceptance: ``reaches `s1```, ``reaches `a` or `b```, ``makes `open` true``."""
    found = [
        words for edge in tables(fspa).improving[state] for prime in edge.guard.primes if (words := _deed(fspa, prime))
    ]
    distinct = list(dict.fromkeys(found))
    if distinct and all(each.startswith(REACHES) for each in distinct):
        return REACHES + " or ".join(each.removeprefix(REACHES) for each in distinct)
    return " or ".join(distinct) or "meets the spec"


def _deed(fspa: Fspa, prime: Implicant) -> str:
    """What makes a prime implicant true: where one is to go somewhere, that alone; what is to hold before what is not
    to; of what is kept, nothing.
    """
    if targets := [f"`{target}`" for atom, holds in prime if holds and (target := target_of(fspa.atoms[atom]))]:
        return f"{REACHES}{' and '.join(targets)}"
    for truth in (True, False):
        wanted = [atom for atom, holds in prime if holds == truth and not _is_kept(fspa, atom, truth)]
        if wanted:
            return f"makes {' and '.join(f'`{fspa.atoms[atom].name}`' for atom in wanted)} {str(truth).lower()}"
    return ""


def chain(fspa: Fspa) -> tuple[int, ...]:
    """The states from the first one to an accepting one, each of smaller distance than the one before."""
    found = [0]
    while fspa.states[found[-1]].distance:
        nearer = tables(fspa).improving[found[-1]]
        found.append(min(nearer, key=lambda edge: fspa.states[edge.target].distance or 0).target)
    return tuple(found)


def _is_kept(fspa: Fspa, atom: int, truth: bool) -> bool:
    """Whether all accepting runs need that an atom holds, or does not, all the time: every edge to no trap asks it."""
    kept = [edge for edge in fspa.edges if fspa.states[edge.target].distance is not None]
    return all((atom, truth) in prime for edge in kept for prime in edge.guard.primes)


def together(deeds: Sequence[str]) -> str:
    """Several deeds, one after the other: ``reaches `s1`, `s2```; with a choice among them ``reaches `s1`, then `a` or
    `b```.
    """
    between = ", then " if any(" or " in each for each in deeds) else ", "
    if deeds and all(each.startswith(REACHES) for each in deeds):
        return REACHES + between.join(each.removeprefix(REACHES) for each in deeds)
    return between.join(deeds)
