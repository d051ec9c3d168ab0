"""Find a small set of traces that together take every edge for which a sample is found."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tltlc.core.record import record
from tltlc.tools.witness.samples import UnsatisfiedLiterals
from tltlc.tools.witness.traces import Witness
from tltlc.tools.witness.transitions import Moves, SampledEdge
from tltlc.tools.witness.wanted_edges import WantedEdges


@record
class UntakenEdge:
    """An edge that no trace of a cover takes; ``edge`` is its index.

    ``obstacles`` are sets of literals of its guard for which no sample was found. If there are
    none, no trace reaches the source of the edge.
    """

    edge: int
    obstacles: tuple[UnsatisfiedLiterals, ...]


@record
class Cover:
    """Traces that together take as many edges as possible, the shortest first.

    ``untaken`` has the remaining edges.
    """

    traces: tuple[Witness, ...]
    untaken: tuple[UntakenEdge, ...]


def cover(moves: Moves) -> Cover:
    """Return traces that together take every edge that can be reached, and for which a sample is found.

    Each trace goes to the nearest edge that no trace has taken yet, from there to the next one, and
    so on. It ends when it can reach no such edge. If the spec is over infinite traces, the result
    has finite beginnings of traces.
    """
    edges = moves.fspa.edges
    if moves.fspa.registers:
        return _cover_with_registers(moves)
    wanted = WantedEdges(
        [[(edge, edges[edge].target) for edge in leaving if moves.move(edge)] for leaving in moves.leaving]
    )
    traces: list[tuple[SampledEdge, ...]] = []
    while trace := tuple(_trace(moves, wanted)):
        traces.append(trace)
    traces.sort(key=len)
    taken = {move.edge for trace in traces for move in trace}
    untaken = [UntakenEdge(edge, moves.obstacles.get(edge, ())) for edge in range(len(edges)) if edge not in taken]
    return Cover(tuple(_witnesses(traces)), tuple(untaken))


def _cover_with_registers(moves: Moves) -> Cover:
    """Return the first traces that the search finds for the edges, without those that are parts of others."""
    ends = moves.traces.traces_to_all()
    taken: set[int] = set()
    traces: list[tuple[SampledEdge, ...]] = []
    for trace in sorted(ends.values(), key=len, reverse=True):
        if trace[-1].edge not in taken:
            taken.update(move.edge for move in trace)
            traces.append(trace)
    traces.sort(key=len)
    untaken = [UntakenEdge(edge, ()) for edge in range(len(moves.fspa.edges)) if edge not in taken]
    return Cover(tuple(_witnesses(traces)), tuple(untaken))


def _trace(moves: Moves, wanted: WantedEdges) -> Iterator[SampledEdge]:
    """Yield the moves of a trace that starts in the initial state and takes one wanted edge after another.

    An edge is wanted if no trace has taken it yet. Nothing is yielded if no wanted edge can be
    reached.
    """
    state = 0
    while path := wanted.take(state):
        for edge in path:
            move = moves.move(edge)
            assert move is not None
            yield move
        state = moves.fspa.edges[path[-1]].target


def _witnesses(traces: Iterable[tuple[SampledEdge, ...]]) -> Iterator[Witness]:
    """Yield the traces as witnesses, whose ``new_steps`` are the steps with an edge that no earlier step took."""
    taken: set[int] = set()
    for trace in traces:
        new_steps = []
        for number, move in enumerate(trace, start=1):
            if move.edge not in taken:
                taken.add(move.edge)
                new_steps.append(number)
        yield Witness("cover", trace, new_steps=tuple(new_steps))
