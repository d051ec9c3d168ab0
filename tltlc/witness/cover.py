"""A small set of traces that together take every edge that samples can take."""

from __future__ import annotations

from tltlc.record import record
from tltlc.witness.moves import Move, Moves
from tltlc.witness.samples import Obstacle
from tltlc.witness.traces import Witness


@record
class Untaken:
    """An edge, by its index, that no trace takes: for want of samples or, without obstacles, of a way to its source."""

    edge: int
    obstacles: tuple[Obstacle, ...]


@record
class Cover:
    """The traces, shortest first, and the edges that none of them takes, in order."""

    traces: tuple[Witness, ...]
    untaken: tuple[Untaken, ...]


def cover(moves: Moves) -> Cover:
    """Traces that take every edge which samples take: each goes on to the nearest edge that is not taken yet.

    A trace ends where no such edge is ahead.  Over infinite traces these are the beginnings of traces.
    """
    left = {edge for edge in range(len(moves.fspa.edges)) if moves.move(edge) is not None}
    traces: list[Witness] = []
    while (trace := _trace(moves, left)) is not None:
        traces.append(Witness("cover", trace))
    traces.sort(key=lambda trace: len(trace.moves))
    untaken = [
        Untaken(edge, moves.obstacles.get(edge, ()))
        for edge in range(len(moves.fspa.edges))
        if edge in left or moves.move(edge) is None
    ]
    return Cover(tuple(traces), tuple(untaken))


def _trace(moves: Moves, left: set[int]) -> tuple[Move, ...] | None:
    """A trace from the initial state, whose edges are taken from those that are left; None where there is none."""
    found: list[Move] = []
    state = 0
    while left and (way := moves.way(state, left.__contains__)) is not None:
        found += way
        left.difference_update(move.edge for move in way)
        state = moves.fspa.edges[way[-1].edge].target
    return tuple(found) or None
