"""The stages of a spec: what has to be done in a state of its automaton, in the words of its atoms."""

from __future__ import annotations

import re
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.expression import Signal, nodes
from tltlc.monitor.tables import tables
from tltlc.resolve.spec import Atom

_DISTANCE: Final = re.compile(r"distance\((.+)\)\Z")


def target_of(atom: Atom) -> str | None:
    """The entity to which an atom measures the distance, None where it speaks of anything else, too."""
    names = {node.name for node in nodes(atom.expression) if isinstance(node, Signal)}
    match = _DISTANCE.match(next(iter(names))) if len(names) == 1 else None
    return match[1] if match else None


def deed(fspa: Fspa, state: int) -> str:
    """What leads from a state nearer to acceptance: ``reaches `s1```, ``reaches `a` or `b```, ``makes `open` true``."""
    found: list[str] = []
    for edge in tables(fspa).improving[state]:
        nearest = min(edge.guard.primes, key=len)
        wanted = [fspa.atoms[atom] for atom, holds in nearest if holds]
        targets = [f"`{target}`" for atom in wanted if (target := target_of(atom))]
        others = [f"`{atom.name}`" for atom in wanted if target_of(atom) is None and not _is_kept(fspa, atom)]
        words = [f"reaches {' and '.join(targets)}"] if targets else []
        words += [f"makes {' and '.join(others)} true"] if others and not targets else []
        found += [" and ".join(words)] if words else []
    return " or ".join(dict.fromkeys(found)) or "meets the spec"


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
