"""Find shortest traces that a spec accepts and rejects, as samples of its signals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from tltlc.automaton.fspa import Edge, Fspa, Guard, Pair, State
from tltlc.automaton.work import DEFAULT_WORK
from tltlc.core.record import record, replace
from tltlc.logic.formula import TRUE
from tltlc.tools.witness.samples import Sample
from tltlc.tools.witness.transitions import Moves, SampledEdge

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter

Kind = Literal["accepting", "rejecting", "cover"]


@record
class Witness:
    """A trace, as a sequence of moves.

    The moves from index ``cycle`` on repeat for ever. ``cycle`` is None over finite traces.
    ``news`` are the steps of a cover's trace, from 1, that are the first of the whole cover to take
    their edge.
    """

    kind: Kind
    moves: tuple[SampledEdge, ...]
    cycle: int | None = None
    news: tuple[int, ...] = ()

    @property
    def letters(self) -> tuple[Letter, ...]:
        """The letters, with the cycle once."""
        return tuple(move.letter for move in self.moves)

    @property
    def samples(self) -> tuple[Sample, ...]:
        """The samples, with the cycle once."""
        return tuple(move.sample for move in self.moves)


def accepting(moves: Moves, work: int = DEFAULT_WORK) -> Witness | None:
    """Return a shortest trace of samples that is accepted, or None if there is none.

    Over infinite traces it is any accepted trace.

    Raises:
        OutOfWork: over infinite traces, the search takes more than ``work`` steps.
    """
    fspa = moves.fspa
    if fspa.semantics == "infinite":
        return _lasso(moves, "accepting", work)
    return _to(moves, "accepting", [state.accepting for state in fspa.states])


def rejecting(moves: Moves, work: int = DEFAULT_WORK) -> Witness | None:
    """Return a shortest trace of samples after which success is no longer possible.

    If there is none, return a shortest rejected trace. Over infinite traces this is any rejected
    trace. Errors are as in :func:`accepting`.
    """
    fspa = moves.fspa
    broken = _to(moves, "rejecting", [state.verdict == "violated" for state in fspa.states])
    if fspa.semantics == "infinite":
        return _lasso(moves, "rejecting", work) if broken is None else _for_ever(moves, broken)
    return broken or _to(moves, "rejecting", [not state.accepting for state in fspa.states])


def _to(moves: Moves, kind: Kind, is_wanted: list[bool]) -> Witness | None:
    """Return a shortest trace to one of the wanted states."""
    edges = moves.fspa.edges
    way = moves.way(0, lambda edge: is_wanted[edges[edge].target])
    return None if way is None else Witness(kind, way)


def _for_ever(moves: Moves, trace: Witness) -> Witness | None:
    """Return the trace, which ends in a trap, with a loop in the trap as its cycle."""
    trap = moves.fspa.edges[trace.moves[-1].edge].target
    loop = moves.way(trap, lambda edge: moves.fspa.edges[edge].target == trap)
    return None if loop is None else Witness(trace.kind, (*trace.moves, *loop), len(trace.moves))


def _lasso(moves: Moves, kind: Literal["accepting", "rejecting"], work: int) -> Witness | None:
    """Return a lasso of edges that samples take.

    Edges that no sample takes are closed one by one as they are found.
    """
    from tltlc.automaton.compare import separating

    everything = _constant(moves.fspa, accepts=True)
    closed: set[int] = set()
    while True:
        if kind == "accepting":
            trace = separating(_without(moves.fspa, closed, accepts=False), _constant(moves.fspa, accepts=False), work)
        else:
            trace = separating(everything, _without(moves.fspa, closed, accepts=True), work)
        if trace is None:
            return None
        edges = _edges(moves.fspa, (*trace.prefix, *trace.cycle))
        edge_moves = [moves.move(edge) for edge in edges]
        missing = {edge for edge, move in zip(edges, edge_moves, strict=True) if move is None}
        if not missing:
            return Witness(kind, tuple(move for move in edge_moves if move is not None), len(trace.prefix))
        closed |= missing


def _edges(fspa: Fspa, letters: tuple[Letter, ...]) -> list[int]:
    """Return the edges that a trace takes."""
    state, indices = 0, []
    for letter in letters:
        holds = [atom.name in letter for atom in fspa.atoms]
        for index, edge in enumerate(fspa.edges):
            if edge.source == state and any(
                all(holds[atom] == polarity for atom, polarity in prime) for prime in edge.guard.primes
            ):
                indices.append(index)
                state = edge.target
                break
    return indices


def _constant(fspa: Fspa, accepts: bool) -> Fspa:
    """Return an automaton over the same atoms that accepts every infinite trace, or none."""
    state = replace(fspa.states[0], id=0)
    edge = Edge(0, 0, Guard(TRUE, ((),)))
    pairs = (Pair((), (0,)),) if accepts else ()
    return replace(fspa, states=(state,), edges=(edge,), acceptance=pairs)


def _without(fspa: Fspa, closed: set[int], accepts: bool) -> Fspa:
    """Return the automaton with the closed edges redirected to a new state.

    From that state on, everything is accepted, or nothing is.
    """
    if not closed:
        return fspa
    sink = len(fspa.states)
    state: State = replace(fspa.states[0], id=sink)
    edges = [replace(edge, target=sink) if index in closed else edge for index, edge in enumerate(fspa.edges)]
    loop = Edge(sink, sink, Guard(TRUE, ((),)))
    pairs = [
        Pair(
            tuple(edge_index for edge_index in pair.fin if edge_index not in closed),
            tuple(edge_index for edge_index in pair.inf if edge_index not in closed),
        )
        for pair in fspa.acceptance
    ]
    if accepts:
        pairs.append(Pair((), (len(edges),)))
    return replace(fspa, states=(*fspa.states, state), edges=(*edges, loop), acceptance=tuple(pairs))
