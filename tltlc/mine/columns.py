"""Which columns traces have, seen before it is known which of them matter."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Final

from tltlc.json_text import loads
from tltlc.limits import TRACE_LINE

_TRUTHS: Final = {"true", "false", "1", "0", "1.0", "0.0"}


def columns(data: bytes) -> dict[str, bool]:
    """The columns of a trace in order, each with whether all its values are true or false.

    Lenient: what cannot be read is left to whoever reads the trace in earnest.
    """
    lines = data.decode(errors="replace").removeprefix("\ufeff").splitlines()
    first = next((line for line in lines if line.strip()), "")
    rows = _json(lines) if first.lstrip().startswith("{") else _csv(lines)
    found: dict[str, bool] = {}
    count = 0
    seen: dict[str, int] = {}
    for row in rows:
        count += 1
        for name, is_truth in row:
            found[name] = found.get(name, True) and is_truth
        # A column that stands twice is told by whoever reads it.
        for name in {name for name, _ in row}:
            seen[name] = seen.get(name, 0) + 1
    # A line of JSON may leave a signal out: then it is no column of the trace.
    return {name: is_truth for name, is_truth in found.items() if seen[name] == count}


def shared(all_columns: Iterable[Mapping[str, bool]]) -> dict[str, bool]:
    """The columns that all traces have, in the order of the first one; truths where they are so in all."""
    first, *others = all_columns
    return {
        name: is_truth and all(other[name] for other in others)
        for name, is_truth in first.items()
        if all(name in other for other in others)
    }


Row = Sequence[tuple[str, bool]]


def _csv(lines: Sequence[str]) -> Iterator[Row]:
    rows = csv.reader(lines, skipinitialspace=True)
    try:
        header = [cell.strip() for cell in next(rows, [])]
        for row in rows:
            if row:
                yield [(name, cell.strip().lower() in _TRUTHS) for name, cell in zip(header, row, strict=False)]
    except csv.Error:
        return


def _json(lines: Sequence[str]) -> Iterator[Row]:
    for line in lines:
        try:
            found = loads(line, TRACE_LINE) if line.strip() else None
        except (ValueError, RecursionError):
            continue
        if isinstance(found, dict):
            yield [(name, isinstance(value, (int, float)) and value in (0, 1)) for name, value in found.items()]
