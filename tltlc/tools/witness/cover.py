"""Find a small set of traces that together take every edge that samples can take."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tltlc.core.record import record
from tltlc.tools.witness.nearest import NearestEdges
from tltlc.tools.witness.samples import UnsatisfiedLiterals
from tltlc.tools.witness.traces import Witness
from tltlc.tools.witness.transitions import Moves, SampledEdge


@record
class Untaken:
    """An edge, by index, that no trace takes.

    If there are no obstacles, its source cannot be reached. Otherwise no sample takes the edge.
    """

    edge: int
    obstacles: tuple[UnsatisfiedLiterals, ...]


@record
class Cover:
    """The traces, shortest first, and the edges that none of them takes, in order."""

    traces: tuple[Witness, ...]
    untaken: tuple[Untaken, ...]


def cover(moves: Moves) -> Cover:
    """Return traces that take every edge that samples can take.

    Each trace continues to the nearest edge that is not taken yet, and ends if it can reach no such
    edge. Over infinite traces, these are beginnings of traces.
    """
    edges = moves.fspa.edges
    nearest = NearestEdges(
        [[(edge, edges[edge].target) for edge in leaving if moves.move(edge)] for leaving in moves.leaving]
    )
    traces: list[tuple[SampledEdge, ...]] = []
    while trace := tuple(_trace(moves, nearest)):
        traces.append(trace)
    traces.sort(key=len)
    taken = {move.edge for trace in traces for move in trace}
    untaken = [Untaken(edge, moves.obstacles.get(edge, ())) for edge in range(len(edges)) if edge not in taken]
    return Cover(tuple(_with_news(traces)), tuple(untaken))


def _trace(moves: Moves, nearest: NearestEdges) -> Iterator[SampledEdge]:
    """Yield the moves of a trace from the initial state that takes edges which no trace has taken.

    It yields nothing if there is no such trace.
    """
    state = 0
    while way := nearest.take(state):
        for edge in way:
            move = moves.move(edge)
            assert move is not None
            yield move
        state = moves.fspa.edges[way[-1]].target


def _with_news(traces: Iterable[tuple[SampledEdge, ...]]) -> Iterator[Witness]:
    """Yield the traces as witnesses, each with the steps that are the first to take their edge."""
    seen: set[int] = set()
    for trace in traces:
        news = []
        for number, move in enumerate(trace, start=1):
            if move.edge not in seen:
                seen.add(move.edge)
                news.append(number)
        yield Witness("cover", trace, news=tuple(news))
