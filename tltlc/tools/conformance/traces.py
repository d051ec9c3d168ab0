"""Traces as the CSV files that a game may write."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import EMPTY
from tltlc.monitor import Monitor, MonitorError
from tltlc.monitor.samples import Samples, check_exclusive
from tltlc.monitor.traces import read_trace
from tltlc.resolve.spec import Signal
from tltlc.tools.conformance.draw import Draw

Pools = Mapping[str, Sequence[float]]
"""Values to draw from, per signal."""

_OPEN: Final = 25.0
"""An open lower end counts as -_OPEN; an open upper end lies 2 * _OPEN above the lower end."""
_ATTEMPTS: Final = 200
_TRIES: Final = 6


def table(columns: Sequence[str], rows: Iterable[Sequence[object]], end: str = "\n") -> bytes:
    """Return a CSV file; cells are quoted only if necessary."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator=end)
    writer.writerow(columns)
    writer.writerows(rows)
    return text.getvalue().encode()


def drawn(fspa: Fspa, draw: Draw, length: int, pools: Pools = EMPTY, *, refused: bool = False) -> bytes:
    """Return a random trace of samples that the automaton accepts.

    If ``refused``, the last sample is one that it does not accept, if one is found.
    """
    samples = [_sample(fspa, draw, pools, sound=True) for _ in range(length)]
    if refused:
        samples.append(_sample(fspa, draw, pools, sound=False))
    rows = [[_text(draw, signal, sample[signal.name]) for signal in fspa.signals] for sample in samples]
    return table([signal.name for signal in fspa.signals], rows)


def lively(fspa: Fspa, draw: Draw, length: int, pools: Pools = EMPTY) -> bytes:
    """Return the one of several random traces that visits most states and stays undecided longest."""
    return max([drawn(fspa, draw, length, pools) for _ in range(_TRIES)], key=lambda trace: _life(fspa, trace))


def _life(fspa: Fspa, trace: bytes) -> tuple[int, int]:
    monitor = Monitor(fspa)
    steps = [monitor.step(sample) for sample in read_trace(io.BytesIO(trace), "trace", fspa.signals)]
    open_ = sum(step.verdict in ("holding", "pending") for step in steps)
    return len({step.state for step in steps}), open_


def _sample(fspa: Fspa, draw: Draw, pools: Pools, sound: bool) -> dict[str, float]:
    for _ in range(_ATTEMPTS):
        sample = {signal.name: _value(draw, signal, pools.get(signal.name, ())) for signal in fspa.signals}
        if _is_taken(fspa, sample) == sound:
            break
    return sample


def _is_taken(fspa: Fspa, sample: Mapping[str, float]) -> bool:
    try:
        check_exclusive(fspa, Samples(fspa, None, []).atom_values(sample, 1), 1)
    except MonitorError:
        return False
    return True


def _value(draw: Draw, signal: Signal, pool: Sequence[float]) -> float:
    if pool:
        return draw.one(pool)
    if signal.type == "bool":
        return float(draw.below(2))
    low = -_OPEN if signal.low is None else signal.low
    high = low + 2 * _OPEN if signal.high is None else signal.high
    choice = draw.below(12)
    if choice == 0:
        return draw.one((low, high))
    if choice == 1:
        return draw.one((0.0, -0.0)) if low <= 0.0 <= high else low
    if choice == 2:
        # A value out of range, if the range has ends; it is clamped.
        return draw.one((low - 0.5, high + 0.5))
    return draw.between(low, high)


def _text(draw: Draw, signal: Signal, value: float) -> str:
    """Return a number in one of its spellings."""
    if signal.type == "bool" and draw.chance(0.7):
        return "true" if value else "false"
    if value == int(value) and draw.chance(0.7):
        return "-0" if repr(value) == "-0.0" else str(int(value))
    return repr(value)
