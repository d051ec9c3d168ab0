"""Find where a JSON object or array ends while its bytes come in, so that its length need not be known."""

from __future__ import annotations

import re
from typing import Final

_OUTSIDE: Final = re.compile(rb'["\[\]{}]')
_INSIDE: Final = re.compile(rb'[^"\\]*(?:\\.[^"\\]*)*', re.DOTALL)
"""A string up to its closing quotation mark, or as far as its bytes have come."""
_QUOTE: Final = ord('"')


class JsonEnd:
    """Follows the brackets of one JSON text; it looks at each byte once, and checks nothing else."""

    def __init__(self) -> None:
        self._at = 0
        self._depth = 0
        self._in_string = False

    def find(self, data: bytearray, limit: int) -> int | None:
        """Return the offset behind the bracket that closes the first one; None if it is not in ``data[:limit]``.

        The next call takes the same bytes and more.
        """
        limit = min(limit, len(data))
        while self._at < limit:
            if self._in_string:
                if not self._leave_string(data, limit):
                    return None
                continue
            found = _OUTSIDE.search(data, self._at, limit)
            self._at = found.end() if found else limit
            if found and self._follow(found[0]):
                return self._at
        return None

    def _leave_string(self, data: bytearray, limit: int) -> bool:
        """Whether the string ends; if not, the next call goes on where its bytes end, or at half an escape."""
        found = _INSIDE.match(data, self._at, limit)
        self._at = found.end() if found else limit
        if self._at == limit or data[self._at] != _QUOTE:
            return False
        self._at += 1
        self._in_string = False
        return True

    def _follow(self, mark: bytes) -> bool:
        """Whether this bracket closes the first one."""
        if mark == b'"':
            self._in_string = True
            return False
        self._depth += 1 if mark in b"[{" else -1
        return self._depth <= 0
