"""Statistics, child processes and forks of the benchmarks."""

from __future__ import annotations

import gc
import math
import statistics
import subprocess
import sys
import textwrap
import threading
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.measure import cpu_times_ms, median, peak_memory_mb, quartiles, run
from tests.waiting import HANG_S, until

ROOT = Path(__file__).parents[2]
NUMBERS = st.lists(st.floats(-1e6, 1e6), min_size=1)


@given(NUMBERS)
def test_quartiles_are_in_order_around_the_median(values: list[float]) -> None:
    lower, middle, upper = quartiles(values)
    assert min(values) <= lower <= middle <= upper <= max(values)
    assert math.isclose(middle, statistics.median(values), abs_tol=1e-6)
    assert median(values) == statistics.median(values)


def test_the_median_of_nothing_is_nan() -> None:
    assert math.isnan(median([]))


def test_a_child_gets_input_and_its_output_is_read() -> None:
    result = run([sys.executable, "-c", "print(input()[::-1]); raise SystemExit(3)"], 30, "abc\n")
    assert (result.output, result.status, result.timed_out) == ("cba\n", 3, False)
    assert result.cpu_ms > 0


def test_the_cpu_time_of_a_grandchild_counts() -> None:
    burn = "import time\nwhile time.process_time() < 0.3: pass"
    result = run(
        [sys.executable, "-c", f"import subprocess, sys; subprocess.run([sys.executable, '-c', {burn!r}])"], 30
    )
    assert result.cpu_ms >= 300


def test_a_child_that_hangs_is_killed_and_its_output_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Timer(threading.Thread):
        """A timer that expires as soon as the child has written its file."""

        def __init__(self, seconds: float, function: Callable[[], None]) -> None:
            super().__init__()
            self._seconds, self._function = seconds, function

        def run(self) -> None:
            until((tmp_path / "told").exists, "a child that says something")
            assert self._seconds == 0.7
            self._function()

        def cancel(self) -> None:
            pass

    monkeypatch.setattr("benchmarks.measure.threading", SimpleNamespace(Timer=Timer, Event=threading.Event))
    hangs = "import time; print('so far', flush=True); open('told', 'w').close()\nwhile True: time.sleep(60)"
    result = run([sys.executable, "-c", hangs], 0.7, cwd=tmp_path)
    assert result.timed_out and result.output == "so far\n" and result.status != 0


def test_repetition_stops_when_enough_time_is_spent(monkeypatch: pytest.MonkeyPatch) -> None:
    spent = [0.0]

    def burn() -> None:
        spent[0] += 0.02

    monkeypatch.setattr("benchmarks.measure.cpu_s", lambda: spent[0])
    # The objects of the other tests make a collection slow.
    gc.freeze()
    try:
        assert len(cpu_times_ms(burn, runs=50, enough_s=0.05)) == 3
        assert len(cpu_times_ms(lambda: None, runs=4, enough_s=10)) == 4
    finally:
        gc.unfreeze()


def test_a_fork_does_not_change_the_parent() -> None:
    assert (
        alone(
            """
        seen = []

        def work():
            seen.append(1)
            return {"answer": len(seen)}

        print(run_in_fork(work)["answer"], run_in_fork(work)["answer"], seen)
        """
        )
        == "1 1 []\n"
    )


def test_a_fork_that_fails_returns_none() -> None:
    assert alone("print(run_in_fork(lambda: {'answer': 1 // 0}))") == "None\n"


def test_no_thread_is_left_before_a_fork() -> None:
    """From Python 3.12 on, forking beside other threads warns, and here warnings are errors."""
    assert alone("run([sys.executable, '-c', ''], 30); print(run_in_fork(lambda: {})['cpu_ms'] >= 0)") == "True\n"


def alone(program: str) -> str:
    """Return the output of a program in a new process: the process of the tests has threads, so it
    should not fork."""
    text = "import sys\nfrom benchmarks.measure import run_in_fork, run\n" + textwrap.dedent(program)
    command = [sys.executable, "-W", "error", "-c", text]
    return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True, timeout=HANG_S).stdout


def test_peak_memory_is_in_a_plausible_range() -> None:
    assert 5 < peak_memory_mb() < 100_000
