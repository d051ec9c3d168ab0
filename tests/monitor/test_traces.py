from __future__ import annotations

import io
import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor.traces import read_trace
from tltlc.resolve.spec import Signal

SIGNALS = (Signal("near(a, b)", "number", None, None), Signal("open", "bool", 0.0, 1.0))


def read(text: str | bytes) -> list[dict[str, float]]:
    data = text if isinstance(text, bytes) else text.encode()
    return list(read_trace(io.BytesIO(data), "trace", SIGNALS))


def rejection(text: str | bytes) -> tuple[str, str, str, str]:
    """Return the code, title, line:column and label of the error."""
    with pytest.raises(TltlError) as caught:
        read(text)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.help
    if not diagnostic.labels:
        return diagnostic.code, diagnostic.title, "", ""
    label = diagnostic.labels[0]
    line, column = label.source.position(label.span.start)
    return diagnostic.code, diagnostic.title, f"{line}:{column}", label.message


def test_csv_is_read_by_the_names_of_columns() -> None:
    text = 'open,other,"near(a, b)"\ntrue,x,-1.5\r\n0,,2e3\n\nFALSE,, 7 \n'
    assert read(text) == [
        {"near(a, b)": -1.5, "open": 1.0},
        {"near(a, b)": 2000.0, "open": 0.0},
        {"near(a, b)": 7.0, "open": 0.0},
    ]


def test_json_lines_are_read_by_the_keys_of_objects() -> None:
    assert read('\n{"near(a, b)": 1, "open": true}\n{"open": 0.0, "more": null}\n') == [
        {"near(a, b)": 1.0, "open": 1.0},
        {"open": 0.0},
    ]


@given(st.lists(st.tuples(st.floats(allow_nan=False, allow_infinity=False), st.booleans()), min_size=1))
def test_csv_and_json_lines_give_the_same_samples(rows: list[tuple[float, bool]]) -> None:
    expected = [{"near(a, b)": number, "open": float(flag)} for number, flag in rows]
    lines = [json.dumps({"near(a, b)": number, "open": flag}) for number, flag in rows]
    assert read("\n".join(lines)) == expected
    cells = [f"{number!r},{str(flag).lower()}" for number, flag in rows]
    assert read("\n".join(['"near(a, b)",open', *cells])) == expected


def test_a_byte_order_mark_is_skipped() -> None:
    assert read('\ufeffopen,"near(a, b)"\n1,1\n') == [{"near(a, b)": 1.0, "open": 1.0}]
    assert read('\ufeff{"open": 1}\n') == [{"open": 1.0}]


def test_samples_are_read_lazily() -> None:
    stream = io.BytesIO(b'open,"near(a, b)"\n1,1\n0,1\nx\n')
    samples = read_trace(stream, "trace", SIGNALS)
    assert next(samples)["open"] == 1.0
    assert stream.readline() == b"0,1\n", "the reader reads a line only when the next sample is requested"
    assert stream.seek(-4, io.SEEK_CUR)
    assert next(samples)["open"] == 0.0


def test_non_finite_numbers_are_passed_to_the_monitor() -> None:
    assert math.isnan(read('open,"near(a, b)"\n1,nan\n')[0]["near(a, b)"])
    assert read('{"near(a, b)": 1' + "0" * 400 + "}")[0]["near(a, b)"] == math.inf


