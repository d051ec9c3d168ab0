"""What is said of witnesses: their titles, and why there are none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.work import OutOfWork
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.tools.witness.cover import Untaken
from tltlc.tools.witness.traces import Witness
from tltlc.tools.witness.transitions import Moves

_MOST_NAMED = 10
"""Edges that are named one by one."""


def title(fspa: Fspa, witness: Witness, number: int = 1, of: int = 1) -> str:
    """The title of a witness's test; ``number`` counts those of a cover, from 1."""
    if witness.kind == "cover":
        return f"{fspa.name}: way {number} of {of} through its automaton"
    if witness.cycle is not None:
        return f"{fspa.name}: a trace that is {'accepted' if witness.kind == 'accepting' else 'rejected'}"
    if witness.kind == "accepting":
        return f"{fspa.name}: a shortest trace that is accepted"
    last = fspa.states[fspa.edges[witness.moves[-1].edge].target]
    return f"{fspa.name}: a shortest trace that {'breaks it' if last.verdict == 'violated' else 'is rejected'}"


def no_trace(moves: Moves, what: str) -> Diagnostic:
    """The warning that no trace is accepted, or rejected; where it is for want of samples, with the reason."""
    fspa = moves.fspa
    if moves.obstacles:
        edge, obstacles = min(moves.obstacles.items())
        way_out = f"edge {_edge(fspa, edge)}: {_none_found(' or '.join(each.text(fspa) for each in obstacles[:2]))}"
        return Diagnostic(
            "TLT0741", f"no samples were found that `{fspa.name}` would have {what}", (), way_out, "warning"
        )
    way_out = f"`tltlc explain` says what it asks for; weaken it where it should be {what} at times"
    if what == "rejected":
        way_out = "it asks nothing of the game, or nothing that can fail"
    return Diagnostic("TLT0741", f"no trace is {what} by `{fspa.name}`", (), way_out, "warning")


def untaken(fspa: Fspa, edges: Sequence[Untaken]) -> list[Diagnostic]:
    """Warnings for edges that no trace takes."""
    found = []
    for each in edges[:_MOST_NAMED]:
        guard = fspa.edges[each.edge].guard.text
        name = f"the edge {_edge(fspa, each.edge)} of `{fspa.name}` (`{guard}`)"
        if each.obstacles:
            reasons = " or ".join(obstacle.text(fspa) for obstacle in each.obstacles[:2])
            text, way_out = "no samples were found that take", f"{_none_found(reasons)} at once"
            if all(len(obstacle.literals) == 1 for obstacle in each.obstacles):
                way_out = _none_found(reasons)
        else:
            text, way_out = "no way was found to", "the state that it leaves is reached by edges alone that none takes"
        found.append(Diagnostic("TLT0740", f"{text} {name}", (), way_out, "warning"))
    if len(edges) > _MOST_NAMED:
        rest = len(edges) - _MOST_NAMED
        text = f"no trace takes {rest} more edge{'s' * (rest > 1)} of `{fspa.name}`"
        found.append(Diagnostic("TLT0740", text, (), "write fewer atoms over the same signals", "warning"))
    return found


def no_atoms(fspa: Fspa) -> Diagnostic:
    """The error of a spec without atoms, for which no trace can be written."""
    return Diagnostic(
        "TLT0742", f"`{fspa.name}` has no atoms, so a trace of it says nothing", help="name an atom in it"
    )


def no_signals(fspa: Fspa) -> Diagnostic:
    """The error of a spec that reads no signal, for which no CSV can be written."""
    title = f"`{fspa.name}` reads no signal, so a CSV trace of it has no columns"
    return Diagnostic("TLT0742", title, help="ask for `--as test`, or name a signal in it")


def _none_found(wanted: str) -> str:
    """Why there is no sample; the search proves nothing, so this does not say that there can be none."""
    return f"no values of the signals were found that give {wanted}"


@contextmanager
def out_of_work(fspa: Fspa) -> Iterator[None]:
    """Error TLT0743 where the search for an infinite trace takes too long."""
    try:
        yield
    except OutOfWork:
        text = f"the search for an infinite trace of `{fspa.name}` takes too many steps"
        way_out = "raise `--state-budget`, or ask for `--cover`"
        raise TltlError([Diagnostic("TLT0743", text, help=way_out)]) from None


def _edge(fspa: Fspa, index: int) -> str:
    edge = fspa.edges[index]
    return f"{edge.source} -> {edge.target}"
