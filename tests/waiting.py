"""Wait for events instead of fixed times; the deadlines only end a test that hangs."""

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
"""Seconds after which a test counts as hanging, even on a busy machine.  Pass it as every ``timeout``."""


def until(event: Callable[[], Found], what: str, pause_s: float = 0.02) -> Found:
    """Wait until ``event()`` is true, and return its value; raise AssertionError after ``HANG_S`` seconds."""
    deadline = time.monotonic() + HANG_S
    while not (value := event()):
        assert time.monotonic() < deadline, f"waited {HANG_S:g} s in vain for {what}"
        time.sleep(pause_s)
    return value


def printed(program: str, data: bytes = b"") -> bytes:
    """Run a Python program with ``data`` as its input, and return its output; it may take ``HANG_S`` seconds.

    The program runs in a new process, because code such as a regular expression cannot be interrupted.
    """
    words = [sys.executable, "-c", program]
    return subprocess.run(words, input=data, capture_output=True, timeout=HANG_S, check=True).stdout


def is_running(pid: int) -> bool:
    """Whether a process exists and has not ended, on Linux."""
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    except OSError:
        return False


def until_gone(pids: Iterable[int]) -> None:
    """Wait until all processes have ended."""
    waited = tuple(pids)
    until(lambda: not any(map(is_running, waited)), f"the end of the processes {waited}")


def children(pid: int) -> list[int]:
    """Return the processes that the main thread of a process started, on Linux."""
    try:
        return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="utf-8").split()]
    except OSError:
        return []


def until_it_reads(pid: int, descriptor: int = 0) -> None:
    """Wait until a process blocks in a read of a file descriptor, on Linux."""

    def reads() -> bool:
        # The file has the number of the system call and its arguments, of which the descriptor is the first.
        words = Path(f"/proc/{pid}/syscall").read_text(encoding="ascii").split()
        return len(words) > 2 and int(words[1], 16) == descriptor and int(words[0]) == _READ

    until(reads, f"the process {pid} to read")


_READ: Final = {"x86_64": 0, "aarch64": 63}.get(platform.machine(), 0)
"""The number of the system call ``read`` on this machine."""
