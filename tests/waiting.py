"""Wait for events, not for times: every deadline here only ends a test that hangs."""

from __future__ import annotations

import platform
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final, TypeVar

Found = TypeVar("Found")

HANG_S: Final = 900.0
"""Seconds after which a test counts as hanging; no busy machine is that slow. Pass it as every ``timeout``."""


def until(event: Callable[[], Found], what: str, pause_s: float = 0.02) -> Found:
    """Wait until ``event()`` is true, and return its value; raise AssertionError after ``HANG_S`` seconds."""
    deadline = time.monotonic() + HANG_S
    while not (found := event()):
        assert time.monotonic() < deadline, f"waited {HANG_S:g} s in vain for {what}"
        time.sleep(pause_s)
    return found


def printed(program: str, data: bytes = b"") -> bytes:
    """What a Python program prints that gets ``data`` as its input; it ends after ``HANG_S`` seconds at the latest.

    It runs in a process of its own, for what cannot be interrupted, such as a regular expression at work.
    """
    words = [sys.executable, "-c", program]
    return subprocess.run(words, input=data, capture_output=True, timeout=HANG_S, check=True).stdout


def is_running(pid: int) -> bool:
    """Whether a process is there and has not ended, on Linux."""
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    except OSError:
        return False


def until_gone(pids: Iterable[int]) -> None:
    """Wait until all these processes have ended."""
    waited = tuple(pids)
    until(lambda: not any(map(is_running, waited)), f"the end of the processes {waited}")


def children(pid: int) -> list[int]:
    """The processes that the main thread of a process started, on Linux."""
    try:
        return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="utf-8").split()]
    except OSError:
        return []


def until_it_reads(pid: int, descriptor: int = 0) -> None:
    """Wait until a process sleeps in a read of a file descriptor that has nothing to give, on Linux."""

    def reads() -> bool:
        # The number of the system call comes first, then its arguments: what is read from is the first of them.
        words = Path(f"/proc/{pid}/syscall").read_text(encoding="ascii").split()
        return len(words) > 2 and int(words[1], 16) == descriptor and int(words[0]) == _READ

    until(reads, f"the process {pid} to read")


_READ: Final = {"x86_64": 0, "aarch64": 63}.get(platform.machine(), 0)
"""The number of the system call."""
