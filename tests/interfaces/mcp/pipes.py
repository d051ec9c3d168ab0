"""Named pipes that keep a process reading, so that a test knows when the process runs and when it has ended."""

from __future__ import annotations

import os
from pathlib import Path

from tests.waiting import until


def open_for_writing(pipe: Path) -> int:
    """Open a named pipe as soon as a process reads from it."""

    def opened() -> int | None:
        try:
            return os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
        except OSError:
            return None

    return until(opened, "a process that reads the pipe")  # type: ignore[return-value]


def wait_until_broken(writing: int) -> None:
    """Wait until no process reads from a pipe any more, and close it."""

    def is_broken() -> bool:
        try:
            os.write(writing, b" ")
        except BrokenPipeError:
            return True
        except BlockingIOError:
            return False
        return False

    until(is_broken, "the end of the process that reads the pipe")
    os.close(writing)
