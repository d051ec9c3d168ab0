"""Write JSON text that people can read and compare line by line."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from itertools import chain, islice
from typing import Any, Final

WIDTH: Final = 120
_PIECES: Final = 10_000
"""How many small pieces of text :func:`layout` joins before it yields them as one piece."""

Encode = Callable[[Any], str]

_unsafe = re.compile(
    "<(?=[/!])"
    "|[\x7f-\x9f\xad\u0600-\u0605\u061c\u06dd\u070f\u0890\u0891\u08e2\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff]"
    "|[\ufff9-\ufffb\ud800-\udfff\U000110bd\U000110cd\U00013430-\U0001343f\U0001bca0-\U0001bca3\U0001d173-\U0001d17a]"
    "|[\U000e0000-\U000e007f]"
)


def layout(document: Any) -> Iterator[str]:
    """Yield the JSON text of a document in pieces, to be written one after the other.

    A value that fits on a line of :data:`WIDTH` characters is written on one line, except the document
    itself. Keys keep their order. Characters that are invisible or change the direction of text are
    escaped. ``<`` is escaped in ``</`` and ``<!``, so that the text can be put into a script element of
    an HTML page. Numbers have their shortest form.

    Raises:
        ValueError: a number is not finite.
    """
    import json

    encoder = json.JSONEncoder(ensure_ascii=False, allow_nan=False)
    pieces = chain(_pieces(document, 0, 0, encoder.encode), ("\n",))
    while block := "".join(islice(pieces, _PIECES)):
        # The characters to escape occur only inside strings, and no string is split between two blocks.
        yield _unsafe.sub(_escape, block)


def _pieces(value: Any, indent: int, used: int, encode: Encode) -> Iterator[str]:
    """Yield the text of ``value``, on several lines if necessary.

    ``indent`` is the indentation of the line in characters, and ``used`` the number of characters
    that the key before the value takes up on the line.
    """
    flat = _flat(value, indent, used, encode)
    if flat is not None:
        yield flat
        return
    is_object = isinstance(value, dict)
    step = indent + 2
    separator = ("{" if is_object else "[") + "\n" + " " * step
    for key, item in value.items() if is_object else (("", element) for element in value):
        head = encode(key) + ": " if is_object else ""
        yield separator + head
        yield from _pieces(item, step, len(head), encode)
        separator = ",\n" + " " * step
    yield "\n" + " " * indent + ("}" if is_object else "]")


def _flat(value: Any, indent: int, used: int, encode: Encode) -> str | None:
    """Return the text of a value on one line; None if the value needs several lines."""
    if not isinstance(value, (dict, list)) or not value:
        return encode(value)
    # The outermost value always gets several lines.
    if indent == 0 or not _is_small(value):
        return None
    flat = encode(value)
    return flat if indent + used + len(flat) < WIDTH else None


def _is_small(value: Any) -> bool:
    """Whether a value may fit on a line: a quick estimate, without writing its text."""
    left, waiting = WIDTH, [value]
    while waiting and left > 0:
        part = waiting.pop()
        if isinstance(part, (dict, list)):
            left -= 2 * len(part)
            if left > 0:
                waiting += part.values() if isinstance(part, dict) else part
        else:
            left -= len(part) if isinstance(part, str) else 1
    return left > 0


def _escape(match: re.Match[str]) -> str:
    code = ord(match.group())
    if code > 0xFFFF:
        code -= 0x10000
        return f"\\u{0xD800 + (code >> 10):04x}\\u{0xDC00 + (code & 0x3FF):04x}"
    return f"\\u{code:04x}"
