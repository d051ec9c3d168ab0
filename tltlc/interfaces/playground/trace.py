"""Run a trace that a user of the playground builds step by step, and suggest traces to start with."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain, repeat
from typing import Any, Final, Union

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import given_atoms
from tltlc.automaton.text import label_text
from tltlc.automaton.work import OutOfWork
from tltlc.monitor import Monitor
from tltlc.monitor.errors import MonitorError
from tltlc.monitor.failure import Failure
from tltlc.monitor.failure_words import failure_words
from tltlc.tools.witness.blocks import given_values
from tltlc.tools.witness.samples import SampleFinder
from tltlc.tools.witness.step_lengths import length_of, shortest_deadline_s
from tltlc.tools.witness.traces import Witness, accepting_trace, rejecting_trace
from tltlc.tools.witness.transitions import Moves, SampledEdge

PageLetter = Union[Sequence[str], Mapping[str, float]]
"""A step of a trace: the names of the atoms that hold, or the values of the signals by name."""

_MOST_WORK: Final = 200_000
"""How many steps of work the search for a trace may take, if the spec is over infinite traces."""
_LONGEST: Final = 200
"""The most steps of a suggested trace; the page shows it in a table."""


def rows(fspa: Fspa, letters: Iterable[PageLetter], lengths: Iterable[float | None] = ()) -> list[dict[str, Any]]:
    """Run the monitor on a trace, and return a row with its output for each step.

    ``letters`` are the inputs of the steps, and ``lengths`` the times since the steps before, in
    seconds; only a clock that varies needs them. A letter gives the names of the atoms that hold (unknown
    names, and those of atoms that follow from others, are ignored), or the values of the signals. In a
    row, ``from`` is the state before the step, ``values`` are the values of the atoms in order, and
    ``signals`` are values of the signals with which exactly these atoms hold; None if no such values
    were found, or if the automaton has registers, which depend on the steps before. From the step at
    which the trace fails, ``failure`` says at which step, by which atoms, and against which clause;
    before, it is None. If the monitor refuses a step, the row of the step has an ``error``, and is the last row.
    """
    monitor, finder = Monitor(fspa), None if fspa.registers else SampleFinder(fspa)
    result: list[dict[str, Any]] = []
    for letter, length in zip(letters, chain(lengths, repeat(None)), strict=False):
        dt = length if fspa.clock_varies else None
        before = monitor.state
        try:
            if isinstance(letter, Mapping):
                step = monitor.step(letter, dt)
                sample: object = {signal.name: float(letter[signal.name]) for signal in fspa.signals}
            else:
                step = monitor.step_atoms(given_values(fspa, frozenset(letter)), dt)
                sample = finder and finder.sample_for_letter(frozenset(letter))
        except MonitorError as error:
            result.append({"error": error.diagnostics[0].title, "help": error.diagnostics[0].help})
            break
        result.append(
            {
                "from": before,
                "state": step.state,
                "label": label_text(fspa, step.state),
                "verdict": step.verdict,
                "accepting": step.accepting,
                "done": step.done,
                "progress": step.progress,
                "reward": step.reward,
                "limiting": step.limiting,
                "failure": None if monitor.failure is None else _failure(fspa, monitor.failure),
                "values": list(monitor.values),
                "signals": sample if isinstance(sample, dict) else None,
            }
        )
    return result


def _failure(fspa: Fspa, failed: Failure) -> str:
    words = failure_words(fspa, failed)
    if failed.cause is None or failed.cause.clause is None:
        return words
    return f"{words}: `{fspa.clauses[failed.cause.clause]}`"


def idle_step(fspa: Fspa) -> dict[str, Any]:
    """Return the step that the page suggests for a new row of the trace, in which as little as possible happens.

    In this step, few atoms hold, and the automaton stays in the initial state if possible. ``atoms``
    has the names of the atoms that hold, and ``signals`` the values of the signals; None if no such
    values were found. ``dt`` is the time since the step before in seconds, that of the shortest deadline;
    None unless the clock varies.
    """
    return {**_idle_letter(fspa), "dt": shortest_deadline_s(fspa) if fspa.clock_varies else None}


def _idle_letter(fspa: Fspa) -> dict[str, Any]:
    def cost(prime: tuple[tuple[int, bool], ...]) -> int:
        return sum(polarity for _, polarity in prime)

    if fspa.registers:
        return _idle_step_with_registers(fspa)
    leaving = fspa.edges_from(0)
    edge = min(leaving, key=lambda edge: (edge.target != 0, fspa.states[edge.target].verdict == "violated"))
    finder = SampleFinder(fspa)
    primes = sorted(edge.guard.primes, key=cost)
    for prime in primes:
        sample = finder.sample_for_literals(prime)
        if isinstance(sample, dict):
            letter = finder.letter_of(sample)
            return {"atoms": _atom_names(fspa, letter), "signals": sample}
    return {"atoms": [fspa.atoms[atom].name for atom, polarity in primes[0] if polarity], "signals": None}


def _idle_step_with_registers(fspa: Fspa) -> dict[str, Any]:
    given = {fspa.atoms[index].name for index in given_atoms(fspa)}

    def cost(move: SampledEdge) -> tuple[bool, int, bool]:
        target = fspa.states[fspa.edges[move.edge].target]
        # The initial state may be that in which an answer is due: there, little happens in another one.
        return target.verdict == "violated", len(given & move.letter), target.id != 0

    moves = Moves(fspa).traces.first_moves()
    return _letter(fspa, min(moves, key=cost)) if moves else {"atoms": [], "signals": None}


def shortest_traces(fspa: Fspa) -> dict[str, Any]:
    """Return a shortest trace that succeeds and a shortest one that fails: ``{"succeed": …, "fail": …}``.

    A trace is a list of steps, each with ``atoms`` and ``signals``. It is None if there is no such
    trace, or if it is too long for the page. Both are None if one of the two searches takes too much
    work.
    """
    moves = Moves(fspa)
    try:
        witnesses = accepting_trace(moves, _MOST_WORK), rejecting_trace(moves, _MOST_WORK)
    except OutOfWork:
        witnesses = None, None
    return {"succeed": _letters(fspa, witnesses[0]), "fail": _letters(fspa, witnesses[1])}


def _letters(fspa: Fspa, witness: Witness | None) -> list[dict[str, Any]] | None:
    if witness is None or len(witness.moves) > _LONGEST:
        return None
    return [_letter(fspa, move) for move in witness.moves]


def _letter(fspa: Fspa, move: SampledEdge) -> dict[str, Any]:
    length = length_of(move.letter, fspa)
    return {
        "atoms": _atom_names(fspa, move.letter),
        "signals": {signal.name: move.sample[signal.name] for signal in fspa.signals},
        **({} if length is None else {"dt": length}),
    }


def _atom_names(fspa: Fspa, letter: frozenset[str]) -> list[str]:
    return [atom.name for atom in fspa.atoms if atom.name in letter]
