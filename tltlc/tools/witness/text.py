"""Witnesses as text: ``test`` blocks and CSV, each run by the monitor before it is given out."""

from __future__ import annotations

import io

from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.monitor.traces import read_trace
from tltlc.tools.witness.blocks import Blocks
from tltlc.tools.witness.samples import csv_text
from tltlc.tools.witness.traces import Witness


def as_test(fspa: Fspa, witness: Witness, title: str, blocks: Blocks | None = None) -> str:
    """A ``test`` block that passes: what is said at the end, and in a cover's trace behind each new change of state.

    ``blocks`` writes several of one automaton, in fewer steps than apart.

    Raises:
        ValueError: the spec has no atoms.
    """
    blocks = Blocks(fspa) if blocks is None else blocks
    letters = witness.letters
    _check(fspa, witness, [step.state for step in blocks.results(letters)])
    edges = [fspa.edges[move.edge] for move in witness.moves]
    changes = [number for number in witness.news if edges[number - 1].source != edges[number - 1].target]
    block = blocks.block(title, letters, blocks.expectations(letters, {*changes, len(letters)}))
    said = cycle_text(witness)
    return f"// {said[0].upper()}{said[1:]}.\n{block}" if said else block


def as_csv(fspa: Fspa, witness: Witness, monitor: Monitor | None = None) -> str:
    """A trace of samples, the cycle of an infinite one once, that takes the edges which it should.

    ``monitor`` runs several traces of one automaton; making one takes a look at every edge.
    """
    text = csv_text(fspa, witness.samples)
    monitor = Monitor(fspa) if monitor is None else monitor
    monitor.reset()
    trace = read_trace(io.BytesIO(text.encode()), "the witness", fspa.signals)
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
