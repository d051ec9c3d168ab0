"""Lookup tables of a monitor, computed once from the automaton."""

from __future__ import annotations

from tltlc.automaton.fspa import Edge, Fspa, State
from tltlc.core.record import record


@record
class MonitorTables:
    """What a monitor needs to know about each state; each tuple has one entry for each state.

    ``edges`` has the edges that leave the state. ``improving`` has the edges that lead from the
    state to a state nearer to a goal. ``base_progress`` is ``(spec_size - distance) / spec_size``:
    1 in a goal, 0 in a state with the greatest distance, and also 0 in a trap. ``ends_on_entry``
    says whether an episode ends when it enters the state, with ``termination="entry"``.
    """

    fspa: Fspa
    edges: tuple[tuple[Edge, ...], ...]
    improving: tuple[tuple[Edge, ...], ...]
    base_progress: tuple[float, ...]
    ends_on_entry: tuple[bool, ...]


def tables(fspa: Fspa) -> MonitorTables:
    """Compute the lookup tables that a monitor of this automaton needs."""
    edges: list[list[Edge]] = [[] for _ in fspa.states]
    for edge in fspa.edges:
        edges[edge.source].append(edge)
    improving = [[edge for edge in leaving if _improves(fspa, edge)] for leaving in edges]
    return MonitorTables(
        fspa,
        tuple(map(tuple, edges)),
        tuple(map(tuple, improving)),
        tuple(_base_progress(state.distance, fspa.spec_size) for state in fspa.states),
        tuple(ends_on_entry(fspa, state) for state in fspa.states),
    )


def ends_on_entry(fspa: Fspa, entered: State) -> bool:
    """Whether an episode ends when it enters a state, with ``termination="entry"``."""
    return entered.verdict in ("satisfied", "violated") or (fspa.judge == "goal" and entered.accepting)


def _improves(fspa: Fspa, edge: Edge) -> bool:
    before, after = fspa.states[edge.source].distance, fspa.states[edge.target].distance
    return before is not None and after is not None and after < before


def _base_progress(distance: int | None, spec_size: int) -> float:
    """Return the progress of a state, in [0, 1]: ``(spec_size - distance) / spec_size``.

    This is line 11 of Algorithm 1 (Gutiérrez-Sánchez et al. 2024). A trap, whose ``distance`` is
    None, has the progress 0.
    ▲ The paper divides by ``spec_size`` without exception. Here, if ``spec_size`` is 0, a goal has
    the progress 1.
    """
    if distance is None:
        return 0.0
    return (spec_size - distance) / spec_size if spec_size else 1.0
