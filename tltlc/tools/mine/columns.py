"""Find the columns of traces. They decide which atoms exist, so they are read before the samples."""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import IntEnum
from typing import Final

from tltlc.core.names import split_name
from tltlc.core.source import SourceKind
from tltlc.monitor.trace_rows import TraceLines, TraceTable, cell_number, read_rows

MONITOR_COLUMNS: Final = ("step", "state", "verdict", "progress", "reward")
"""The columns before those of the atoms in the output of ``tltlc monitor``."""


class ColumnKind(IntEnum):
    """The kind of a column: which values it has. A column with values of several kinds has the greatest of these."""

    TRUTHS = 0
    """0, 1, true or false."""
    SHARES = 1
    """Numbers in [0, 1]."""
    ROBUSTNESS = 2
    """Numbers in [-1, 1], some of which are negative, as robustness values are. An atom holds where its is above 0."""
    OTHER = 3
    """Other values."""


_NamedCells = Sequence[tuple[str, ColumnKind]]


def columns(data: bytes, name: str, kind: SourceKind = "file") -> dict[str, ColumnKind]:
    """Map each column of a trace, in order, to its kind.

    ``data`` is the content of the file, ``name`` the name of the trace in messages, and ``kind`` its
    kind of source. In JSON lines, the columns are the keys of the objects. A column that is missing
    in some sample is left out.

    Raises:
        TltlError: TLT0622, a line cannot be read.
    """
    kinds: dict[str, ColumnKind] = {}
    count = 0
    row_counts: dict[str, int] = {}
    for row in _rows(TraceLines(io.BytesIO(data), name, kind)):
        count += 1
        for column, cell_kind in row:
            kinds[column] = max(kinds.get(column, ColumnKind.TRUTHS), cell_kind)
        # A repeated column is an error only if a signal is read from it.
        for column in {column for column, _ in row}:
            row_counts[column] = row_counts.get(column, 0) + 1
    # A line of JSON may leave a signal out. Then the signal is not a column of the trace.
    return {column: column_kind for column, column_kind in kinds.items() if row_counts[column] == count}


def common_columns(all_columns: Iterable[Mapping[str, ColumnKind]]) -> dict[str, ColumnKind]:
    """Map each column that all traces have to its kind.

    ``all_columns`` has the result of :func:`columns` for each trace, of which there must be at least
    one. The columns are in the order of the first trace. Columns that are about other entities, such as
    ``near(s1)`` and ``near(s2)``, are all robustness values if one of them is. So are all columns that
    ``tltlc monitor`` writes for atoms, and its other columns are of the kind ``OTHER``.
    """
    first, *rest = all_columns
    kinds = {
        name: max((kind, *(columns[name] for columns in rest)))
        for name, kind in first.items()
        if all(name in columns for columns in rest)
    }
    if kinds.keys() >= {*MONITOR_COLUMNS}:
        kinds |= dict.fromkeys(MONITOR_COLUMNS, ColumnKind.OTHER)
        robust = {*kinds}
    else:
        bases = {split_name(name)[0] for name, kind in kinds.items() if kind == ColumnKind.ROBUSTNESS}
        robust = {name for name in kinds if split_name(name)[0] in bases}
    return {name: max(kind, ColumnKind.ROBUSTNESS) if name in robust else kind for name, kind in kinds.items()}


def _rows(lines: TraceLines) -> Iterator[_NamedCells]:
    trace = read_rows(lines)
    if isinstance(trace, TraceTable):
        for cells in trace.rows:
            yield [(name, _kind(cell_number(cell))) for name, cell in zip(trace.header, cells, strict=True)]
    elif trace is not None:
        for values in trace.rows:
            yield [(name, _kind(value if isinstance(value, (int, float)) else None)) for name, value in values.items()]


def _kind(value: float | None) -> ColumnKind:
    if value is None or not -1.0 <= value <= 1.0:
        return ColumnKind.OTHER
    if value < 0.0:
        return ColumnKind.ROBUSTNESS
    return ColumnKind.TRUTHS if value in (0.0, 1.0) else ColumnKind.SHARES
