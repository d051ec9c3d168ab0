"""Find traces of an automaton with registers, each step of which a monitor has taken."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, cast

from tltlc.automaton.fspa import Fspa
from tltlc.monitor.guards import holds
from tltlc.monitor.samples import Samples
from tltlc.tools.witness.candidate_samples import candidate_samples
from tltlc.tools.witness.memory_search import MemorySearch, Position
from tltlc.tools.witness.step_lengths import length_names
from tltlc.tools.witness.transitions import SampledEdge

if TYPE_CHECKING:
    from tltlc.monitor.traces import TraceSample


class MemoryTraces:
    """Finds traces of one automaton with registers, and keeps the traces that were tried for later searches."""

    def __init__(self, fspa: Fspa) -> None:
        self._fspa = fspa
        self._search = MemorySearch((fspa,), candidate_samples(fspa).samples)
        self._positions = self._search.positions()
        self._first: dict[int, Position] = {}

    def trace_to(self, is_last: Callable[[int], bool]) -> tuple[SampledEdge, ...] | None:
        """Return the moves of the first trace found that ends with a certain edge; None if none is found.

        ``is_last`` gets the index of an edge, and says whether the trace may end with this edge.
        """
        wanted = [edge for edge in range(len(self._fspa.edges)) if is_last(edge)]
        known = [edge for edge in self._first if edge in wanted]
        found = known[0] if known else next((edge for edge in self._new_edges() if edge in wanted), None)
        return None if found is None else self.moves(self._first[found])

    def traces_to_all(self) -> dict[int, tuple[SampledEdge, ...]]:
        """Return, for each edge that was found on a trace, the moves of the first trace that ends with it."""
        for _ in self._new_edges():
            if len(self._first) == len(self._fspa.edges):
                break
        return {edge: self.moves(position) for edge, position in self._first.items()}

    def first_moves(self) -> list[SampledEdge]:
        """Return the first move of each trace that the search tries."""
        return [self.moves(position)[0] for position in self._search.first_positions()]

    def _new_edges(self) -> Iterator[int]:
        """Go on with the search, and yield each edge that it takes for the first time."""
        for position in self._positions:
            (edge,) = position.edges
            if edge not in self._first:
                self._first[edge] = position
                yield edge

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
