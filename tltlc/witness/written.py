"""Witnesses as text: ``test`` blocks and CSV, each run by the monitor before it is given out."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.monitor.traces import read_trace
from tltlc.witness.blocks import expectations, test_block, values
from tltlc.witness.samples import csv_text
from tltlc.witness.traces import Witness


def as_test(fspa: Fspa, witness: Witness, title: str) -> str:
    """A ``test`` block that passes: what is said at the end, and where a cover is asked for, at each change of state.

    Raises:
        ValueError: the spec has no atoms.
    """
    monitor = Monitor(fspa)
    _check(fspa, witness, [monitor.step_atoms(values(fspa, letter)).state for letter in witness.letters])
    edges = [fspa.edges[move.edge] for move in witness.moves]
    steps = [
        number
        for number, edge in enumerate(edges, start=1)
        if number == len(edges) or (witness.kind == "cover" and edge.source != edge.target)
    ]
    block = test_block(title, fspa, witness.letters, expectations(fspa, witness.letters, steps))
    said = cycle_text(witness)
    return f"// {said[0].upper()}{said[1:]}.\n{block}" if said else block


def as_csv(fspa: Fspa, witness: Witness) -> str:
    """A trace of samples, the cycle of an infinite one once, that takes the edges which it should."""
    text = csv_text(fspa, witness.samples)
    monitor = Monitor(fspa)
    trace = read_trace(text.encode().splitlines(keepends=True), "the witness", fspa.signals)
    _check(fspa, witness, [monitor.step(sample).state for sample in trace])
    return text


def cycle_text(witness: Witness) -> str:
    """Which steps of an infinite trace repeat; empty where none do."""
    if witness.cycle is None:
        return ""
    first, last = witness.cycle + 1, len(witness.moves)
    if first == last:
        return f"step {last} repeats for ever; here it stands once"
    return f"steps {first} to {last} repeat for ever; here they stand once"


def _check(fspa: Fspa, witness: Witness, states: list[int]) -> None:
    wanted = [fspa.edges[move.edge].target for move in witness.moves]
    if states != wanted:
        raise AssertionError(f"a witness of `{fspa.name}` takes the states {states}, not {wanted}")
