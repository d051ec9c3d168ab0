"""Write traces as ``test`` blocks and CSV, and check each text with the monitor first."""

from __future__ import annotations

import io

from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.monitor.traces import read_trace
from tltlc.tools.witness.blocks import BlockWriter
from tltlc.tools.witness.samples import csv_text
from tltlc.tools.witness.traces import Witness


def as_test(fspa: Fspa, witness: Witness, title: str, blocks: BlockWriter | None = None) -> str:
    """Return a trace as a ``test`` block that passes.

    The block expects what the monitor reports at the end. For a trace of a cover, it also expects
    what the monitor reports after each step that changes the state and takes an edge for the first
    time. Pass the same ``blocks`` for several traces of one automaton to save work.

    Raises:
        ValueError: the spec has no atoms.
    """
    blocks = BlockWriter(fspa) if blocks is None else blocks
    letters = witness.letters
    _check(fspa, witness, [step.state for step in blocks.results(letters)])
    edges = [fspa.edges[move.edge] for move in witness.moves]
    changes = [number for number in witness.new_steps if edges[number - 1].source != edges[number - 1].target]
    block = blocks.block(title, letters, blocks.expectations(letters, {*changes, len(letters)}))
    caption = cycle_text(witness)
    return f"// {caption[0].upper()}{caption[1:]}.\n{block}" if caption else block


def as_csv(fspa: Fspa, witness: Witness, monitor: Monitor | None = None) -> str:
    """Return the samples of a trace as CSV, with one round of its cycle if it is infinite.

    Pass the same ``monitor`` for several traces of one automaton to save work, because creating a
    monitor visits every edge.
    """
    text = csv_text(fspa, witness.samples)
    monitor = Monitor(fspa) if monitor is None else monitor
    monitor.reset()
    trace = read_trace(io.BytesIO(text.encode()), "the witness", fspa.signals, clock_varies=fspa.clock_varies)
    _check(fspa, witness, [monitor.step(sample).state for sample in trace])
    return text


def cycle_text(witness: Witness) -> str:
    """Say which steps of an infinite trace repeat: ``step 3 repeats for ever; here it is written once``.

    The text is empty for a finite trace.
    """
    if witness.cycle is None:
        return ""
    first, last = witness.cycle + 1, len(witness.moves)
    if first == last:
        return f"step {last} repeats for ever; here it is written once"
    return f"steps {first} to {last} repeat for ever; here they are written once"


def _check(fspa: Fspa, witness: Witness, states: list[int]) -> None:
    """Raise AssertionError if ``states``, which the monitor has visited, are not those of the trace."""
    expected = [fspa.edges[move.edge].target for move in witness.moves]
    if states != expected:
        raise AssertionError(f"a witness of `{fspa.name}` takes the states {states}, not {expected}")
