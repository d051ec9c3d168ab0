"""JSON text that people can read and compare line by line."""

from __future__ import annotations

import re
from typing import Any

WIDTH = 120

_unsafe = re.compile(
    "<(?=[/!])"
    "|[\x7f-\x9f\xad\u0600-\u0605\u061c\u06dd\u070f\u0890\u0891\u08e2\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff]"
    "|[\ufff9-\ufffb\ud800-\udfff\U000110bd\U000110cd\U00013430-\U0001343f\U0001bca0-\U0001bca3\U0001d173-\U0001d17a]"
    "|[\U000e0000-\U000e007f]"
)


def layout(document: Any) -> str:
    """The JSON text of a document: a value that fits on a line stands on one line, keys keep their order.

    Invisible and direction-changing characters are escaped, and so is what would end or comment
    out a script element of a page that the text is pasted into.  Numbers are in shortest form.

    Raises:
        ValueError: a number is not finite.
    """
    import json

    encoder = json.JSONEncoder(ensure_ascii=False, allow_nan=False)
    # These characters can only stand inside strings, so that escaping them in the whole text is right.
    return _unsafe.sub(_escape, _lines(document, 0, 0, encoder.encode)) + "\n"


def _lines(value: Any, indent: int, used: int, encode: Any) -> str:
    """``value``, which begins after ``used`` characters of its line (its key), on as many lines as it needs."""
    flat: str = encode(value)
    # The outermost level is always broken up, whatever its length.
    if not isinstance(value, (dict, list)) or not value or (indent + used + len(flat) < WIDTH and indent > 0):
        return flat
    step = indent + 2
    if isinstance(value, dict):
        keys = [encode(key) + ": " for key in value]
        items = [key + _lines(item, step, len(key), encode) for key, item in zip(keys, value.values(), strict=True)]
    else:
        items = [_lines(item, step, 0, encode) for item in value]
    start, end = ("{", "}") if isinstance(value, dict) else ("[", "]")
    separator = ",\n" + " " * step
    return f"{start}\n{' ' * step}{separator.join(items)}\n{' ' * indent}{end}"


def _escape(match: re.Match[str]) -> str:
    code = ord(match.group())
    if code > 0xFFFF:
        code -= 0x10000
        return f"\\u{0xD800 + (code >> 10):04x}\\u{0xDC00 + (code & 0x3FF):04x}"
    return f"\\u{code:04x}"
