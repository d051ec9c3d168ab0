"""Wait for events instead of fixed times. The deadlines only end tests that hang."""

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
"""Seconds after which a test counts as hanging, even on a busy machine.

Pass it as every ``timeout``.
"""


def until(event: Callable[[], Found], what: str, pause_s: float = 0.02) -> Found:
    """Wait until ``event()`` is true, and return its value.

    Raise AssertionError after ``HANG_S`` seconds; ``what`` describes the event in its message.
    """
    deadline = time.monotonic() + HANG_S
    while not (value := event()):
        assert time.monotonic() < deadline, f"waited {HANG_S:g} s in vain for {what}"
        time.sleep(pause_s)
    return value


def printed(program: str, data: bytes = b"") -> bytes:
    """Run a Python program with ``data`` as its input, and return its output.

    It may take ``HANG_S`` seconds. It runs in a new process, which can be killed: code such as a
    regular expression cannot be interrupted.
    """
    words = [sys.executable, "-c", program]
    return subprocess.run(words, input=data, capture_output=True, timeout=HANG_S, check=True).stdout


def is_running(pid: int) -> bool:
    """Whether a process exists and has not ended. It works on Linux."""
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    except OSError:
        return False


def until_gone(pids: Iterable[int]) -> None:
    """Wait until all processes have ended."""
    waited = tuple(pids)
    until(lambda: not any(map(is_running, waited)), f"the end of the processes {waited}")


def children(pid: int) -> list[int]:
    """Return the ids of the processes that a process started from its main thread, on Linux."""
    try:
        return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="utf-8").split()]
    except OSError:
        return []


def until_it_reads(pid: int, descriptor: int = 0) -> None:
    """Wait until a process blocks in a read of a file descriptor. It works on Linux."""

    def reads() -> bool:
        # The file contains the number of the system call, then its arguments. The first one is the descriptor.
        words = Path(f"/proc/{pid}/syscall").read_text(encoding="ascii").split()
        return len(words) > 2 and int(words[1], 16) == descriptor and int(words[0]) == _READ

    until(reads, f"the process {pid} to read")


_READ: Final = {"x86_64": 0, "aarch64": 63}.get(platform.machine(), 0)
"""The number of the system call ``read`` on this machine."""
