"""Run the tests several times, in random orders, beside busy processes.

The command is ``python -m tests.repeated_runs N BUSY [PYTEST …]``: N runs, BUSY busy processes, and
arguments for pytest.
"""

from __future__ import annotations

import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path

ROOT = Path(__file__).parents[1]
FAILED = ("FAILED ", "ERROR ")


def main(runs: int, busy: int, arguments: list[str]) -> int:
    """Run pytest ``runs`` times beside ``busy`` busy processes; return how many runs failed.

    Print one line for each run.
    """
    failed = 0
    with busy_processes(busy):
        for number in range(1, runs + 1):
            seed = random.randrange(10**6)
            start = time.monotonic()
            result = run(seed, arguments)
            minutes = (time.monotonic() - start) / 60
            lines = result.stdout.splitlines() or [""]
            print(f"run {number} of {runs}, seed {seed}, {minutes:.1f} min: {lines[-1].strip('= ')}", flush=True)
            if result.returncode:
                failed += 1
                log = Path(tempfile.gettempdir(), f"test-again-{seed}.log")
                log.write_text(result.stdout + result.stderr, encoding="utf-8")
                print(*(line for line in lines if line.startswith(FAILED)), f"all of it: {log}", sep="\n", flush=True)
    return failed


def run(seed: int, arguments: list[str]) -> subprocess.CompletedProcess[str]:
    """Run pytest once, in the random order of ``seed``.

    ``arguments`` come after the options that this function sets, and override them.
    """
    command = [sys.executable, "-m", "pytest", "-q", "-rfE", "-n", "2", "-m", "not slow"]
    order = ["--random-order", f"--random-order-seed={seed}"]
    return subprocess.run([*command, *order, *arguments], cwd=ROOT, capture_output=True, text=True, check=False)


@contextmanager
def busy_processes(count: int) -> Iterator[None]:
    """Run ``count`` busy processes until the block ends."""
    started = [get_context("spawn").Process(target=_work, args=(os.getpid(),), daemon=True) for _ in range(count)]
    for process in started:
        process.start()
    try:
        yield
    finally:
        for process in started:
            process.kill()
            process.join()


def _work(parent: int) -> None:
    while os.getppid() == parent:
        for _ in range(10**6):
            pass


if __name__ == "__main__":
    sys.exit(min(1, main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3:])))
