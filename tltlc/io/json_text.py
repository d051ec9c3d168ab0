"""Read JSON within the limits of :mod:`tltlc.io.limits`."""

from __future__ import annotations

import json
from collections.abc import Callable
from math import isfinite
from pathlib import Path
from typing import Any, Final

from tltlc.io.limits import Limit

_WHOLE_NUMBERS: Final = range(-(2**63), 2**63)
_MOST_DIGITS: Final = 20
"""The most characters of an integer of 64 bits, including its sign."""


class JsonLimitError(ValueError):
    """Raised if the JSON exceeds a limit of its reader; the message names the limit."""


def loads(text: str | bytes, limit: Limit, parse_constant: Callable[[str], Any] | None = None) -> Any:
    """Return the value of a JSON text; ``parse_constant`` is as in :func:`json.loads`.

    An integer of more than 64 bits becomes a float, as in most readers of JSON. As a Python
    integer, it could cause an error later, and Python refuses to read integers of thousands of
    digits.

    Raises:
        JsonLimitError: the text nests deeper, or has more values, than ``limit`` allows.
        json.JSONDecodeError: the text is not JSON.
        ValueError: the text is not UTF-8.
        TypeError: ``text`` is neither a str nor bytes.
    """
    # This also counts commas inside strings: a small error, but it is fast.
    commas = text.count(b",") if isinstance(text, bytes) else str.count(text, ",")
    if limit.values is not None and commas >= limit.values:
        raise JsonLimitError(f"it contains more than {limit.values:,} values")
    try:
        value = json.loads(text, parse_int=_whole_number, parse_constant=parse_constant)
    except RecursionError:
        raise JsonLimitError("it nests too deep") from None
    if limit.depth is not None and _nests_deeper(value, limit.depth):
        raise JsonLimitError(f"it nests deeper than {limit.depth} levels")
    return value


def load(path: Path, limit: Limit) -> Any:
    """Return the value of a JSON file.

    Raises OSError, JsonLimitError for a file that is too large, and the errors of :func:`loads`.
    """
    with path.open("rb") as file:
        data = file.read(limit.size + 1)
    if len(data) > limit.size:
        raise JsonLimitError(f"it is larger than {limit.size >> 20} MiB")
    return loads(data, limit)


def first_non_finite(value: Any) -> str | None:
    """Return the first NaN or infinity in parsed JSON, as text such as ``-Infinity``; None if there is none.

    The function does not recurse, so the value may be nested to any depth.
    """
    pending = [value]
    while pending:
        part = pending.pop()
        if isinstance(part, float):
            if not isfinite(part):
                return json.dumps(part)
        elif isinstance(part, dict):
            pending.extend(reversed(part.values()))
        elif isinstance(part, list):
            pending.extend(reversed(part))
    return None


def _nests_deeper(value: Any, depth: int) -> bool:
    """Whether lists and objects nest more than ``depth`` levels deep.

    The function does not recurse, so the value may be nested to any depth.
    """
    level = [value] if isinstance(value, (dict, list)) else []
    for _ in range(depth):
        if not level:
            return False
        parts = (outer.values() if isinstance(outer, dict) else outer for outer in level)
        level = [inner for part in parts for inner in part if isinstance(inner, (dict, list))]
    return bool(level)


def _whole_number(digits: str) -> int | float:
    """Return the integer, or a float if it needs more than 64 bits; the float may be infinite."""
    if len(digits) <= _MOST_DIGITS and (number := int(digits)) in _WHOLE_NUMBERS:
        return number
    return float(digits)
