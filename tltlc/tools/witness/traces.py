"""Find a shortest trace that a spec accepts, and one that it rejects, as samples of its signals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from tltlc.automaton.fspa import Edge, Fspa, Guard, Pair, State
from tltlc.automaton.work import DEFAULT_WORK
from tltlc.core.record import record, replace
from tltlc.logic.formula import TRUE
from tltlc.tools.witness.transitions import Moves, SampledEdge

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter
    from tltlc.monitor.traces import TraceSample

WitnessKind = Literal["accepting", "rejecting", "cover"]


@record
class Witness:
    """A trace, as a sequence of moves.

    A move is an edge with a sample that takes it. The moves from index ``cycle`` on repeat for
    ever; ``cycle`` is None for a finite trace. For a trace of a cover, ``new_steps`` has the
    numbers, from 1, of the steps that take an edge for the first time in the cover.
    """

    kind: WitnessKind
    moves: tuple[SampledEdge, ...]
    cycle: int | None = None
    new_steps: tuple[int, ...] = ()

    @property
    def letters(self) -> tuple[Letter, ...]:
        """The letters of the moves, with one round of the cycle."""
        return tuple(move.letter for move in self.moves)

    @property
    def samples(self) -> tuple[TraceSample, ...]:
        """The samples of the moves, with one round of the cycle."""
        return tuple(move.sample for move in self.moves)


def accepting_trace(moves: Moves, work: int = DEFAULT_WORK) -> Witness | None:
    """Return a shortest accepted trace for which samples are found.

    If the spec is over infinite traces or has registers, the trace need not be a shortest one. Return None if no trace
    is accepted, or if no samples are found for any accepted trace.

    Raises:
        OutOfWork: over infinite traces, the search takes more than ``work`` steps.
    """
    fspa = moves.fspa
    if fspa.semantics == "infinite":
        return _decided(moves, "accepting") if fspa.registers else _lasso(moves, "accepting", work)
    return _shortest_to(moves, "accepting", [state.accepting for state in fspa.states])


def rejecting_trace(moves: Moves, work: int = DEFAULT_WORK) -> Witness | None:
    """Return a rejected trace for which samples are found.

    If possible, it is a shortest trace that violates the spec. Otherwise it is a shortest rejected
    trace, or any rejected trace if the spec is over infinite traces. Return None if no trace is
    rejected, or if no samples are found.

    Raises:
        OutOfWork: over infinite traces, the search takes more than ``work`` steps.
    """
    fspa = moves.fspa
    if fspa.semantics == "infinite" and fspa.registers:
        return _decided(moves, "rejecting")
    violating = _shortest_to(moves, "rejecting", [state.verdict == "violated" for state in fspa.states])
    if fspa.semantics == "infinite":
        return _lasso(moves, "rejecting", work) if violating is None else _with_loop(moves, violating)
    return violating or _shortest_to(moves, "rejecting", [not state.accepting for state in fspa.states])


def _shortest_to(moves: Moves, kind: WitnessKind, is_target: list[bool]) -> Witness | None:
    """Return a shortest trace to one of the target states; ``is_target`` says for each state whether it is one.

    Return None if no path with samples leads to a target state.
    """
    edges = moves.fspa.edges
    path = moves.shortest_path(0, lambda edge: is_target[edges[edge].target])
    return None if path is None else Witness(kind, path)


def _decided(moves: Moves, kind: Literal["accepting", "rejecting"]) -> Witness | None:
    """Return an infinite trace of an automaton with registers whose verdict becomes final; None if none is found.

    Its last step repeats for ever: whatever comes then makes no difference.
    """
    verdict = "satisfied" if kind == "accepting" else "violated"
    edges, states = moves.fspa.edges, moves.fspa.states

    def repeats(edge: int) -> bool:
        source, target = edges[edge].source, edges[edge].target
        return source == target and states[target].verdict == verdict

    path = moves.shortest_path(0, repeats)
    return None if path is None else Witness(kind, path, len(path) - 1)


def _with_loop(moves: Moves, trace: Witness) -> Witness | None:
    """Return an infinite trace: ``trace``, which ends in a trap, and then a loop in the trap.

    Return None if no samples are found for a loop.
    """
    trap = moves.fspa.edges[trace.moves[-1].edge].target
    loop = moves.shortest_path(trap, lambda edge: moves.fspa.edges[edge].target == trap)
    return None if loop is None else Witness(trace.kind, (*trace.moves, *loop), len(trace.moves))


def _lasso(moves: Moves, kind: Literal["accepting", "rejecting"], work: int) -> Witness | None:
    """Return an accepted or rejected infinite trace: a prefix and a cycle, with a sample for each step.

    If no sample is found for an edge of the trace, the search is repeated without this edge. Return
    None if no trace is left.
    """
    from tltlc.automaton.compare import separating

    all_traces = _constant(moves.fspa, accepts=True)
    closed: set[int] = set()
    while True:
        if kind == "accepting":
            trace = separating(
                _with_closed_edges(moves.fspa, closed, accepts=False), _constant(moves.fspa, accepts=False), work
            )
        else:
            trace = separating(all_traces, _with_closed_edges(moves.fspa, closed, accepts=True), work)
        if trace is None:
            return None
        edges = _edges(moves.fspa, (*trace.prefix, *trace.cycle))
        edge_moves = [moves.move(edge) for edge in edges]
        missing = {edge for edge, move in zip(edges, edge_moves, strict=True) if move is None}
        if not missing:
            return Witness(kind, tuple(move for move in edge_moves if move is not None), len(trace.prefix))
        closed |= missing


def _edges(fspa: Fspa, letters: tuple[Letter, ...]) -> list[int]:
    """Return the indices of the edges that a trace takes."""
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
    """Return an automaton over the same atoms that accepts every infinite trace, or no trace."""
    state = replace(fspa.states[0], id=0)
    edge = Edge(0, 0, Guard(TRUE, ((),)))
    pairs = (Pair((), (0,)),) if accepts else ()
    return replace(fspa, states=(state,), edges=(edge,), acceptance=pairs)


def _with_closed_edges(fspa: Fspa, closed: set[int], accepts: bool) -> Fspa:
    """Return an automaton in which the edges in ``closed`` lead to a new state, which is never left.

    So a trace that takes one of these edges is accepted if ``accepts`` is true, and else rejected.
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
