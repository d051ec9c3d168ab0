"""Read JSON within the limits of :mod:`tltlc.io.limits`; no number in it is too large to be computed with."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from tltlc.io.limits import Limit

_WHOLE_NUMBERS: Final = range(-(2**63), 2**63)
_MOST_DIGITS: Final = 20
"""The most digits, with a sign, of a number in that range."""


class JsonLimitError(ValueError):
    """JSON that is larger than its reader takes; the message says how."""


def loads(text: str | bytes, limit: Limit, parse_constant: Callable[[str], Any] | None = None) -> Any:
    """The value in a text; ``parse_constant`` is called for ``NaN`` and ``Infinity``, as :func:`json.loads` has it.

    A whole number of more than 64 bits is a float, as in most readers of JSON: Python's own have no limit, and to make
    a float of a large one, or to read thousands of digits, fails.

    Raises:
        JsonLimitError: it nests deeper, or holds more values, than ``limit`` allows.
        json.JSONDecodeError: it is not JSON.
        ValueError: it is not UTF-8.
        TypeError: it is no text.
    """
    # Commas inside strings count, too: that errs by little, and takes no time.
    commas = text.count(b",") if isinstance(text, bytes) else str.count(text, ",")
    if limit.values is not None and commas >= limit.values:
        raise JsonLimitError(f"it holds more than {limit.values:,} values")
    try:
        value = json.loads(text, parse_int=_whole_number, parse_constant=parse_constant)
    except RecursionError:
        raise JsonLimitError("it nests too deep") from None
    if limit.depth is not None and _nests_deeper(value, limit.depth):
        raise JsonLimitError(f"it nests deeper than {limit.depth} levels")
    return value


def load(path: Path, limit: Limit) -> Any:
    """The value in a file; raises what :func:`loads` raises, and OSError."""
    with path.open("rb") as file:
        data = file.read(limit.size + 1)
    if len(data) > limit.size:
        raise JsonLimitError(f"it is larger than {limit.size >> 20} MiB")
    return loads(data, limit)


def _nests_deeper(value: Any, depth: int) -> bool:
    """Whether lists and objects stand in each other more than ``depth`` levels deep; takes no recursion."""
    level = [value] if isinstance(value, (dict, list)) else []
    for _ in range(depth):
        if not level:
            return False
        parts = (outer.values() if isinstance(outer, dict) else outer for outer in level)
        level = [inner for part in parts for inner in part if isinstance(inner, (dict, list))]
    return bool(level)


def _whole_number(digits: str) -> int | float:
    """The number, infinity beyond the range of floats."""
    if len(digits) <= _MOST_DIGITS and (number := int(digits)) in _WHOLE_NUMBERS:
        return number
    return float(digits)
