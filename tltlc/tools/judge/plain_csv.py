"""Read plain CSV, without quotes, blanks and unusual numbers, column by column.

This takes a tenth of the time of :func:`tltlc.monitor.traces.read_trace`, which reads all other
traces and reports all errors.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from math import inf
from typing import Final

from tltlc.io.limits import TRACE_LINE
from tltlc.monitor.sample_times import times_name
from tltlc.resolve.spec import Signal

Column = list[float]

_DECIMAL: Final = re.compile(r"[0-9.,eE+-]*")
"""Matches numbers and commas. It does not match ``inf``, ``nan`` and ``1_000``, which ``float`` accepts."""

_TRUTHS: Final[Mapping[str, float]] = {
    **dict.fromkeys(("0", "0.0", "false", "False", "FALSE"), 0.0),
    **dict.fromkeys(("1", "1.0", "true", "True", "TRUE"), 1.0),
}


def plain_columns(data: bytes, signals: Sequence[Signal]) -> tuple[list[Column], Column | None] | None:
    """Return the values of each signal, and the times of the samples, if the trace is plain CSV.

    There is one column of values for each of ``signals``, in their order. The times are None if no
    column has them (:func:`~tltlc.monitor.sample_times.times_name`). All values are finite, and
    equal to those that :func:`~tltlc.monitor.traces.read_trace` reads.

    Return None instead of the pair if ``signals`` is empty, or if the trace is not plain, that is,
    if it has quotes, blanks, unusual numbers or an error.
    """
    if not signals:
        return None
    try:
        text = data.decode()
    except UnicodeDecodeError:
        return None
    text = text.replace("\r\n", "\n") if "\r" in text else text
    if text.startswith(("\ufeff", "{")) or any(character in text for character in '" \t\r\0'):
        return None
    header, *lines = text.removesuffix("\n").split("\n")
    names = header.split(",")
    rows = [line.split(",") for line in lines]
    # A line that is too long is an error, and so is a row with too many or too few cells.
    if not rows or (len(data) > TRACE_LINE.size and max(map(len, (header, *lines))) * 4 > TRACE_LINE.size):
        return None
    if any(len(row) != len(names) for row in rows):
        return None
    wanted = [signal.name for signal in signals]
    times_column = times_name(names, signals)
    if any(names.count(name) != 1 for name in (*wanted, *([times_column] if times_column else []))):
        return None
    cells = list(zip(*rows, strict=True))
    columns = [_values(cells[names.index(signal.name)], is_bool=signal.type == "bool") for signal in signals]
    times = _values(cells[names.index(times_column)], is_bool=False) if times_column else None
    if times is None and times_column:
        return None
    plain = [column for column in columns if column is not None]
    return (plain, times) if len(plain) == len(columns) else None


def _values(cells: Sequence[str], *, is_bool: bool) -> Column | None:
    """Return the cells of a column as numbers; None if a cell is unusual, such as ``1_000``, or not finite."""
    try:
        if not is_bool and _DECIMAL.fullmatch(",".join(cells)):
            values = list(map(float, cells))
            return values if min(values) > -inf and max(values) < inf else None
        return [_TRUTHS[cell] for cell in cells]
    except (ValueError, KeyError):
        return None
