"""Find the end of a JSON object or array while its bytes arrive, without knowing its length."""

from __future__ import annotations

import re
from typing import Final

_OUTSIDE: Final = re.compile(rb'["\[\]{}]')
_INSIDE: Final = re.compile(rb'[^"\\]*(?:\\.[^"\\]*)*', re.DOTALL)
"""A string up to its closing quotation mark, or up to the last byte so far."""
_QUOTE: Final = ord('"')


class JsonEnd:
    """Counts the brackets of one JSON text, to find its end.

    Looks at each byte once, and does not check the syntax.
    """

    def __init__(self) -> None:
        self._at = 0
        self._depth = 0
        self._in_string = False

    def find(self, data: bytearray, limit: int) -> int | None:
        """Return the offset just after the bracket that closes the first bracket.

        Return None if ``data[:limit]`` does not contain the closing bracket. Call again when more
        bytes have arrived; ``data`` must then start with the bytes of the previous call.
        """
        limit = min(limit, len(data))
        while self._at < limit:
            if self._in_string:
                if not self._leave_string(data, limit):
                    return None
                continue
            mark = _OUTSIDE.search(data, self._at, limit)
            self._at = mark.end() if mark else limit
            if mark and self._follow(mark[0]):
                return self._at
        return None

    def _leave_string(self, data: bytearray, limit: int) -> bool:
        """Move to the end of the current JSON string; return False if its end is not in ``data[:limit]``.

        After False, the next call resumes at ``limit``, or at an incomplete escape just before it.
        """
        match = _INSIDE.match(data, self._at, limit)
        self._at = match.end() if match else limit
        if self._at == limit or data[self._at] != _QUOTE:
            return False
        self._at += 1
        self._in_string = False
        return True

    def _follow(self, mark: bytes) -> bool:
        """Count a bracket or enter a string, and return whether ``mark`` closes the first bracket."""
        if mark == b'"':
            self._in_string = True
            return False
        self._depth += 1 if mark in b"[{" else -1
        return self._depth <= 0
