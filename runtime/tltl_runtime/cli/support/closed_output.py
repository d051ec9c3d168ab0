"""Output that nobody reads any more: no reason to end a command whose results are files."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from io import BufferedWriter, FileIO, TextIOWrapper
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer


@contextmanager
def on_without_readers() -> Iterator[None]:
    """Within, what is printed into a pipe that was closed, as ``head`` closes it, is lost, and the command goes on."""
    before = sys.stdout, sys.stderr
    made = []
    for name, stream in (("stdout", sys.stdout), ("stderr", sys.stderr)):
        try:
            number = stream.fileno()
        except (OSError, ValueError):
            # Standard output of a test, say, is no file of the system.
            continue
        if not stream.isatty():
            stream.flush()
            binary = BufferedWriter(_Lossy(number, "wb", closefd=False))
            made.append(TextIOWrapper(binary, stream.encoding, stream.errors, line_buffering=True))
            setattr(sys, name, made[-1])
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
        for each in made:
            each.flush()


class _Lossy(FileIO):
    """A file that takes what its pipe does not."""

    def write(self, data: ReadableBuffer, /) -> int:
        """The number of bytes that were taken."""
        try:
            return super().write(data)
        except BrokenPipeError:
            return memoryview(data).nbytes
