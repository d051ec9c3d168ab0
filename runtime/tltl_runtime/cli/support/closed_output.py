"""Let a command that writes files go on after its output pipe is closed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from io import BufferedWriter, FileIO, TextIOWrapper
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer


@contextmanager
def ignore_closed_pipe() -> Iterator[None]:
    """Within this context, discard output into a closed pipe instead of raising BrokenPipeError.

    A pipe is closed, for example, when ``head`` has read its ten lines.
    """
    before = sys.stdout, sys.stderr
    streams = []
    for name, stream in (("stdout", sys.stdout), ("stderr", sys.stderr)):
        try:
            number = stream.fileno()
        except (OSError, ValueError):
            # The stream has no file descriptor, for example in a test.
            continue
        if not stream.isatty():
            stream.flush()
            binary = BufferedWriter(_Lossy(number, "wb", closefd=False))
            streams.append(TextIOWrapper(binary, stream.encoding, stream.errors, line_buffering=True))
            setattr(sys, name, streams[-1])
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
        for lossy in streams:
            lossy.flush()


class _Lossy(FileIO):
    """A file that discards data if its pipe is closed."""

    def write(self, data: ReadableBuffer, /) -> int:
        """Write data, or discard it; return the number of bytes."""
        try:
            return super().write(data)
        except BrokenPipeError:
            return memoryview(data).nbytes
