"""Unpack traces and tapes that are packed with gzip (RFC 1952)."""

from __future__ import annotations

import gzip
import io
import zlib
from shlex import quote
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.limits import TAPE

_MAGIC: Final = b"\x1f\x8b"
"""A file in gzip begins with these bytes, which no text in UTF-8 begins with."""


def is_packed(start: bytes) -> bool:
    """Whether a file is packed with gzip; ``start`` are its first bytes."""
    return start.startswith(_MAGIC)


def unpacked(data: bytes, name: str, too_large: str | None = None) -> bytes:
    """Return the unpacked bytes of a file; return a file that is not packed unchanged.

    ``name`` is the file's name in messages. ``too_large`` is the help for a file that is too large, by default
    how to judge it.

    Raises:
        TltlError: TLT0004, the file is too large; TLT0622, it is damaged.
    """
    if not is_packed(data):
        return data
    assert TAPE.unpacked is not None
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(data)) as file:
            text = file.read(TAPE.unpacked + 1)
    except (OSError, EOFError, zlib.error):
        title = f"`{name}` cannot be unpacked: it is cut off or damaged"
        raise TltlError([Diagnostic("TLT0622", title, help="use another copy, or record the play again")]) from None
    if len(text) > TAPE.unpacked:
        title = f"`{name}` has more than {TAPE.unpacked >> 20} MiB when it is unpacked"
        # Without `<`, `gunzip` reads no file whose name does not end in `.gz`.
        unpack = f"gunzip < {quote(name)} > whole.jsonl"
        judge = f"unpack it with `{unpack}`, and judge it alone: `tltlc monitor SPEC whole.jsonl` reads any size"
        raise TltlError([Diagnostic("TLT0004", title, help=too_large or judge)])
    return text
