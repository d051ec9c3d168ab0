"""Where in a JSON text a value stands, so that messages can point at it."""

from __future__ import annotations

import re
from json import JSONDecoder
from typing import Union

from tltlc.core.source import Span

Path = tuple[Union[str, int], ...]
"""Keys and indices from the root, e.g. ``("states", 0, "id")``."""

_blank = re.compile(r"[ \t\n\r]*")
_step = re.compile(r"\.(\w+)|\[(\d+)\]")


def path_of(place: str) -> Path:
    """The path that ``data.states[0].id`` names."""
    return tuple(key or int(index) for key, index in _step.findall(place))


def span_of(text: str, path: Path) -> Span:
    """The span of the value at ``path`` in a valid JSON text, or of the longest part of the path that exists."""
    # Only places count; Python refuses to make whole numbers of thousands of digits.
    decoder = JSONDecoder(parse_int=float)
    start = _skip(text, 0)
    for step in path:
        inner = _value_start(decoder, text, start, step)
        if inner is None:
            break
        start = inner
    return Span(start, decoder.raw_decode(text, start)[1])


def _value_start(decoder: JSONDecoder, text: str, start: int, step: str | int) -> int | None:
    """Where the value of a key or an index begins inside the object or array at ``start``."""
    is_object = text[start] == "{"
    if text[start] not in "{[" or is_object != isinstance(step, str):
        return None
    position = _skip(text, start + 1)
    index = 0
    found = None
    while text[position] not in "}]":
        key: str | int = index
        if is_object:
            key, position = decoder.raw_decode(text, position)
            position = _skip(text, _skip(text, position) + 1)
        if key == step:
            found = position  # of equal keys the last one counts, as for the parser
            if not is_object:
                return found
        position = _skip(text, decoder.raw_decode(text, position)[1])
        if text[position] == ",":
            position = _skip(text, position + 1)
        index += 1
    return found


def _skip(text: str, position: int) -> int:
    """The first position from ``position`` on that holds no blank."""
    match = _blank.match(text, position)
    return match.end() if match else position
