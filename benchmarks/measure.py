"""Measure CPU time in this process, and CPU time, wall time and memory of child processes."""

from __future__ import annotations

import gc
import json
import os
import resource
import signal
import statistics
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

CHILD_MEMORY_BYTES = 8 << 30
"""Address space of a child: enough for every peer, too little to exhaust the machine."""


@dataclass(frozen=True, slots=True)
class Run:
    """One run of a child process; times are in milliseconds and include the children that it waited for."""

    cpu_ms: float
    wall_ms: float
    output: str
    status: int
    timed_out: bool


def run(
    command: Sequence[str],
    timeout_s: float,
    text: str = "",
    cwd: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> Run:
    """Run a command to its end, or kill its process group after ``timeout_s`` seconds of wall time.

    ``text`` is its standard input; ``environment`` replaces the variables of this process. The
    ``output`` of the result is its standard output up to its end.
    """
    with tempfile.TemporaryFile() as standard_input, tempfile.TemporaryFile() as output:
        standard_input.write(text.encode())
        standard_input.seek(0)
        start = time.perf_counter()
        child = subprocess.Popen(
            command,
            stdin=standard_input,
            stdout=output,
            stderr=subprocess.DEVNULL,
            cwd=cwd,
            env=environment,
            start_new_session=True,
            preexec_fn=_limit_memory,
        )
        was_killed = threading.Event()

        def kill() -> None:
            was_killed.set()
            os.killpg(child.pid, signal.SIGKILL)

        timer = threading.Timer(timeout_s, kill)
        timer.start()
        try:
            # `wait4` returns the resources of this child; `getrusage` would add those of earlier children.
            _, status, usage = os.wait4(child.pid, 0)
            wall = time.perf_counter() - start
        finally:
            timer.cancel()
            timer.join()  # no thread is left when the next fork comes
        child.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        return Run(
            cpu_ms=(usage.ru_utime + usage.ru_stime) * 1e3,
            wall_ms=wall * 1e3,
            output=output.read().decode(errors="replace"),
            status=child.returncode,
            timed_out=was_killed.is_set(),
        )


def _limit_memory() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (CHILD_MEMORY_BYTES, CHILD_MEMORY_BYTES))


def cpu_times_ms(work: Callable[[], object], *, runs: int, enough_s: float) -> list[float]:
    """Return CPU times of ``work`` in milliseconds: at most ``runs``, and fewer once ``enough_s`` seconds are spent.

    Garbage is collected before each run, outside of its time; collections during a run count.
    """
    times: list[float] = []
    while len(times) < runs and sum(times) < enough_s * 1e3:
        gc.collect()
        before = cpu_s()
        work()
        times.append((cpu_s() - before) * 1e3)
    return times


def run_in_fork(work: Callable[[], dict[str, Any]]) -> dict[str, Any] | None:
    """Return the result of ``work`` in a fork of this process, with ``cpu_ms`` and ``peak_mb``; None if it raised.

    Modules are loaded already, but tables and caches that ``work`` fills are gone with the fork.
    Call this in a process without other threads: a fork copies their locks, but not the threads.
    """
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reader)
        try:
            before = cpu_s()
            result = work()
            spent_ms = (cpu_s() - before) * 1e3
            os.write(writer, json.dumps(result | {"cpu_ms": spent_ms, "peak_mb": peak_memory_mb()}).encode())
        finally:
            os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as stream:
        answer = stream.read()
    os.waitpid(child, 0)
    return json.loads(answer) if answer else None


def cpu_s() -> float:
    """Return the CPU time so far, in seconds, of this process and of the children that it has waited for."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def peak_memory_mb() -> float:
    """Return the greatest resident memory of this process so far, in MiB."""
    try:
        # Unlike `ru_maxrss` this does not begin with the memory of the process that started this one.
        status = Path("/proc/self/status").read_text(encoding="ascii")
        return next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmHWM:")) / 1024
    except (OSError, StopIteration):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def median(values: Sequence[float]) -> float:
    """Return the median; NaN if there are no values."""
    return statistics.median(values) if values else float("nan")


def quartiles(values: Sequence[float]) -> tuple[float, float, float]:
    """Return the lower quartile, the median and the upper quartile; three times the value if there is only one."""
    if len(values) < 2:
        return (median(values),) * 3
    lower, middle, upper = statistics.quantiles(values, n=4, method="inclusive")
    return lower, middle, upper
