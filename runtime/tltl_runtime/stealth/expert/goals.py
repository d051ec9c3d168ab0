"""Where a spec sends the player next: read off the automaton, with no knowledge of the level."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from typing import Final, SupportsFloat

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import Signal, nodes
from tltlc.resolve.spec import Atom

_DISTANCE: Final = re.compile(r"distance\((.+)\)\Z")


def next_goals(
    fspa: Fspa, state: int, sample: Mapping[str, SupportsFloat], params: Mapping[str, float], places: Collection[str]
) -> tuple[str, ...]:
    """The entities of ``places`` to come near to, for the automaton to leave ``state`` towards acceptance.

    Each is one of several choices; those that lead nearer to acceptance come first.  An edge counts where its atoms
    that speak of no distance have, in ``sample``, the truth that its guard asks for; ``sample`` and ``params`` are
    in SI units.
    """
    here = fspa.states[state].distance
    if not here:
        return ()
    values = {**{param.name: param.value for param in fspa.params}, **params}
    signals = {name: float(sample[name]) for name in {signal.name for signal in fspa.signals}}
    entities = [_entity(atom, places) for atom in fspa.atoms]
    settled = [
        None if entity is not None else evaluate(atom.expression, signals, values) > 0.0
        for atom, entity in zip(fspa.atoms, entities, strict=True)
    ]
    found: list[tuple[int, str]] = []
    for edge in fspa.edges_from(state):
        distance = fspa.states[edge.target].distance
        if distance is None or distance >= here:
            continue
        for implicant in edge.guard.primes:
            goals = _goals(implicant, entities, settled)
            found += [(distance, goal) for goal in goals]
    return tuple(dict.fromkeys(goal for _, goal in sorted(found, key=lambda each: each[0])))


def _goals(implicant: Implicant, entities: list[str | None], settled: list[bool | None]) -> list[str]:
    """The entities that an implicant asks to be near to; none where another of its atoms fails now."""
    goals = []
    for atom, holds in implicant:
        entity = entities[atom]
        if entity is None:
            if settled[atom] != holds:
                return []
        elif holds:
            goals.append(entity)
    return goals


def _entity(atom: Atom, places: Collection[str]) -> str | None:
    """The entity whose distance an atom is about."""
    for node in nodes(atom.expression):
        if isinstance(node, Signal) and (entity := distant_entity(node.name)) in places:
            return entity
    return None


def distant_entity(signal: str) -> str | None:
    """The entity to which a signal of that name is the distance, None where it is none."""
    match = _DISTANCE.match(signal)
    return match[1] if match else None
