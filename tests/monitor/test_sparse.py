"""In samples of events, a missing bool counts as false; without that option it is an error that names the option."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import pytest

from tests.interfaces.cli.conftest import inside, tltlc  # noqa: F401
from tltlc import compile_text
from tltlc.monitor import Monitor, MonitorError

HIDE: Final = """
signal seen: bool
signal open: bool
signal health: ratio
spec hide { reach open  avoid seen  keep health > 0.5 }
"""
CALM: Final = {"seen": False, "open": False, "health": 1.0}
EVENTS: Final[tuple[dict[str, float], ...]] = ({"health": 1}, {"health": 0.75, "open": True}, {"health": 1})


def refused(monitor: Monitor, sample: Mapping[str, float]) -> tuple[str, str, str | None]:
    with pytest.raises(MonitorError) as caught:
        monitor.step(sample)
    (diagnostic,) = caught.value.diagnostics
    return diagnostic.code, diagnostic.title, diagnostic.help


# --- the library ----------------------------------------------------------------------------------


def test_a_sparse_monitor_takes_missing_bools_as_false() -> None:
    (fspa,) = compile_text(HIDE)
    sparse, dense = Monitor(fspa, sparse=True), Monitor(fspa)
    for monitor in (sparse, sparse.another()):
        dense.reset()
        for sample in (*EVENTS, {"seen": True, "health": 1}):
            assert monitor.step(sample) == dense.step({**CALM, **sample})
        assert monitor.failure == dense.failure is not None


def test_a_missing_number_is_an_error_of_a_sparse_monitor() -> None:
    (fspa,) = compile_text(HIDE)
    code, title, advice = refused(Monitor(fspa, sparse=True), {"seen": True})
    assert (code, title) == ("TLT0611", "step 1: no value for `health`")
    assert advice is not None
    assert "sparse" not in advice


@pytest.mark.parametrize(("sample", "names_option"), [({"health": 1}, True), ({"open": False}, False)])
def test_the_error_names_the_option_if_only_bools_are_missing(sample: dict[str, float], names_option: bool) -> None:
    (fspa,) = compile_text(HIDE)
    code, _, advice = refused(Monitor(fspa), sample)
    assert code == "TLT0611"
    assert advice is not None
    assert ("sparse=True" in advice, "--sparse" in advice) == (names_option, names_option)


def test_none_is_no_missing_bool() -> None:
    (fspa,) = compile_text(HIDE)
    sample = {**CALM, "seen": None}
    assert refused(Monitor(fspa, sparse=True), sample)[0] == "TLT0612"  # type: ignore[arg-type]


# --- traces ---------------------------------------------------------------------------------------

ROWS: Final = [{**CALM, **sample} for sample in EVENTS]
NAMES: Final = [*CALM]


def csv_text(empty: bool) -> str:
    """Return the events as CSV, with empty cells or, if not ``empty``, without the column that is always false."""
    names = NAMES if empty else ["open", "health"]
    cells = [",".join(str(float(row[name])) if row[name] else "" for name in names) for row in ROWS]
    return "\n".join([",".join(names), *cells]) + "\n"


@pytest.fixture
def events(inside: Path) -> dict[str, str]:  # noqa: F811
    """Write the events in several formats, and return the dense trace and the code of the error without the option."""
    Path("hide.tltl").write_text(HIDE)
    Path("dense.jsonl").write_text("".join(json.dumps(row) + "\n" for row in ROWS))
    Path("left_out.jsonl").write_text("".join(json.dumps(row) + "\n" for row in EVENTS))
    nulls = [{name: value or None for name, value in row.items()} for row in ROWS]
    Path("null.jsonl").write_text("".join(json.dumps(row) + "\n" for row in nulls))
    Path("empty.csv").write_text(csv_text(empty=True))
    Path("column.csv").write_text(csv_text(empty=False))
    return {"left_out.jsonl": "TLT0611", "null.jsonl": "TLT0611", "empty.csv": "TLT0622", "column.csv": "TLT0621"}


def test_the_command_judges_traces_of_events(events: dict[str, str], tltlc) -> None:  # type: ignore[no-untyped-def]  # noqa: F811
    dense = tltlc("monitor", "hide.tltl", "dense.jsonl")
    assert dense.status == 0
    for name, code in events.items():
        refused_run = tltlc("monitor", "hide.tltl", name)
        assert (refused_run.status, code in refused_run.err, "--sparse" in refused_run.err) == (1, True, True)
        sparse = tltlc("monitor", "hide.tltl", name, "--sparse")
        assert (sparse.status, sparse.out, sparse.err) == (0, dense.out, dense.err)


@pytest.mark.parametrize("workers", ["1", "2"])
def test_many_traces_of_events_are_judged(events: dict[str, str], workers: str, tltlc) -> None:  # type: ignore[no-untyped-def]  # noqa: F811
    judged = tltlc("monitor", "hide.tltl", *events, "--sparse", "--workers", workers)
    assert (judged.status, judged.out.splitlines()[-1]) == (0, "4 of 4 accepted")
    assert tltlc("monitor", "hide.tltl", *events, "--workers", workers).out.splitlines()[-1].startswith("0 of 4")


def test_missing_and_null_bools_of_parquet_are_false(events: dict[str, str], tltlc) -> None:  # type: ignore[no-untyped-def]  # noqa: F811
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    opened = [row["open"] or None for row in ROWS]
    table = pyarrow.table({"open": opened, "health": [row["health"] for row in ROWS]})
    parquet.write_table(table, "events.parquet")
    assert "TLT0611" in tltlc("monitor", "hide.tltl", "events.parquet").err
    sparse = tltlc("monitor", "hide.tltl", "events.parquet", "--sparse")
    assert (sparse.status, sparse.out) == (0, tltlc("monitor", "hide.tltl", "dense.jsonl").out)


@pytest.mark.parametrize(
    ("trace", "advice"),
    [
        ("open,sen,health\n0,0,1\n", "did you mean the column `sen`?"),
        ("0,0,1\n0,0,1\n", "the first line has to name the columns"),
        ("seen,open\n0,0\n", "its columns are `seen` and `open`"),
        ("seen,open,health\n0,0,\n", "`health` has no value"),
        ('{"seen": true}\n', "no value for `health`"),
        ('{"seen": "no", "health": 1}\n', "this value of `seen` is not a number"),
    ],
)
def test_other_errors_of_a_trace_stay_errors(trace: str, advice: str, inside: Path, tltlc) -> None:  # type: ignore[no-untyped-def]  # noqa: F811
    Path("hide.tltl").write_text(HIDE)
    Path("trace").write_text(trace)
    judged = tltlc("monitor", "hide.tltl", "trace", "--sparse")
    assert (judged.status, advice in judged.err) == (1, True), judged.err
