"""The fast reader of CSV reads what the reader of all traces reads, or nothing."""

from __future__ import annotations

import io
from math import isfinite

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.monitor.odd_bytes import csv_traces
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import TRACE_LINE
from tltlc.monitor.traces import read_trace
from tltlc.resolve.spec import Signal
from tltlc.tools.conformance.odd_traces import CELLS, LINES, MORE_VALUES, SIGNALS, VALUES
from tltlc.tools.judge.plain_csv import plain_columns

ODD = {**LINES, **CELLS, **VALUES, **MORE_VALUES}


def _strict(data: bytes) -> list[dict[str, float]] | None:
    """Return the samples of the reader of all traces; None if it refuses the trace, or a value is not finite."""
    try:
        samples = list(read_trace(io.BytesIO(data), "trace", SIGNALS))
    except TltlError:
        return None
    return samples if all(map(isfinite, (value for sample in samples for value in sample.values()))) else None


def _check(data: bytes) -> bool:
    """Check that both readers agree, and return whether the fast one takes the trace."""
    plain = plain_columns(data, SIGNALS)
    if plain is None:
        return False
    assert plain[1] is None
    names = [signal.name for signal in SIGNALS]
    assert [dict(zip(names, row, strict=True)) for row in zip(*plain[0], strict=True)] == _strict(data)
    return True


@pytest.mark.parametrize("trace", ODD.values(), ids=ODD)
def test_odd_traces_are_read_alike_or_left_to_the_other_reader(trace) -> None:  # type: ignore[no-untyped-def]
    _check(trace.trace)


@given(data=csv_traces())
def test_random_bytes_are_read_alike_or_left_to_the_other_reader(data: bytes) -> None:
    _check(data)


@given(rows=st.lists(st.tuples(st.floats(-1e9, 1e9), st.booleans()), min_size=1), other=st.text("ab01.", max_size=4))
def test_traces_as_programs_write_them_are_plain(rows: list[tuple[float, bool]], other: str) -> None:
    lines = "".join(f"{x!r},{other},{seen}\n" for x, seen in rows)
    assert _check(f"x,other,seen\n{lines}".encode())
    assert _check(f"x,other,seen\r\n{lines}".replace("\n", "\r\n").replace("\r\r", "\r").encode())


def test_times_are_read_too() -> None:
    signals = (Signal("seen", "bool", 0.0, 1.0),)
    assert plain_columns(b"time,seen\n0.0,1\n0.5,0\n", signals) == ([[1.0, 0.0]], [0.0, 0.5])
    assert plain_columns(b"seen\n1\n", signals) == ([[1.0]], None)
    assert plain_columns(b"time,seen\nnoon,1\n", signals) is None
    assert plain_columns(b"time,time,seen\n0,0,1\n", signals) is None
    assert plain_columns(b"Time,seen\n0.5,1\n", signals) == ([[1.0]], [0.5])
    assert plain_columns(b"time,seen\n5,1\n", (*signals, Signal("time", "number", None, None))) == (
        [[1.0], [5.0]],
        None,
    )


def test_a_header_that_is_too_long_is_not_plain() -> None:
    assert plain_columns(b"x,seen," + b"-" * TRACE_LINE.size + b"\n0.5,1,0\n", SIGNALS) is None


def test_a_spec_without_signals_has_no_columns() -> None:
    assert plain_columns(b"x\n1\n", ()) is None
