"""The last lines that a game wrote to its standard error."""

from __future__ import annotations

import os
import re
import threading
from typing import IO, Final

from tltlc.api import fileio

_CHUNK: Final = 1 << 16
_TO_END_S: Final = 5.0
"""Seconds in which the rest of the standard error of an ended process arrives."""
_COLOUR: Final = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")


class StderrTail:
    """Reads a pipe in a thread, so that the game can always write to it, and keeps the last bytes."""

    def __init__(self, pipe: IO[bytes]) -> None:
        self._pipe = pipe
        self._data = b""
        self._is_cut = False
        """Whether the first line of the data may be a part of a line."""
        self._thread = threading.Thread(target=self._read, name="standard error of a game", daemon=True)
        self._thread.start()

    def lines_so_far(self) -> list[str]:
        """Return the last whole lines that have been read so far, without control characters."""
        lines = _COLOUR.sub("", self._data.decode(errors="replace")).splitlines()
        if self._is_cut and len(lines) > 1:
            del lines[0]
        return [_printable(line) for line in lines if line.strip()]

    def lines(self) -> list[str]:
        """Return the last lines, without control characters. Call this after the process has ended."""
        self._thread.join(_TO_END_S)
        return self.lines_so_far()

    def _read(self) -> None:
        with self._pipe:
            while chunk := os.read(self._pipe.fileno(), _CHUNK):
                self._is_cut = self._is_cut or len(self._data) + len(chunk) > fileio.limits.WIRE_STDERR.size
                self._data = (self._data + chunk)[-fileio.limits.WIRE_STDERR.size :]


def _printable(line: str) -> str:
    return "".join(char if char.isprintable() else " " for char in line).rstrip()