HEADER = 'open,"near(a, b)"\n'


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", ("TLT0620", "the trace `trace` contains no sample", "", "")),
        ("\n\n", ("TLT0620", "the trace `trace` contains no sample", "", "")),
        (HEADER, ("TLT0620", "the trace `trace` contains no sample", "", "")),
        ("open\n1\n", ("TLT0621", "the trace has no column for `near(a, b)`", "1:1", "")),
        (HEADER + "1,1\n1\n", ("TLT0622", "line 3 of the trace cannot be read", "3:1", "1 value for 2 columns")),
        (HEADER + "1,\n", ("TLT0622", "line 2 of the trace cannot be read", "2:3", "`near(a, b)` has no value")),
        (
            HEADER + "x,1\n",
            ("TLT0622", "line 2 of the trace cannot be read", "2:1", "this value of `open` is not a number"),
        ),
        (
            HEADER + "1,1_0\n",
            ("TLT0622", "line 2 of the trace cannot be read", "2:3", "this value of `near(a, b)` is not a number"),
        ),
        (
            HEADER + "1,١\n",
            ("TLT0622", "line 2 of the trace cannot be read", "2:3", "this value of `near(a, b)` is not a number"),
        ),
        (
            'open,open,"near(a, b)"\n',
            ("TLT0622", "line 1 of the trace cannot be read", "1:1", "two columns are called `open`"),
        ),
        (
            HEADER + '1,"2\n',
            ("TLT0622", "line 2 of the trace cannot be read", "2:1", "a quote is not closed"),
        ),
        (HEADER.encode() + b"1,\xff\n", ("TLT0622", "line 2 of the trace cannot be read", "2:3", "it is not UTF-8")),
        ('{"open": 1}\n{"open" 1}', ("TLT0622", "line 2 of the trace cannot be read", "2:9", "this is not JSON")),
        ('{"open": 1}\n[1]', ("TLT0622", "line 2 of the trace cannot be read", "2:1", "this is not an object")),
        (
            '{"open": "yes"}',
            ("TLT0622", "line 1 of the trace cannot be read", "1:1", "this value of `open` is not a number"),
        ),
    ],
)
def test_an_error_points_at_the_place_that_cannot_be_read(
    text: str | bytes, expected: tuple[str, str, str, str]
) -> None:
    assert rejection(text) == expected


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("near(a, b);open\n1;1\n", "separate the columns by commas"),
        ("closed\topen\n1\t1\n", "separate the columns by commas"),
        ('[{"open": 1}]\n', 'write one object a line, e.g. `{"health": 1.0, "seen": false}`'),
    ],
)
def test_unsupported_formats_get_advice(text: str, advice: str) -> None:
    with pytest.raises(TltlError) as caught:
        read(text)
    assert caught.value.diagnostics[0].help == advice


@given(st.binary(max_size=60))
def test_any_bytes_are_read_or_rejected(data: bytes) -> None:
    for start in (b"", b'open,"near(a, b)"\n', b'{"open": 1}\n', b"{"):
        try:
            read(start + data)
        except TltlError as error:
            assert error.diagnostics[0].code in ("TLT0620", "TLT0621", "TLT0622")


OR_SPARSE = "use `tltlc monitor --sparse` if a missing bool counts as false"


@pytest.mark.parametrize(
    ("header", "advice"),
    [
        ("falls_pit1,falls(pit2),falls(pit3)", "rename the column `falls_pit1` to `falls(pit1)`"),
        ("Falls (pit1),falls(pit2),falls(pit3)", "rename the column `Falls (pit1)` to `falls(pit1)`"),
        ("falls_pit2,falls(pit3)", f"its columns are `falls_pit2` and `falls(pit3)`; {OR_SPARSE}"),
        (
            "falls_pit4,falls(pit2),falls(pit3)",
            f"its columns are `falls_pit4`, `falls(pit2)` and `falls(pit3)`; {OR_SPARSE}",
        ),
        ("fals(pit1),falls(pit2),falls(pit3)", "did you mean the column `fals(pit1)`?"),
    ],
)
def test_a_missing_column_is_never_that_of_another_signal(header: str, advice: str) -> None:
    signals = [Signal(f"falls(pit{number})", "bool", 0.0, 1.0) for number in (1, 2, 3)]
    with pytest.raises(TltlError) as caught:
        list(read_trace(io.BytesIO(f"{header}\n".encode()), "trace", signals))
    assert caught.value.diagnostics[0].help == advice
