"""Shortest traces that a spec accepts and rejects, as samples of its signals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from tltlc.automaton.fspa import Edge, Fspa, Pair, State
from tltlc.automaton.infinite.work import DEFAULT_WORK
from tltlc.core.record import record, replace
from tltlc.tools.witness.samples import Sample
from tltlc.tools.witness.transitions import Move, Moves

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter

Kind = Literal["accepting", "rejecting", "cover"]


@record
class Witness:
    """A trace: its moves, of which those from ``cycle`` on repeat for ever; None over finite traces.

    ``news`` are the steps of a cover's trace, from 1, whose edge no step before them takes, in this trace or another.
    """

    kind: Kind
    moves: tuple[Move, ...]
    cycle: int | None = None
    news: tuple[int, ...] = ()

    @property
    def letters(self) -> tuple[Letter, ...]:
        """The letters, the cycle once."""
        return tuple(move.letter for move in self.moves)

    @property
    def samples(self) -> tuple[Sample, ...]:
        """The samples, the cycle once."""
        return tuple(move.sample for move in self.moves)


def accepting(moves: Moves, work: int = DEFAULT_WORK) -> Witness | None:
    """A shortest trace of samples that is accepted; over infinite traces any one. None where there is none.

    Raises:
        OutOfWork: over infinite traces, where the search takes more than ``work`` steps.
    """
    fspa = moves.fspa
    if fspa.semantics == "infinite":
        return _lasso(moves, "accepting", work)
    return _to(moves, "accepting", [state.accepting for state in fspa.states])


def rejecting(moves: Moves, work: int = DEFAULT_WORK) -> Witness | None:
    """A shortest trace of samples after which nothing can be accepted; where there is none, a shortest rejected one.

    Over infinite traces any one of the latter, and errors as of :func:`accepting`.
    """
    fspa = moves.fspa
    broken = _to(moves, "rejecting", [state.verdict == "violated" for state in fspa.states])
    if fspa.semantics == "infinite":
        return _lasso(moves, "rejecting", work) if broken is None else _for_ever(moves, broken)
    return broken or _to(moves, "rejecting", [not state.accepting for state in fspa.states])


def _to(moves: Moves, kind: Kind, is_wanted: list[bool]) -> Witness | None:
    """A shortest trace to one of the states that are wanted."""
    edges = moves.fspa.edges
    way = moves.way(0, lambda edge: is_wanted[edges[edge].target])
    return None if way is None else Witness(kind, way)


def _for_ever(moves: Moves, trace: Witness) -> Witness | None:
    """The trace, which ends in a trap, with what stays there as its cycle."""
    trap = moves.fspa.edges[trace.moves[-1].edge].target
    loop = moves.way(trap, lambda edge: moves.fspa.edges[edge].target == trap)
    return None if loop is None else Witness(trace.kind, (*trace.moves, *loop), len(trace.moves))


def _lasso(moves: Moves, kind: Literal["accepting", "rejecting"], work: int) -> Witness | None:
    """A lasso of the edges that samples take: the others are closed one by one as they come up."""
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
        taken = [moves.move(edge) for edge in edges]
        missing = {edge for edge, move in zip(edges, taken, strict=True) if move is None}
        if not missing:
            return Witness(kind, tuple(move for move in taken if move is not None), len(trace.prefix))
        closed |= missing


def _edges(fspa: Fspa, letters: tuple[Letter, ...]) -> list[int]:
    """The edges that a trace takes."""
    state, found = 0, []
    for letter in letters:
        holds = [atom.name in letter for atom in fspa.atoms]
        for index, edge in enumerate(fspa.edges):
            if edge.source == state and any(all(holds[a] == p for a, p in prime) for prime in edge.guard.primes):
                found.append(index)
                state = edge.target
                break
    return found


def _constant(fspa: Fspa, accepts: bool) -> Fspa:
    """An automaton over the same atoms that accepts every infinite trace, or none."""
    state = replace(fspa.states[0], id=0)
    edge = Edge(0, 0, replace(fspa.edges[0].guard, text="true", primes=((),)))
    pairs = (Pair((), (0,)),) if accepts else ()
    return replace(fspa, states=(state,), edges=(edge,), acceptance=pairs)


def _without(fspa: Fspa, closed: set[int], accepts: bool) -> Fspa:
    """The automaton with some edges led to a state of its own, from which on everything is accepted, or nothing is."""
    if not closed:
        return fspa
    sink = len(fspa.states)
    state: State = replace(fspa.states[0], id=sink)
    edges = [replace(edge, target=sink) if index in closed else edge for index, edge in enumerate(fspa.edges)]
    loop = Edge(sink, sink, replace(fspa.edges[0].guard, text="true", primes=((),)))
    pairs = [
        Pair(tuple(e for e in pair.fin if e not in closed), tuple(e for e in pair.inf if e not in closed))
        for pair in fspa.acceptance
    ]
    if accepts:
        pairs.append(Pair((), (len(edges),)))
    return replace(fspa, states=(*fspa.states, state), edges=(*edges, loop), acceptance=tuple(pairs))
