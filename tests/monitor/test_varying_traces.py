"""Traces for a spec whose clock varies: they have the times of the samples, or the lengths of the steps."""

from __future__ import annotations

import gzip
import io
import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc
from tltlc import compile_text
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor import Monitor
from tltlc.monitor.parquet import as_text
from tltlc.monitor.samples import STEP_LENGTH
from tltlc.monitor.traces import read_trace
from tltlc.tools.judge.judge import Judge

__all__ = ["tltlc"]

SPEC = "clock varies\nsignal a: bool\nsignal b: bool\nspec s { keep within 1 s of a, b }\n"
(FSPA,) = compile_text(SPEC)

IN_TIME = [("1", "0", 0.0), ("0", "0", 0.5), ("0", "1", 0.5), ("0", "0", 9.0)]
LATE = [("1", "0", 0.0), ("0", "0", 0.5), ("0", "1", 0.75), ("0", "0", 9.0)]
Rows = list[tuple[str, str, float]]


def csv(rows: Rows, column: str) -> str:
    total, lines = 12.0, [f"a,{column},b,note"]
    for number, (a, b, dt) in enumerate(rows):
        total += dt if number else 0.0
        lines.append(f"{a},{total if column.lower() == 'time' else dt},{b},x")
    return "\n".join(lines) + "\n"


def json_lines(rows: Rows, column: str) -> str:
    table = [line.split(",") for line in csv(rows, column).splitlines()]
    objects = [
        dict(zip(table[0], (float(cell) if cell != "x" else cell for cell in row), strict=True)) for row in table[1:]
    ]
    return "\n".join(json.dumps(row) for row in objects) + "\n"


def lengths(text: str | bytes) -> list[float]:
    data = text.encode() if isinstance(text, str) else text
    samples = read_trace(io.BytesIO(data), "trace", FSPA.signals, clock_varies=True)
    return [float(sample[STEP_LENGTH]) for sample in samples]


def code_of(text: str) -> str:
    with pytest.raises(TltlError) as raised:
        lengths(text)
    (diagnostic,) = raised.value.diagnostics
    assert diagnostic.help is not None
    return diagnostic.code


@pytest.mark.parametrize("column", ["dt", "time", "DT", "Time"])
@pytest.mark.parametrize("written", [csv, json_lines])
def test_a_trace_has_times_or_lengths(written: Callable[[Rows, str], str], column: str) -> None:
    for rows in (IN_TIME, LATE):
        text = written(rows, column)
        assert lengths(text) == [row[2] for row in rows]
        verdict = Judge(FSPA).judge("trace", text.encode()).verdict
        assert verdict is not None
        assert verdict.outcome.accepted == (rows is IN_TIME)


def test_lengths_go_before_times() -> None:
    assert lengths("time,dt,a,b\n0,0,1,0\n5,0.25,0,1\n1,0.5,0,0\n") == [0, 0.25, 0.5]
    assert lengths('{"dt":0,"time":0,"a":1,"b":0}\n{"time":-5,"dt":0.25,"a":0,"b":1}\n') == [0, 0.25]


def test_times_may_stand_still_and_begin_anywhere() -> None:
    assert lengths("time,a,b\n-7,1,0\n-7,0,0\n-6.5,0,1\n") == [0, 0, 0.5]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("a,b\n1,0\n", "TLT0621"),
        ('{"a":1,"b":0}\n', "TLT0621"),
        ("a,b,time\n1,0,3\n0,1,2.5\n", "TLT0623"),
        ('{"a":1,"b":0,"time":3}\n{"a":1,"b":0,"time":2.5}\n', "TLT0623"),
        ("a,b,dt\n1,0,-1\n", "TLT0623"),
        ("a,b,dt\n1,0,nan\n", "TLT0623"),
        ("a,b,dt\n1,0,inf\n", "TLT0623"),
        ("a,b,dt\n1,0,\n", "TLT0623"),
        ("a,b,dt\n1,0,soon\n", "TLT0623"),
        ("a,b,time\n1,0,nan\n", "TLT0623"),
        ('{"a":1,"b":0,"dt":null}\n', "TLT0623"),
        ('{"a":1,"b":0,"dt":"0.5"}\n', "TLT0623"),
        ('{"a":1,"b":0,"dt":[0.5]}\n', "TLT0623"),
        ('{"a":1,"b":0,"dt":1' + "0" * 400 + "}\n", "TLT0623"),
        ("dt,dt,a,b\n0,0,1,0\n", "TLT0622"),
        ('{"a":1,"b":0,"dt":0}\n{"a":1,"b":0}\n', "TLT0622"),
        ('{"a":1,"b":0,"dt":0}\n{"a":1,"b":0,"time":1}\n', "TLT0622"),
        ('{"a":1,"b":0,"time":0}\n{"a":1,"b":0,"dt":1}\n', "TLT0622"),
    ],
)
def test_a_trace_without_right_times_is_an_error(text: str, code: str) -> None:
    assert code_of(text) == code


