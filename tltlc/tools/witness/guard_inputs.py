"""Inputs for traces of automata with registers, chosen from the guards of the edges that leave a state."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, Final

from tltlc.resolve.registers import following_atoms
from tltlc.resolve.sources import sources

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Edge, Fspa, Implicant
    from tltlc.tools.witness.memory_search import MemorySearch, TraceInput

Literals = dict[str, bool]
"""Truth values of atoms, by name."""
InputsFor = Callable[[Literals], "Sequence[TraceInput]"]
"""Returns inputs at which literals are true, the best first; empty if none is found."""

_MOST_PRIMES: Final = 4
"""The most prime implicants of a guard that are tried."""
_MOST_COMPARED: Final = 30
"""The most prime implicants of a guard that are compared with the values of atoms."""
_MOST_ORIGINS: Final = 4
"""Up to this many atoms from which a prime implicant follows, each is also tried alone."""
_MOST_INPUTS: Final = 24
"""The most inputs for a state of an automaton."""


class GuardInputs:
    """The inputs that the guards of an automaton ask for, as numbers of inputs of ``search``.

    ``names`` has the names of the atoms of the automaton in inputs. ``rank`` says how far the aim is after
    an edge, by its index; edges without a rank are left out. ``inputs_for`` finds inputs.
    """

    def __init__(
        self,
        search: MemorySearch,
        fspa: Fspa,
        names: Sequence[str],
        rank: Callable[[int], int | None],
        inputs_for: InputsFor,
    ) -> None:
        self._search, self._fspa, self._names = search, fspa, names
        self._rank, self._inputs_for = rank, inputs_for
        self._waited_for: dict[int, tuple[Implicant, ...]] = {}
        self._numbers: dict[tuple[tuple[str, bool], ...], list[int]] = {}
        self._origins: dict[int, tuple[str, ...]] = {}

    def of_state(self, state: int, values: Sequence[float] | None) -> tuple[int, ...]:
        """Return the numbers of the inputs for a state, those that lead nearest to the aim first.

        ``values`` are the values of the atoms at the last sample, or None at first.
        """
        found = list(map(self._added, islice(self._literals(state, values), _MOST_INPUTS)))
        best = (numbers[0] for numbers in found if numbers)
        others = (number for numbers in found for number in numbers[1:])
        return tuple(islice(dict.fromkeys((*best, *others)), _MOST_INPUTS))

    def lack(self, state: int, values: Sequence[float]) -> float:
        """Return by how much the memory misses the nearest guard that leads on, by the values of all atoms.

        Atoms that do not follow from others lack nothing: the next input may have them.
        """
        if state not in self._waited_for:
            edges = self._edges_from(state)
            here = min((rank for rank, edge in edges if edge.target == state), default=None)
            nearer = [edge for rank, edge in edges if here is None or rank < here]
            primes = [prime for edge in nearer for prime in edge.guard.primes[:_MOST_COMPARED]]
            self._waited_for[state] = tuple(dict.fromkeys(map(self._of_memory, primes)))
        return min((_lack(prime, values) for prime in self._waited_for[state]), default=0.0)

    def _edges_from(self, state: int) -> list[tuple[int, Edge]]:
        """Return the edges from a state that have a rank, with it, the nearest to the aim first."""
        edges = [(self._rank(index), edge) for index, edge in enumerate(self._fspa.edges) if edge.source == state]
        ranked = [(rank, edge) for rank, edge in edges if rank is not None]
        return sorted(ranked, key=lambda item: (item[0], item[1].target == state))

    def _literals(self, state: int, values: Sequence[float] | None) -> Iterator[Literals]:
        yield {}
        primes = [prime for _, edge in self._edges_from(state) for prime in edge.guard.primes[:_MOST_PRIMES]]
        if values is not None:
            primes.sort(key=lambda prime: _lack(self._of_memory(prime), values))
        for prime in primes:
            given = {self._fspa.atoms[atom].name: holds for atom, holds in prime if atom not in self._following}
            yield given
            lacking = [] if values is None else [atom for atom, holds in prime if (values[atom] > 0.0) != holds]
            origins = (origin for atom in lacking if atom in self._following for origin in self._origins_of(atom))
            free = [origin for origin in dict.fromkeys(origins) if origin not in given]
            if free:
                yield {**given, **dict.fromkeys(free, True)}
            if 1 < len(free) <= _MOST_ORIGINS:
                for chosen in free:
                    yield {**given, **{name: name == chosen for name in free}}

    def _of_memory(self, prime: Implicant) -> Implicant:
        """Return the literals of a prime implicant that follow from others."""
        return tuple(literal for literal in prime if literal[0] in self._following)

    @cached_property
    def _following(self) -> frozenset[int]:
        names = following_atoms(self._fspa.atoms, self._fspa.registers)
        return frozenset(index for index, atom in enumerate(self._fspa.atoms) if atom.name in names)

    def _origins_of(self, atom: int) -> tuple[str, ...]:
        if atom not in self._origins:
            self._origins[atom] = sources(self._fspa.atoms[atom].name, self._fspa.atoms, self._fspa.registers)
        return self._origins[atom]

    def _added(self, literals: Literals) -> list[int]:
        own = {atom.name: name for atom, name in zip(self._fspa.atoms, self._names, strict=True)}
        key = tuple(sorted((own[name], holds) for name, holds in literals.items()))
        if key not in self._numbers:
            inputs = self._inputs_for(dict(key))
            self._numbers[key] = [number for given in inputs for number in self._search.add(given)]
        return self._numbers[key]


def _lack(prime: Implicant, values: Sequence[float]) -> float:
    return sum(min(1.0, abs(values[atom])) for atom, holds in prime if (values[atom] > 0.0) != holds)


class EdgeAim:
    """The aim to take one of the edges ``wanted`` of the only automaton of ``search``.

    ``names`` and ``inputs_for`` are those of :class:`GuardInputs`.
    """

    def __init__(
        self, search: MemorySearch, fspa: Fspa, names: Sequence[str], wanted: Collection[int], inputs_for: InputsFor
    ) -> None:
        self._distance = distances_to(fspa, wanted)

        def rank(edge: int) -> int | None:
            return -1 if edge in wanted else self._distance.get(fspa.edges[edge].target)

        self._guards = GuardInputs(search, fspa, names, rank, inputs_for)

    def rank(self, states: tuple[int, ...]) -> int | None:
        """Return how many edges are between the state and the nearest wanted edge."""
        return self._distance.get(states[0])

    def lack(self, states: tuple[int, ...], values: tuple[tuple[float, ...], ...]) -> float:
        """Return by how much the memory misses the nearest guard that leads on."""
        return self._guards.lack(states[0], values[0])

    def inputs(self, states: tuple[int, ...], values: tuple[tuple[float, ...], ...] | None) -> tuple[int, ...]:
        """Return the inputs that the guards of the state ask for."""
        return self._guards.of_state(states[0], None if values is None else values[0])


def distances_to(fspa: Fspa, edges: Iterable[int]) -> dict[int, int]:
    """Map each state from which one of these edges can come to the least number of edges before it.

    What registers remember may make the way longer, or close it.
    """
    sources: dict[int, list[int]] = {}
    for edge in fspa.edges:
        sources.setdefault(edge.target, []).append(edge.source)
    distance = {fspa.edges[edge].source: 0 for edge in edges}
    queue = list(distance)
    for state in queue:
        for source in sources.get(state, ()):
            if source not in distance:
                distance[source] = distance[state] + 1
                queue.append(source)
    return distance
