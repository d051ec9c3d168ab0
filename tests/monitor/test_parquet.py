from __future__ import annotations

import io
import json
from random import Random
from typing import Any

import pytest

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io import limits
from tltlc.monitor import parquet as reader
from tltlc.monitor.parquet import as_text, is_parquet, json_lines
from tltlc.resolve.spec import Signal

pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")

SIGNALS = (Signal("x", "number", None, None), Signal("seen", "bool", 0.0, 1.0))


def _parquet(columns: dict[str, Any]) -> bytes:
    return _written(pyarrow.table(columns))


def _written(table: Any) -> bytes:
    from pyarrow import parquet

    file = io.BytesIO()
    parquet.write_table(table, file)
    return file.getvalue()


def _rows(data: bytes, signals: tuple[Signal, ...] | None = SIGNALS) -> list[dict[str, Any]]:
    return [json.loads(line) for line in json_lines(data, "trace", signals).splitlines()]


def test_the_columns_of_signals_and_the_times_are_read() -> None:
    data = _parquet({"x": [0.5, None], "seen": [True, False], "time": [0, 1], "other": [1, 2]})
    assert _rows(data) == [{"x": 0.5, "seen": True, "time": 0}, {"x": None, "seen": False, "time": 1}]
    assert [row["other"] for row in _rows(data, None)] == [1, 2]


def test_columns_of_other_types_are_not_read() -> None:
    unused = {
        "at": pyarrow.array([1, 2], pyarrow.timestamp("ns")),
        "zone": pyarrow.array([1, 2], pyarrow.timestamp("us", "Nowhere/Else")),
        "blob": [b"a" * limits.TRACE_LINE.size, b""],
        "nothing": [None, None],
        "list": [[1], []],
    }
    data = _parquet({**unused, "x": [1, 2], "seen": [0, 1]})
    assert _rows(data) == [{"x": 1, "seen": 0}, {"x": 2, "seen": 1}]
    assert _rows(data, None) == [{"nothing": None, "x": 1, "seen": 0}, {"nothing": None, "x": 2, "seen": 1}]


def test_a_signal_with_text_is_refused() -> None:
    with pytest.raises(TltlError, match=r"TLT0622.*the column `x` has values of the type string"):
        _rows(_parquet({"x": ["a"], "seen": [True]}))


@pytest.mark.parametrize("signals", [SIGNALS, None])
def test_two_columns_of_the_same_name_are_refused(signals: tuple[Signal, ...] | None) -> None:
    table = pyarrow.table([pyarrow.array([1]), pyarrow.array([2]), pyarrow.array([True])], names=["x", "x", "seen"])
    with pytest.raises(TltlError, match=r"TLT0622.*two columns are called `x`"):
        _rows(_written(table), signals)


def test_other_columns_may_have_the_same_name() -> None:
    names = ["x", "seen", "text", "text"]
    table = pyarrow.table([pyarrow.array([1]), pyarrow.array([True]), *[pyarrow.array(["a"])] * 2], names=names)
    assert _rows(_written(table)) == [{"x": 1, "seen": True}]


@pytest.mark.parametrize("limit", [{"size": 100}, {"unpacked": 100}, {"values": 30}])
def test_a_file_that_is_too_large_is_refused(limit: dict[str, int], monkeypatch: pytest.MonkeyPatch) -> None:
    data = _parquet({"x": list(range(20)), "seen": [True] * 20})
    monkeypatch.setattr(
        reader, "PARQUET", limits.Limit(**{"size": 1 << 20, "unpacked": 1 << 20, "values": 100, **limit})
    )
    with pytest.raises(TltlError, match="TLT0004"):
        json_lines(data, "trace", SIGNALS)


@pytest.mark.parametrize("data", [b"", b"PAR1", b"PAR1\x15\x00PAR1", b"x,seen\n0,1\n"])
def test_a_file_that_is_not_parquet_is_refused(data: bytes) -> None:
    with pytest.raises(TltlError, match=r"TLT0622: `t\.parquet` is not a valid Parquet file"):
        as_text(data, "t.parquet", SIGNALS)


@pytest.mark.parametrize("seed", range(300))
def test_mutated_files_are_read_or_refused(seed: int) -> None:
    random = Random(seed)
    data = bytearray(_parquet({"x": [0.5, 1.5], "seen": [True, False], "at": pyarrow.array([1, 2], pyarrow.date64())}))
    for _ in range(random.randint(1, 4)):
        data[random.randrange(len(data))] = random.randrange(256)
    try:
        json_lines(bytes(data), "trace", random.choice((SIGNALS, None)))
    except TltlError as error:
        assert {diagnostic.code for diagnostic in error.diagnostics} <= {"TLT0004", "TLT0622"}


@pytest.mark.parametrize(
    ("start", "name", "expected"),
    [
        (b"PAR1\x15", "trace", True),
        (b"", "a.Parquet", True),
        (b"PAR1,x\n", "a.csv", False),
        (b"PAR1", "-", False),
        (b"PAR10\n", "a.csv", False),
        (b"PAR1\n", "a.csv", False),
        (b"PAR1\t", "a.csv", False),
    ],
)
def test_parquet_is_known_by_its_name_or_its_first_bytes(start: bytes, name: str, expected: bool) -> None:
    assert is_parquet(start, name) == expected
