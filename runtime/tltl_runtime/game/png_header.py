"""What the first bytes of a PNG picture say."""

from __future__ import annotations

import struct
from typing import Final

_SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"
_HEADER: Final = struct.Struct(">I4sII")
"""The first chunk: its length, its name ``IHDR``, and the width and height of the picture, in pixels."""


def png_size(data: bytes) -> tuple[int, int] | None:
    """Return the width and height of a PNG picture, in pixels; None if ``data`` does not begin like one."""
    if not data.startswith(_SIGNATURE) or len(data) < len(_SIGNATURE) + _HEADER.size:
        return None
    length, name, width, height = _HEADER.unpack_from(data, len(_SIGNATURE))
    return (width, height) if (length, name) == (13, b"IHDR") and width and height else None
