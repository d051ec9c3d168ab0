"""Find traces of an automaton with registers, each step of which a monitor has taken."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, Final, cast

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import given_atoms
from tltlc.monitor.guards import holds
from tltlc.monitor.samples import Samples
from tltlc.tools.witness.candidate_samples import LiteralSamples, candidate_samples, without_registers
from tltlc.tools.witness.guard_inputs import EdgeAim, Literals
from tltlc.tools.witness.guided_search import GuidedSearch
from tltlc.tools.witness.memory_search import HELD_STEPS, SINGLE_STEPS, MemorySearch, Position
from tltlc.tools.witness.step_lengths import length_names
from tltlc.tools.witness.transitions import SampledEdge

if TYPE_CHECKING:
    from tltlc.monitor.traces import TraceSample


_COVER: Final = 2
"""The searches for the edges of a cover share as many steps as this number of searches for a trace."""


class MemoryTraces:
    """Finds traces of one automaton with registers, and keeps the traces that were tried for later searches.

    It tries short traces first, then what the guards on the way to the wanted edges ask for, and then
    traces that repeat any input.
    """

    def __init__(self, fspa: Fspa) -> None:
        self._fspa = fspa
        self._search = MemorySearch((fspa,), candidate_samples(fspa).samples)
        self._most_held = HELD_STEPS // self._search.size
        # For large automata, what the guards ask for is found sooner than short traces.
        self._short = self._search.short_positions(SINGLE_STEPS // self._search.size**2)
        self._held = self._search.held_positions(self._most_held)
        self._first: dict[int, Position] = {}

    def trace_to(self, is_last: Callable[[int], bool]) -> tuple[SampledEdge, ...] | None:
        """Return the moves of the first trace found that ends with a certain edge; None if none is found.

        ``is_last`` gets the index of an edge, and says whether the trace may end with this edge.
        """
        wanted = {edge for edge in range(len(self._fspa.edges)) if is_last(edge)}
        if not wanted:
            return None
        known = next((position for edge, position in self._first.items() if edge in wanted), None)
        position = known or self._first_to(wanted, self._short)
        if position is None and not self._search.has_ended:
            position = self._first_to(wanted, self._guided(wanted, self._most_held))
            position = position or self._first_to(wanted, self._held)
            if position is not None:
                position = self._search.shorter(position, lambda edges: edges[0] in wanted)
        return None if position is None else self.moves(position)

    def _first_to(self, wanted: Collection[int], positions: Iterable[Position]) -> Position | None:
        return next((self._first[edge] for edge in self._new_edges(positions) if edge in wanted), None)

    def traces_to_all(self) -> dict[int, tuple[SampledEdge, ...]]:
        """Return, for each edge that was found on a trace, the moves of the first trace that ends with it."""
        self._take_all(self._short)
        if not self._search.has_ended:
            self._take_all(self._held)
            missing = [edge for edge in range(len(self._fspa.edges)) if edge not in self._first]
            for edge in missing:
                if edge not in self._first:
                    most = _COVER * self._most_held // max(_COVER, len(missing))
                    self._take_all(self._guided({edge}, most, self._first.values()), edge)
        return {edge: self.moves(position) for edge, position in self._first.items()}

    def first_moves(self) -> list[SampledEdge]:
        """Return the first move of each trace that the search tries."""
        return [self.moves(position)[0] for position in self._search.first_positions()]

    def _new_edges(self, positions: Iterable[Position]) -> Iterator[int]:
        """Go on with a search, and yield each edge that it takes for the first time."""
        for position in positions:
            (edge,) = position.edges
            if edge not in self._first:
                self._first[edge] = position
                yield edge

    def _take_all(self, positions: Iterable[Position], last: int | None = None) -> None:
        """Go on with a search until all edges are taken, or the edge ``last``."""
        missing = len(self._fspa.edges) - len(self._first)
        for edge in islice(self._new_edges(positions), missing):
            if edge == last:
                return

    def _guided(self, wanted: Collection[int], most: int, starts: Iterable[Position] = ()) -> Iterator[Position]:
        """Yield the ends of traces, at most ``most``, on the way to one of the ``wanted`` edges.

        They go on from ``starts``, and from the first sample.
        """
        aim = EdgeAim(self._search, self._fspa, [atom.name for atom in self._fspa.atoms], wanted, self._inputs_for)
        search = GuidedSearch(self._search, aim, tries_again=True)
        return islice(search.positions((self._search.start(), *starts)), most)

    def _inputs_for(self, literals: Literals) -> list[TraceSample]:
        return self._samples.samples(tuple((self._place[name], holds) for name, holds in literals.items()))

    @cached_property
    def _samples(self) -> LiteralSamples:
        return LiteralSamples(without_registers(self._fspa), self._fspa.signals, self._fspa.registers)

    @cached_property
    def _place(self) -> dict[str, int]:
        return {self._fspa.atoms[atom].name: place for place, atom in enumerate(given_atoms(self._fspa))}

    def moves(self, position: Position) -> tuple[SampledEdge, ...]:
        """Return the moves of the trace that leads to a position."""
        samples = (self._search.inputs[number] for number in position.trace())
        return moves_of(self._fspa, [cast("TraceSample", sample) for sample in samples])


def moves_of(fspa: Fspa, trace: Sequence[dict[str, float]]) -> tuple[SampledEdge, ...]:
    """Run an automaton on the samples of a trace, and return its moves."""
    state, moves = 0, []
    for sample, values in zip(trace, Samples(fspa, None, []).of_trace(trace), strict=True):
        letter = frozenset(atom.name for atom, value in zip(fspa.atoms, values.atoms, strict=True) if value > 0.0)
        index, edge = next(
            (index, edge)
            for index, edge in enumerate(fspa.edges)
            if edge.source == state and holds(edge.guard, values.atoms)
        )
        prime = next(
            prime for prime in edge.guard.primes if all((values.atoms[atom] > 0.0) == holds_ for atom, holds_ in prime)
        )
        moves.append(SampledEdge(index, prime, letter | length_names(sample), sample))
        state = edge.target
    return tuple(moves)
