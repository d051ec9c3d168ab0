"""The titles of the traces that were found, and the diagnostics about traces that were not found."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.work import OutOfWork
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.tools.witness.cover import UntakenEdge
from tltlc.tools.witness.traces import Witness
from tltlc.tools.witness.transitions import Moves

_MOST_NAMED = 10
"""The most untaken edges that get a warning of their own."""
_SEARCH = "its atoms remember the trace so far, and the search for such a trace is not complete"


def title(fspa: Fspa, witness: Witness, number: int = 1, count: int = 1) -> str:
    """Return the title of the test that shows a trace.

    A cover is a set of traces that together take every edge. If the trace is part of a cover,
    ``number`` is its number, from 1, and ``count`` the number of traces in the cover.
    """
    if witness.kind == "cover":
        return f"{fspa.name}: way {number} of {count} through its automaton"
    if witness.cycle is not None or (fspa.registers and witness.kind == "accepting"):
        return f"{fspa.name}: a trace that is {'accepted' if witness.kind == 'accepting' else 'rejected'}"
    if witness.kind == "accepting":
        return f"{fspa.name}: a shortest trace that is accepted"
    last = fspa.states[fspa.edges[witness.moves[-1].edge].target]
    shortest = "" if fspa.registers else "shortest "
    return f"{fspa.name}: a {shortest}trace that {'breaks it' if last.verdict == 'violated' else 'is rejected'}"


def no_trace_warning(moves: Moves, outcome: str) -> Diagnostic:
    """Return the warning TLT0741, that no trace is accepted or rejected.

    ``outcome`` is ``accepted`` or ``rejected``. If there may be such a trace, but no samples were
    found for it, the warning says so.
    """
    fspa = moves.fspa
    if moves.obstacles:
        edge, obstacles = min(moves.obstacles.items())
        help_ = (
            f"edge {_edge(fspa, edge)}: {_none_found(' or '.join(obstacle.text(fspa) for obstacle in obstacles[:2]))}"
        )
        return Diagnostic(
            "TLT0741", f"no samples were found for a trace that is {outcome} by `{fspa.name}`", (), help_, "warning"
        )
    if fspa.registers:
        return Diagnostic("TLT0741", f"no trace was found that is {outcome} by `{fspa.name}`", (), _SEARCH, "warning")
    help_ = f"`tltlc explain` says what it requires; weaken it if some traces should be {outcome}"
    if outcome == "rejected":
        help_ = "it requires nothing of the game, or nothing that can fail"
    return Diagnostic("TLT0741", f"no trace is {outcome} by `{fspa.name}`", (), help_, "warning")


def untaken_warnings(fspa: Fspa, edges: Sequence[UntakenEdge]) -> list[Diagnostic]:
    """Return warnings about edges that no trace takes: one for each of the first edges, and one for the rest."""
    warnings = []
    for untaken_edge in edges[:_MOST_NAMED]:
        guard = fspa.edges[untaken_edge.edge].guard.text
        name = f"the edge {_edge(fspa, untaken_edge.edge)} of `{fspa.name}` (`{guard}`)"
        if untaken_edge.obstacles:
            reasons = " or ".join(obstacle.text(fspa) for obstacle in untaken_edge.obstacles[:2])
            text, help_ = "no samples were found that take", f"{_none_found(reasons)} at once"
            if all(len(obstacle.literals) == 1 for obstacle in untaken_edge.obstacles):
                help_ = _none_found(reasons)
        else:
            text, help_ = (
                "no way was found to",
                _SEARCH if fspa.registers else "the state that it leaves is reached only by edges that no trace takes",
            )
        warnings.append(Diagnostic("TLT0740", f"{text} {name}", (), help_, "warning"))
    if len(edges) > _MOST_NAMED:
        rest = len(edges) - _MOST_NAMED
        text = f"no trace takes {rest} more edge{'s' * (rest > 1)} of `{fspa.name}`"
        help_ = _SEARCH if fspa.registers else "use fewer atoms of the same signals"
        warnings.append(Diagnostic("TLT0740", text, (), help_, "warning"))
    return warnings


def no_atoms_error(fspa: Fspa) -> Diagnostic:
    """Return the error about a spec without atoms, for which no test can be written."""
    return Diagnostic("TLT0742", f"`{fspa.name}` has no atoms, so a trace of it says nothing", help="use an atom in it")


def no_signals_error(fspa: Fspa) -> Diagnostic:
    """Return the error about a spec that reads no signal, for which no CSV can be written."""
    title = f"`{fspa.name}` reads no signal, so a CSV trace of it has no columns"
    return Diagnostic("TLT0742", title, help="write `--as test`, or use a signal in it")


def _none_found(literals: str) -> str:
    """Return a sentence that says that no sample was found for these literals.

    It does not say that no sample exists, because the search may miss samples.
    """
    return f"no values of the signals were found that give {literals}"


@contextmanager
def reporting_out_of_work(fspa: Fspa) -> Iterator[None]:
    """Turn ``OutOfWork`` in the body into TltlError, TLT0743: the search for an infinite trace takes too long."""
    try:
        yield
    except OutOfWork:
        text = f"the search for an infinite trace of `{fspa.name}` takes too many steps"
        help_ = "raise `--state-budget`, or use `--cover`"
        raise TltlError([Diagnostic("TLT0743", text, help=help_)]) from None


def _edge(fspa: Fspa, index: int) -> str:
    edge = fspa.edges[index]
    return f"{edge.source} -> {edge.target}"
