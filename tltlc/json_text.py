"""Read JSON within the limits of :mod:`tltlc.limits`."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

from tltlc.limits import Limit, too_deep, too_many
from tltlc.source import SourceFile


def parse(source: SourceFile, limit: Limit, parse_constant: Callable[[str], Any] | None = None) -> Any:
    """The value in a text; ``parse_constant`` is called for ``NaN`` and ``Infinity``, as :func:`json.loads` has it.

    Raises:
        TltlError: TLT0006, it nests deeper or holds more values than ``limit`` allows.
        json.JSONDecodeError: it is not JSON.
        ValueError: a whole number in it has thousands of digits.
    """
    # Commas inside strings count, too: that errs by little, and takes no time.
    if limit.values is not None and source.text.count(",") >= limit.values:
        raise too_many(source, limit)
    try:
        return json.loads(source.text, parse_constant=parse_constant)
    except RecursionError:
        raise too_deep(source, limit) from None