def test_a_row_without_its_time_needs_one() -> None:
    text = '{"dt": 0, "a": 0, "b": 0}\n{"a": 0, "b": 0}\n'
    with pytest.raises(TltlError) as error:
        list(read_trace(io.BytesIO(text.encode()), "run.jsonl", FSPA.signals, clock_varies=True))
    (diagnostic,) = error.value.diagnostics
    assert (diagnostic.code, diagnostic.help) == ("TLT0622", "give every row its `dt`: the clock of the spec varies")


def test_the_samples_before_an_error_are_read() -> None:
    stream = io.BytesIO(b"a,b,time\n1,0,3\n0,1,4\n0,0,2\n")
    samples = read_trace(stream, "trace", FSPA.signals, clock_varies=True)
    assert [next(samples)[STEP_LENGTH], next(samples)[STEP_LENGTH]] == [0, 1]
    with pytest.raises(TltlError, match="TLT0623"):
        next(samples)
    judged = Judge(FSPA).judge("trace", b"a,b,time\n1,0,3\n0,0,9\n0,0,2\n")
    assert judged.verdict is None
    assert judged.so_far is not None


def test_with_a_fixed_clock_a_column_dt_is_ignored() -> None:
    samples = read_trace(io.BytesIO(b"a,b,dt\n1,0,nonsense\n"), "trace", FSPA.signals, 0.125)
    assert [*samples] == [{"a": 1.0, "b": 0.0}]


@pytest.mark.parametrize("name", ["dt", "time"])
def test_a_signal_of_that_name_is_no_time(name: str) -> None:
    (fspa,) = compile_text(f"clock varies signal {name}: number in [0, 9] spec s {{ keep once within 1 s {name} > 1 }}")

    def read(text: str) -> list[float]:
        samples = read_trace(io.BytesIO(text.encode()), "trace", fspa.signals, clock_varies=True)
        return [float(sample[STEP_LENGTH]) for sample in samples]

    other = "time" if name == "dt" else "dt"
    assert read(f"{name},{other}\n5,0\n4,0.5\n") == [0, 0.5]
    with pytest.raises(TltlError, match="TLT0621"):
        read(f"{name}\n5\n4\n")


@pytest.mark.parametrize("column", ["dt", "time"])
def test_parquet_has_times_or_lengths(column: str) -> None:
    pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    from pyarrow import parquet

    file = io.BytesIO()
    parquet.write_table(pyarrow.table({"a": [True, False], "b": [False, True], column: [0.0, 0.75]}), file)
    assert lengths(as_text(file.getvalue(), "trace", FSPA.signals)) == [0, 0.75]


def test_commands_read_times_and_lengths(
    tltlc: Callable[..., Outcome],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("s.tltl").write_text(SPEC)
    folder = Path("plays")
    folder.mkdir()
    for name, rows in (("good", IN_TIME), ("late", LATE)):
        (folder / f"{name}_dt.csv").write_text(csv(rows, "dt"))
        (folder / f"{name}_time.jsonl").write_text(json_lines(rows, "time"))
        packed = gzip.compress(json_lines(rows, "dt").encode())
        Path(f"{name}.jsonl.gz").write_bytes(packed)
        expected = 0 if name == "good" else 1
        for path in (folder / f"{name}_dt.csv", folder / f"{name}_time.jsonl", Path(f"{name}.jsonl.gz")):
            assert tltlc("monitor", "s.tltl", path).status == expected, path
    assert tltlc("compile", "s.tltl", "-t", "json").status == 0
    for spec in ("s.tltl", "s.fspa.json"):
        summary = tltlc("monitor", spec, "plays")
        assert summary.status == 1
        assert "2 of 4 accepted" in summary.out
        document = json.loads(tltlc("monitor", spec, "plays", "--json").out)
        assert [trace["accepted"] for trace in document["traces"]] == [True, True, False, False]
    Path("none.csv").write_text("a,b\n1,0\n")
    assert "TLT0621" in tltlc("monitor", "s.tltl", "none.csv").err


def test_a_trace_and_the_calls_of_a_game_give_the_same_steps() -> None:
    monitor = Monitor(FSPA)
    verdicts = [monitor.step({"a": float(a), "b": float(b)}, dt).verdict for a, b, dt in LATE]
    judged = Judge(FSPA).judge("trace", csv(LATE, "time").encode()).verdict
    assert judged is not None
    assert judged.outcome.verdict == verdicts[-1] == "violated"
