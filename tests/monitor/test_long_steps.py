"""Recordings in milliseconds where seconds are wanted, and slow games, which are not such recordings."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc
from tltlc import compile_text
from tltlc.monitor.long_steps import LongSteps, shortest_time
from tltlc.monitor.samples import STEP_LENGTH

__all__ = ["tltlc"]

SPEC = "clock varies\nsignal a: bool\nsignal b: bool\nspec s { keep within 2 s of a, b }\n"
MILLISECONDS = [0.0, 16.7, 16.7, 0.0, 33.4, 16.7]


def shortest(clause: str, clock: str = "clock varies") -> float | None:
    declared = (
        "signal a: bool\nsignal b: bool\nsignal x: time in [0 s, 9 s]\nparam patience: time in [1 s, 9 s] = 3 s\n"
    )
    (fspa,) = compile_text(f"{clock}\n{declared}spec s {{ {clause} }}")
    return shortest_time(fspa)


def codes(lengths: Iterable[float], shortest_s: float | None) -> list[str]:
    steps = LongSteps(shortest_s)
    samples = [{STEP_LENGTH: length} for length in lengths]
    assert list(steps.watched(samples)) == samples
    return [warning.code for warning in steps.warnings()]


@pytest.mark.parametrize(
    ("clause", "time"),
    [
        ("keep within 2 s of a, b", 2.0),
        ("keep a implies always for 0.5 s b", 0.5),
        ("reach a then within 5 s b then within 3 s a", 3.0),
        ("require eventually within 4 s a", 4.0),
        ("require eventually within 30 s a  keep within 60 s of a, b", 30.0),
        ("keep once within 2 s a", 2.0),
        ("keep historically for 3 s a", 3.0),
        ("reach always for 3 s a", 3.0),
        ("reach time_holding(a) >= 3 s", 3.0),
        ("keep time_since(a) < 2 s or time_since(a) > 7 s", 2.0),
        ("keep time_since(a) < patience * 2", 6.0),
        ("keep time_since(a) < x", None),
        ("keep a", None),
    ],
)
def test_the_shortest_time_of_a_spec_is_found(clause: str, time: float | None) -> None:
    assert shortest(clause) == time


def test_a_fixed_clock_has_no_shortest_time() -> None:
    assert shortest("keep within 20 s of a, b", "clock 60 Hz") is None


@pytest.mark.parametrize(
    "lengths",
    [MILLISECONDS, [0.0, *[16.7] * 9, 1.0, 16.7], [0.0, 2.1]],
    ids=["frames", "one step in ten is short", "one step"],
)
def test_steps_longer_than_every_time_cause_a_warning(lengths: Sequence[float]) -> None:
    assert codes(lengths, 2.0) == ["TLT0625"]


@pytest.mark.parametrize(
    ("lengths", "shortest_s"),
    [
        ([0.0, 0.0167, 0.0334], 2.0),
        (MILLISECONDS, None),
        ([0.0, 12.0, 20.0, 9.0, 31.0], 60.0),
        ([0.0, 12.0, 1.5, 9.0, 2.0, 31.0], 2.0),
        ([0.0, 0.4, 0.5, 0.3], 0.2),
        ([900.0], 2.0),
        ([0.0, 0.0, 0.0], 2.0),
        ([], 2.0),
    ],
    ids=["seconds", "no time", "turns", "short turns", "slow frames", "the first step", "one moment", "no step"],
)
def test_other_recordings_cause_none(lengths: Sequence[float], shortest_s: float | None) -> None:
    assert codes(lengths, shortest_s) == []


def rows(column: str) -> list[dict[str, float]]:
    times = [sum(MILLISECONDS[: number + 1]) for number in range(len(MILLISECONDS))]
    return [
        {"a": float(number == 0), "b": 0.0, column: time}
        for number, time in enumerate(MILLISECONDS if column == "dt" else times)
    ]


def write_csv(path: Path, column: str) -> None:
    lines = [",".join(map(str, row.values())) for row in rows(column)]
    path.write_text("\n".join([f"a,b,{column}", *lines]) + "\n")


def write_json_lines(path: Path, column: str) -> None:
    path.write_text("".join(json.dumps(row) + "\n" for row in rows(column)))


def write_parquet(path: Path, column: str) -> None:
    pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    from pyarrow import parquet

    parquet.write_table(pyarrow.Table.from_pylist(rows(column)), path)


@pytest.mark.parametrize("column", ["dt", "time"])
@pytest.mark.parametrize(
    ("name", "write"), [("t.csv", write_csv), ("t.jsonl", write_json_lines), ("t.parquet", write_parquet)]
)
def test_the_command_warns_once_whatever_the_format(
    tltlc: Callable[..., Outcome],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    write: Callable[[Path, str], None],
    column: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("s.tltl").write_text(SPEC)
    write(Path(name), column)
    judged = tltlc("monitor", "s.tltl", name)
    wanted = re.compile(r"not accepted: violated at step 2 \([\d.]+ s\) of 6: `b later than 2 s after a`, clause 1\n")
    found = wanted.search(judged.err)
    assert found
    assert judged.status == 1
    assert judged.err[found.end() :] == (
        "warning[TLT0625]: the trace has a step every 20.9 s on average, and the shortest time in the spec is 2 s\n"
        "  help: `dt` and `time` are in seconds: if these are milliseconds, divide them by 1000\n"
    )


def test_of_many_traces_the_first_is_named(
    tltlc: Callable[..., Outcome], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("s.tltl").write_text(SPEC)
    Path("fine.csv").write_text("a,b,dt\n1,0,0\n0,1,0.0167\n")
    names = ["fine.csv", "one.csv", "three.csv", "two.csv"]
    for name in names[1:]:
        write_csv(Path(name), "dt")
    judged = tltlc("monitor", "s.tltl", *names)
    assert "1 of 4 accepted" in judged.out
    title = "`one.csv`, the trace has a step every 20.9 s on average, and the shortest time in the spec is 2 s"
    assert judged.err.splitlines()[0] == f"warning[TLT0625]: {title}; 2 other traces are alike"
    assert judged.err.count("TLT0625") == 1
    document = json.loads(tltlc("monitor", "s.tltl", *names, "--json").out)
    found = [[item["code"] for item in trace["diagnostics"]] for trace in document["traces"]]
    assert found == [[], ["TLT0625"], ["TLT0625"], ["TLT0625"]]
