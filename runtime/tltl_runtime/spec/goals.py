"""Find the next goals of a spec from its automaton, without knowledge of the level."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import SupportsFloat

from tltlc.api import Atom, Fspa, Implicant, expressions


def next_goals(
    fspa: Fspa, state: int, sample: Mapping[str, SupportsFloat], params: Mapping[str, float], places: Collection[str]
) -> tuple[str, ...]:
    """Return the entities to approach so that the automaton leaves ``state`` towards acceptance.

    They are alternatives; the player may approach any of them. Entities that lead nearer to
    acceptance come first. Only entities in ``places`` are returned. If the state is accepting or a
    trap, the result is empty.

    The guards of the edges towards acceptance are disjunctions of prime implicants. In each of
    these, some atoms depend on the distance to an entity in ``places``. All other atoms must already
    have the required truth values in ``sample``, otherwise the implicant does not count. Nor does it
    count if an atom in it remembers the trace so far, which ``sample`` does not show. ``sample`` has
    the values of the spec's signals, and ``params`` those of its params, by name and in SI units.
    """
    current = fspa.states[state].distance
    if not current:
        return ()
    values = {**{param.name: param.value for param in fspa.params}, **params}
    signals = {name: float(sample[name]) for name in {signal.name for signal in fspa.signals}}
    distances = {name: entity for name, entity in distance_signals(fspa).items() if entity in places}
    entities = [_entity(atom, distances) for atom in fspa.atoms]
    registers = frozenset(register.name for register in fspa.registers)
    settled = [
        None
        if entity is not None or not registers.isdisjoint(_read(atom))
        else expressions.evaluate(atom.expression, signals, values) > 0.0
        for atom, entity in zip(fspa.atoms, entities, strict=True)
    ]
    candidates: list[tuple[int, str]] = []
    for edge in fspa.edges_from(state):
        distance = fspa.states[edge.target].distance
        if distance is None or distance >= current:
            continue
        for implicant in edge.guard.primes:
            goals = _goals(implicant, entities, settled)
            candidates += [(distance, goal) for goal in goals]
    return tuple(dict.fromkeys(goal for _, goal in sorted(candidates, key=lambda candidate: candidate[0])))


def _goals(implicant: Implicant, entities: list[str | None], settled: list[bool | None]) -> list[str]:
    """Return the entities that the player must be near to make an implicant true.

    ``entities`` has, for each atom of the spec, the entity on whose distance the atom depends; None
    if it depends on no distance. ``settled`` says, for each atom without an entity, whether it holds
    now; None if this is not known. The result is empty if such an atom does not have the truth value
    that the implicant requires.
    """
    goals = []
    for atom, holds in implicant:
        entity = entities[atom]
        if entity is None:
            if settled[atom] != holds:
                return []
        elif holds:
            goals.append(entity)
    return goals


def _entity(atom: Atom, distances: Mapping[str, str]) -> str | None:
    """Return the first entity on whose distance an atom depends; None if it depends on no distance.

    ``distances`` maps the names of distance signals to entities, as :func:`distance_signals` does.
    """
    return next((distances[name] for name in _read(atom) if name in distances), None)


def _read(atom: Atom) -> list[str]:
    """Return the names of the signals and registers that an atom reads."""
    return [node.name for node in expressions.nodes(atom.expression) if isinstance(node, expressions.SignalValue)]


def distance_signals(fspa: Fspa) -> dict[str, str]:
    """Return the entity of each distance signal, by the name of the signal: ``{"distance(exit)": "exit"}``."""
    return {
        signal.name: signal.arguments[0]
        for signal in fspa.signals
        if signal.base == "distance" and len(signal.arguments) == 1
    }
