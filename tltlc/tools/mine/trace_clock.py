"""Find the clock of traces from the times of their samples, so that mined times are in seconds."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence

from tltlc.monitor.sample_times import SampleTimes, times_name
from tltlc.monitor.trace_rows import TraceLines, TraceTable, cell_number, read_rows
from tltlc.resolve.values import number_text
from tltlc.tools.mine.trace_letters import TraceFile


def trace_clock(files: Sequence[TraceFile]) -> float | None:
    """Return the time between two samples, which is the same in all traces, in seconds.

    There is a whole number of samples in a second or, for slower clocks, a round number of seconds
    between two samples. The result is None if a trace has no times, or if its times do not fit the clock as well as
    :class:`~tltlc.monitor.sample_times.SampleTimes` asks for.
    """
    all_times = []
    for file in files:
        times = list(_times(file))
        if None in times:
            return None
        all_times.append([time for time in times if time is not None])
    steps = sum(len(times) - 1 for times in all_times if times)
    seconds = sum(times[-1] - times[0] for times in all_times if times)
    if steps == 0 or not 0.0 < seconds < float("inf"):
        return None
    rate = steps / seconds
    clock_s = 1.0 / round(rate) if rate >= 1.0 else float(f"{1.0 / rate:.2g}")
    checks = [(SampleTimes(clock_s), times) for times in all_times]
    return clock_s if all(check.problem(time) is None for check, times in checks for time in times) else None


def clock_declaration(clock_s: float | None) -> str:
    """Return the declaration of a clock, with a newline at its end; empty for None."""
    if clock_s is None:
        return ""
    rate = round(1.0 / clock_s)
    is_rate = rate > 0 and 1.0 / rate == clock_s
    return f"clock {rate} Hz\n" if is_rate else f"clock {number_text(clock_s)} s\n"


def _times(file: TraceFile) -> Iterator[float | None]:
    """Yield the time of each sample of a trace, in seconds; None for a sample without a time."""
    trace = read_rows(TraceLines(io.BytesIO(file.data), file.name, file.kind))
    if isinstance(trace, TraceTable):
        name = times_name(trace.header, ())
        place = None if name is None else trace.header.index(name)
        for cells in trace.rows:
            yield None if place is None else cell_number(cells[place])
    elif trace is not None:
        for values in trace.rows:
            name = times_name(values, ())
            value = None if name is None else values[name]
            yield float(value) if isinstance(value, (int, float)) else None
