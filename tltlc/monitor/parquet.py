"""Convert traces in Apache Parquet, https://parquet.apache.org, to traces in JSON lines."""

from __future__ import annotations

import json
from collections.abc import Collection
from typing import Any, Final

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.limits import PARQUET
from tltlc.monitor.packed import unpacked
from tltlc.monitor.sample_times import lengths_name, times_name
from tltlc.resolve.spec import Signal

_MAGIC: Final = b"PAR1"
"""A Parquet file begins and ends with these bytes."""

_ENDING: Final = ".parquet"


class _ColumnError(Exception):
    """Raised for columns that a trace cannot have; the message says why."""


def is_parquet(start: bytes, name: str) -> bool:
    """Whether a file is in Parquet, judged by the ending of its name, or by ``start``, its first bytes.

    A file in Parquet begins with ``PAR1``, followed by a control character that is neither a tab nor
    a line end. A trace in CSV may also begin with ``PAR1``, but not with such a character after it.
    """
    following = start[4:5]
    is_control = b"" < following < b" " and following not in (b"\t", b"\n", b"\r")
    return name.lower().endswith(_ENDING) or (start.startswith(_MAGIC) and is_control)


def as_text(data: bytes, name: str, signals: Collection[Signal] | None = None) -> bytes:
    """Convert a trace in Parquet to JSON lines, and unpack one in gzip; return any other trace unchanged.

    The arguments are those of :func:`json_lines`, and the errors those of this function and of
    :func:`~tltlc.monitor.packed.unpacked`.
    """
    return json_lines(data, name, signals) if is_parquet(data, name) else unpacked(data, name)


def json_lines(data: bytes, name: str, signals: Collection[Signal] | None = None) -> bytes:
    """Return a trace in Parquet as JSON lines, with an object for each row.

    ``name`` is the trace's name in messages. Columns of numbers and booleans keep their values, and
    a missing value is ``null``; those of enums may also be texts, the names of their values. Only the
    columns of ``signals`` and the times are read. If ``signals`` is None, all columns of numbers,
    booleans and texts are read.

    Raises:
        TltlError: TLT0730, pyarrow is not installed; TLT0622, the file is not valid; TLT0004, it is
            too large.
    """
    try:
        import pyarrow
        from pyarrow import parquet
    except ModuleNotFoundError:
        title = f"reading `{name}` needs `pyarrow`, which is not installed"
        help_ = "in the clone of tltlc: pip install -c constraints.txt '.[parquet]'"
        raise TltlError([Diagnostic("TLT0730", title, help=help_)]) from None
    try:
        # A reader of bytes starts no threads. A thread that still runs at the end would abort the process.
        file = parquet.ParquetFile(pyarrow.BufferReader(data))
        names = _columns(file, signals)
        if _is_too_large(file, len(names), len(data)):
            raise TltlError([_size_error(name)])
        table = file.read(columns=names, use_threads=False)
        columns = [table.column(name).to_pylist() for name in names]
        rows = list(zip(*columns, strict=True)) if columns else [()] * file.metadata.num_rows
    except _ColumnError as error:
        title = f"`{name}` cannot be read as a trace: {error}"
        raise TltlError(
            [Diagnostic("TLT0622", title, help="give each signal one column of numbers or booleans")]
        ) from None
    except (pyarrow.ArrowException, OSError, ValueError, OverflowError, KeyError) as error:
        title = f"`{name}` is not a valid Parquet file: {_first_sentence(str(error))}"
        raise TltlError([Diagnostic("TLT0622", title, help="write it again")]) from None
    return "".join(f"{json.dumps(dict(zip(names, row, strict=True)))}\n" for row in rows).encode()


def _columns(file: Any, signals: Collection[Signal] | None) -> list[str]:
    """Return the names of the columns to read, as :func:`json_lines` describes them.

    Raises:
        _ColumnError: two of them have the same name, or one of them has values that are neither
            numbers nor booleans.
    """
    kinds = [(field.name, field.type) for field in file.schema_arrow]
    if signals is None:
        wanted = {name for name, kind in kinds if _is_value(kind) or _is_text(kind)}
    else:
        names = [name for name, _ in kinds]
        wanted = {signal.name for signal in signals} | {times_name(names, signals), lengths_name(names, signals)}
    enums = wanted if signals is None else {signal.name for signal in signals if signal.values}
    names = [name for name, _ in kinds if name in wanted]
    for name, kind in kinds:
        if name in wanted and names.count(name) > 1:
            raise _ColumnError(f"two columns are called `{name}`")
        if name in wanted and not _is_value(kind) and not (name in enums and _is_text(kind)):
            raise _ColumnError(f"the column `{name}` has values of the type {kind}")
    return names


def _is_value(kind: Any) -> bool:
    from pyarrow import types

    return any(test(kind) for test in (types.is_boolean, types.is_integer, types.is_floating, types.is_null))


def _is_text(kind: Any) -> bool:
    from pyarrow import types

    kind = kind.value_type if types.is_dictionary(kind) else kind
    return bool(types.is_string(kind) or types.is_large_string(kind))


def _is_too_large(file: Any, columns: int, size: int) -> bool:
    metadata = file.metadata
    unpacked = sum(metadata.row_group(group).total_byte_size for group in range(metadata.num_row_groups))
    assert PARQUET.values is not None
    assert PARQUET.unpacked is not None
    cells = metadata.num_rows * max(1, columns)
    return size > PARQUET.size or unpacked > PARQUET.unpacked or cells > PARQUET.values


def _size_error(name: str) -> Diagnostic:
    assert PARQUET.unpacked is not None
    limits = f"{PARQUET.size >> 20} MiB, {PARQUET.unpacked >> 20} MiB unpacked or {PARQUET.values:,} values"
    return Diagnostic("TLT0004", f"`{name}` is larger than {limits}", help="record fewer steps, or fewer signals")


def _first_sentence(text: str) -> str:
    return (text.splitlines() or ["it cannot be read"])[0].partition(". ")[0].rstrip(".")
