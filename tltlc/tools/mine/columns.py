"""Find the columns of traces. They decide which atoms exist, so they are read before the samples."""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Mapping, Sequence

from tltlc.core.source import SourceKind
from tltlc.monitor.trace_rows import TraceLines, TraceTable, cell_number, read_rows

_NamedCells = Sequence[tuple[str, bool]]


def columns(data: bytes, name: str, kind: SourceKind = "file") -> dict[str, bool]:
    """Map each column of a trace, in order, to whether all its values are 0, 1, true or false.

    ``data`` is the content of the file, ``name`` the name of the trace in messages, and ``kind`` its
    kind of source. In JSON lines, the columns are the keys of the objects. A column that is missing
    in some sample is left out.

    Raises:
        TltlError: TLT0622, a line cannot be read.
    """
    truths: dict[str, bool] = {}
    count = 0
    row_counts: dict[str, int] = {}
    for row in _rows(TraceLines(io.BytesIO(data), name, kind)):
        count += 1
        for column, is_truth in row:
            truths[column] = truths.get(column, True) and is_truth
        # A repeated column is an error only if a signal is read from it.
        for column in {column for column, _ in row}:
            row_counts[column] = row_counts.get(column, 0) + 1
    # A line of JSON may leave a signal out. Then the signal is not a column of the trace.
    return {column: is_truth for column, is_truth in truths.items() if row_counts[column] == count}


def common_columns(all_columns: Iterable[Mapping[str, bool]]) -> dict[str, bool]:
    """Map each column that all traces have to whether all its values in all traces are 0, 1, true or false.

    ``all_columns`` has the result of :func:`columns` for each trace, of which there must be at least
    one. The columns are in the order of the first trace.
    """
    first, *rest = all_columns
    return {
        name: is_truth and all(columns[name] for columns in rest)
        for name, is_truth in first.items()
        if all(name in columns for columns in rest)
    }


def _rows(lines: TraceLines) -> Iterator[_NamedCells]:
    trace = read_rows(lines)
    if isinstance(trace, TraceTable):
        for cells in trace.rows:
            yield [(name, cell_number(cell) in (0, 1)) for name, cell in zip(trace.header, cells, strict=True)]
    elif trace is not None:
        for values in trace.rows:
            yield [(name, isinstance(value, (int, float)) and value in (0, 1)) for name, value in values.items()]
