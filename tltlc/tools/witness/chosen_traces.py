"""Find the traces of a spec that a user asks for, and say which of them do not exist."""

from __future__ import annotations

from collections.abc import Container
from typing import TYPE_CHECKING

from tltlc.tools.witness import captions, cover, traces

if TYPE_CHECKING:
    from tltlc.diagnostics.diagnostic import Diagnostic
    from tltlc.tools.witness.traces import Witness, WitnessKind
    from tltlc.tools.witness.transitions import Moves


def chosen_traces(
    moves: Moves, kinds: Container[WitnessKind], work: int
) -> tuple[tuple[Witness, ...], tuple[Diagnostic, ...]]:
    """Return the traces of the chosen kinds, and a warning for each trace that was not found.

    ``moves`` are the transitions of the automaton. The kinds are ``accepting`` (one trace),
    ``rejecting`` (one trace) and ``cover`` (traces that together take every edge).

    Errors: :class:`~tltlc.diagnostics.diagnostic.TltlError` if a search takes more than ``work`` steps.
    """
    found: list[Witness] = []
    warnings: list[Diagnostic] = []
    with captions.reporting_out_of_work(moves.fspa):
        if "accepting" in kinds:
            trace = traces.accepting_trace(moves, work)
            found += [trace] if trace else []
            warnings += [] if trace else [captions.no_trace_warning(moves, "accepted")]
        if "rejecting" in kinds:
            trace = traces.rejecting_trace(moves, work)
            found += [trace] if trace else []
            warnings += [] if trace else [captions.no_trace_warning(moves, "rejected")]
    if "cover" in kinds:
        all_edges = cover.cover(moves)
        found += all_edges.traces
        warnings += captions.untaken_warnings(moves.fspa, all_edges.untaken)
    return tuple(found), tuple(warnings)
