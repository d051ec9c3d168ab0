from __future__ import annotations

import io

import pytest

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor.sample_times import SampleTimes, times_fit
from tltlc.monitor.traces import read_trace
from tltlc.resolve.spec import Signal

SEEN = (Signal("seen", "bool", 0.0, 1.0),)


@pytest.mark.parametrize(
    ("times", "clock_s"),
    [
        ([0.0, 0.1, 0.2], 0.1),
        ([7.0, 7.1, 7.2], 0.1),
        ([0.0, 0.017, 0.033, 0.05, 0.067], 1 / 60),
        ([0.0, 0.14, 0.2, 0.26, 0.4], 0.1),
        ([0.101 * sample for sample in range(2000)], 0.1),
        ([0.0, 3.0, 4.0], None),
        ([0.0], 0.1),
    ],
    ids=["exact", "another start", "rounded to milliseconds", "jitter", "a slow clock", "no clock", "one sample"],
)
def test_these_times_fit(times: list[float], clock_s: float | None) -> None:
    assert times_fit(times, clock_s)


@pytest.mark.parametrize(
    ("times", "clock_s"),
    [
        ([0.0, 0.1, 0.3], 0.1),
        ([0.1 * sample + 0.1 * (sample > 1500) for sample in range(2000)], 0.1),
        ([0.0, 0.05, 0.1, 0.15, 0.2], 0.1),
        ([0.11 * sample for sample in range(20)], 0.1),
        ([0.0, 0.1, 0.1], None),
        ([0.0, 0.2, 0.1], None),
        ([0.0, float("nan")], None),
        ([0.0, float("inf")], 0.1),
    ],
    ids=[
        "a sample is missing",
        "missing late",
        "twice the rate",
        "a tenth slow",
        "twice",
        "backwards",
        "nan",
        "infinite",
    ],
)
def test_these_times_do_not_fit(times: list[float], clock_s: float | None) -> None:
    assert not times_fit(times, clock_s)


def _read(text: str, clock_s: float | None = 0.1, signals: tuple[Signal, ...] = SEEN) -> int:
    return len(list(read_trace(io.BytesIO(text.encode()), "trace", signals, clock_s)))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("time,seen\n0,1\n0.1,1\n0.3,0\n", 4),
        ("time,seen\n0,1\nnoon,1\n", 3),
        ('{"time": 0, "seen": true}\n{"time": 0.3, "seen": true}\n', 2),
        ('{"time": 0, "seen": true}\n\n{"time": "x", "seen": true}\n', 3),
    ],
)
def test_the_line_with_a_wrong_time_is_named(text: str, line: int) -> None:
    with pytest.raises(TltlError) as error:
        _read(text)
    (diagnostic,) = error.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == ("TLT0623", f"the time in line {line} of the trace is wrong")
    assert diagnostic.help is not None


@pytest.mark.parametrize("second", ['{"seen": true}', '{"Time": 0.1, "seen": true}'])
def test_every_row_has_its_time_or_none(second: str) -> None:
    with pytest.raises(TltlError, match="TLT0622: line 2 of the trace"):
        _read(f'{{"time": 0, "seen": true}}\n{second}\n')
    with pytest.raises(TltlError, match="TLT0622: line 2 of the trace"):
        _read('{"seen": true}\n{"time": 0, "seen": true}\n')


def test_two_columns_with_times_are_an_error() -> None:
    with pytest.raises(TltlError, match="TLT0622"):
        _read("time,time,seen\n0,0,1\n")


def test_a_signal_called_time_is_not_checked() -> None:
    signals = (*SEEN, Signal("time", "number", None, None))
    assert _read("time,seen\n5,1\n3,1\n", signals=signals) == 2


@pytest.mark.parametrize(
    ("times", "words"),
    [
        ((0.0, 0.3), "this is 0.3 s after the sample before, and the clock has one every 0.1 s"),
        ((0.0, 0.03), "until here there is a sample every 0.03 s, and the clock has one every 0.1 s"),
        ((0.0, 0.0), "the time is 0 s, and the sample before is at 0 s"),
        ((0.5, 0.4), "the time is 0.4 s, and the sample before is at 0.5 s"),
    ],
)
def test_the_problem_says_what_the_clock_has(times: tuple[float, ...], words: str) -> None:
    check = SampleTimes(0.1)
    assert [check.problem(time) for time in times] == [None, words]


def test_a_column_with_times_may_have_any_capitals() -> None:
    with pytest.raises(TltlError, match="TLT0623"):
        _read("Time,seen\n0,1\n0.3,1\n")
