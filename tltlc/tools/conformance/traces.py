"""Random traces, as the CSV files that a game might write."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import EMPTY
from tltlc.monitor import Monitor, MonitorError
from tltlc.monitor.exclusive import check_exclusive
from tltlc.monitor.samples import STEP_LENGTH, Samples
from tltlc.monitor.traces import read_trace
from tltlc.resolve.spec import Signal
from tltlc.tools.conformance.draw import Draw

Pools = Mapping[str, Sequence[float]]
"""Values to draw from, per signal."""

_OPEN: Final = 25.0
"""The range from which values are drawn if the range of a signal has no lower or no upper end.

Without a lower end, it begins at -_OPEN. Without an upper end, it is 2 * _OPEN wide.
"""
_ATTEMPTS: Final = 200
_TRIES: Final = 6


def table(columns: Sequence[str], rows: Iterable[Sequence[object]], end: str = "\n") -> bytes:
    """Return the content of a CSV file with this header and these rows.

    Cells are quoted only if necessary. Each line ends with ``end``.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator=end)
    writer.writerow(columns)
    writer.writerows(rows)
    return text.getvalue().encode()


def random_trace(
    fspa: Fspa,
    draw: Draw,
    length: int,
    pools: Pools = EMPTY,
    *,
    rejected: bool = False,
    step_lengths: Sequence[float] = (),
) -> bytes:
    """Return a random trace, as a CSV file, of ``length`` samples that a monitor accepts.

    ``pools`` gives, for some signals, the values to draw from. With ``rejected``, one more sample
    follows, which the monitor rejects. Each sample is drawn again until it fits, but at most
    ``_ATTEMPTS`` times; after that, the last one is taken anyway.

    If the clock varies, the trace has a column ``dt``, whose values are drawn from ``step_lengths``, in
    seconds.
    """
    # The predicates are compiled once here, not for each sample.
    atoms = Samples(fspa, None, [])
    registers = atoms.initial
    samples: list[Mapping[str, float]] = []
    for number in range(length + rejected):
        dt = {STEP_LENGTH: draw.choice(step_lengths)} if fspa.clock_varies else {}
        sample, registers = _sample(fspa, atoms, draw, pools, registers, dt, accepted=number < length)
        samples.append(sample)
    rows = [[_text(draw, signal, sample[signal.name]) for signal in fspa.signals] for sample in samples]
    columns = [signal.name for signal in fspa.signals]
    if fspa.clock_varies:
        columns.append("dt")
        rows = [[*row, repr(sample[STEP_LENGTH])] for row, sample in zip(rows, samples, strict=True)]
    return table(columns, rows)


def lively_trace(
    fspa: Fspa, draw: Draw, length: int, pools: Pools = EMPTY, step_lengths: Sequence[float] = ()
) -> bytes:
    """Draw several random traces, and return the one that visits the most states.

    Of those that visit equally many, return the one with the most steps before its verdict is final.
    ``step_lengths`` is that of :func:`random_trace`.
    """
    return max(
        [random_trace(fspa, draw, length, pools, step_lengths=step_lengths) for _ in range(_TRIES)],
        key=lambda trace: _liveliness(fspa, trace),
    )


def _liveliness(fspa: Fspa, trace: bytes) -> tuple[int, int]:
    """Return the number of states that a trace visits, and the number of steps before a final verdict."""
    monitor = Monitor(fspa)
    samples = read_trace(io.BytesIO(trace), "trace", fspa.signals, clock_varies=fspa.clock_varies)
    steps = [monitor.step(sample) for sample in samples]
    open_ = sum(step.verdict in ("holding", "pending") for step in steps)
    return len({step.state for step in steps}), open_


def _sample(
    fspa: Fspa,
    atoms: Samples,
    draw: Draw,
    pools: Pools,
    registers: tuple[float, ...],
    dt: Mapping[str, float],
    accepted: bool,
) -> tuple[dict[str, float], tuple[float, ...]]:
    """Return a random sample that a monitor accepts, or one that it rejects if ``accepted`` is false.

    ``registers`` are the values of the registers before the sample; those after it are returned, too.
    ``dt`` has the length of the step if the clock varies.
    Samples are drawn until one fits. After ``_ATTEMPTS`` samples, the last one is returned anyway.
    """
    for _ in range(_ATTEMPTS):
        sample = {signal.name: _value(draw, signal, pools.get(signal.name, ())) for signal in fspa.signals}
        sample.update(dt)
        after = _registers_after(fspa, atoms, sample, registers)
        if (after is not None) == accepted:
            break
    return sample, registers if after is None else after


def _registers_after(
    fspa: Fspa, atoms: Samples, sample: Mapping[str, float], registers: tuple[float, ...]
) -> tuple[float, ...] | None:
    """Return the values of the registers after a sample, or None if a monitor rejects the sample.

    A monitor rejects it if an atom or register has no value, or if two exclusive atoms hold together.
    """
    try:
        values = atoms.values(sample, registers, 1)
        check_exclusive(fspa, values.atoms, 1)
    except MonitorError:
        return None
    return values.registers


def _value(draw: Draw, signal: Signal, pool: Sequence[float]) -> float:
    if pool:
        return draw.choice(pool)
    if signal.type == "bool":
        return float(draw.below(2))
    low = -_OPEN if signal.low is None else signal.low
    high = low + 2 * _OPEN if signal.high is None else signal.high
    choice = draw.below(12)
    if choice == 0:
        return draw.choice((low, high))
    if choice == 1:
        return draw.choice((0.0, -0.0)) if low <= 0.0 <= high else low
    if choice == 2:
        # A value out of range, if the range has ends; it is clamped.
        return draw.choice((low - 0.5, high + 0.5))
    return draw.between(low, high)


def _text(draw: Draw, signal: Signal, value: float) -> str:
    """Return the value of a signal as text, in one of several notations, drawn at random."""
    if signal.type == "bool" and draw.chance(0.7):
        return "true" if value else "false"
    if value == int(value) and draw.chance(0.7):
        return "-0" if repr(value) == "-0.0" else str(int(value))
    return repr(value)
