"""Find the position of a value in a JSON text, so that messages can point at it."""

from __future__ import annotations

import re
from json import JSONDecoder
from typing import Union

from tltlc.core.source import Span

JsonPath = tuple[Union[str, int], ...]
"""The keys and indices that lead from the whole document to a value, such as ``("states", 0, "id")``."""

_blank = re.compile(r"[ \t\n\r]*")


def span_of(text: str, path: JsonPath) -> Span:
    """Return the span of the value at ``path`` in a valid JSON text.

    If there is no such value, return the span of the innermost value on the path that exists.
    """
    # Only positions matter here, and Python refuses to convert numbers of thousands of digits to int.
    decoder = JSONDecoder(parse_int=float)
    start = _skip(text, 0)
    for step in path:
        inner = _value_start(decoder, text, start, step)
        if inner is None:
            break
        start = inner
    return Span(start, decoder.raw_decode(text, start)[1])


def _value_start(decoder: JSONDecoder, text: str, start: int, step: str | int) -> int | None:
    """Return the offset of the value of a key or an index in the object or array that begins at ``start``.

    Return None if the object or array has no such value.
    """
    is_object = text[start] == "{"
    if text[start] not in "{[" or is_object != isinstance(step, str):
        return None
    position = _skip(text, start + 1)
    index = 0
    value_start = None
    while text[position] not in "}]":
        key: str | int = index
        if is_object:
            key, position = decoder.raw_decode(text, position)
            position = _skip(text, _skip(text, position) + 1)
        if key == step:
            value_start = position  # If a key occurs twice, the last one counts, as in Python's parser.
            if not is_object:
                return value_start
        position = _skip(text, decoder.raw_decode(text, position)[1])
        if text[position] == ",":
            position = _skip(text, position + 1)
        index += 1
    return value_start


def _skip(text: str, position: int) -> int:
    """Return the first position from ``position`` on that is not white space."""
    match = _blank.match(text, position)
    return match.end() if match else position
