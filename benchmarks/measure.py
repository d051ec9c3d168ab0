"""Measuring: CPU time in this process, and CPU time, wall time and memory of a child process."""

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
"""Address space that a child may take: enough for every peer, too little to bring the machine down."""


@dataclass(frozen=True, slots=True)
class Run:
    """One run of a child process; times in milliseconds, its own and those of the children it waited for."""

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

    ``text`` is its standard input, ``environment`` all of its variables (by default those of this process).
    ``output`` of the result holds its standard output, complete up to its end.
    """
    with tempfile.TemporaryFile() as standard_input, tempfile.TemporaryFile() as output:
        standard_input.write(text.encode())
        standard_input.seek(0)
        started = time.perf_counter()
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
        killed = threading.Event()

        def kill() -> None:
            killed.set()
            os.killpg(child.pid, signal.SIGKILL)

        timer = threading.Timer(timeout_s, kill)
        timer.start()
        try:
            # `wait4` has the resources of this child alone; `getrusage` would add up all that ever ran.
            _, status, used = os.wait4(child.pid, 0)
            wall = time.perf_counter() - started
        finally:
            timer.cancel()
            timer.join()  # no thread is left when the next fork comes
        child.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        return Run(
            cpu_ms=(used.ru_utime + used.ru_stime) * 1e3,
            wall_ms=wall * 1e3,
            output=output.read().decode(errors="replace"),
            status=child.returncode,
            timed_out=killed.is_set(),
        )


def _limit_memory() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (CHILD_MEMORY_BYTES, CHILD_MEMORY_BYTES))


def cpu_times_ms(work: Callable[[], object], *, runs: int, enough_s: float) -> list[float]:
    """CPU times in milliseconds of ``work``, at most ``runs`` of them, and no more once ``enough_s`` seconds are spent.

    Garbage is collected before each run, outside of its time; what a run itself collects counts.
    """
    times: list[float] = []
    while len(times) < runs and sum(times) < enough_s * 1e3:
        gc.collect()
        before = cpu_s()
        work()
        times.append((cpu_s() - before) * 1e3)
    return times


def forked(work: Callable[[], dict[str, Any]]) -> dict[str, Any] | None:
    """The result of ``work`` in a fork of this process, with ``cpu_ms`` and ``peak_mb``; None where it raised.

    Modules are loaded, but what a first call would leave in tables and caches is gone with the fork.
    Call it in a process without other threads: a fork copies their locks, and not the threads.
    """
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reader)
        try:
            before = cpu_s()
            result = work()
            spent = (cpu_s() - before) * 1e3
            os.write(writer, json.dumps(result | {"cpu_ms": spent, "peak_mb": peak_memory_mb()}).encode())
        finally:
            os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as stream:
        answer = stream.read()
    os.waitpid(child, 0)
    return json.loads(answer) if answer else None


def cpu_s() -> float:
    """CPU time so far, in seconds, of this process and of the children it has waited for."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def peak_memory_mb() -> float:
    """The greatest resident memory of this process so far, in megabytes (2**20 bytes)."""
    try:
        # Unlike `ru_maxrss` this does not begin with the memory of the process that started this one.
        status = Path("/proc/self/status").read_text(encoding="ascii")
        return next(int(line.split()[1]) for line in status.splitlines() if line.startswith("VmHWM:")) / 1024
    except (OSError, StopIteration):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def median(values: Sequence[float]) -> float:
    """The median; of none, NaN."""
    return statistics.median(values) if values else float("nan")


def quartiles(values: Sequence[float]) -> tuple[float, float, float]:
    """The lower quartile, the median and the upper quartile; of one value, that value thrice."""
    if len(values) < 2:
        return (median(values),) * 3
    lower, middle, upper = statistics.quantiles(values, n=4, method="inclusive")
    return lower, middle, upper
