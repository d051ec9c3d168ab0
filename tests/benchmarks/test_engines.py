"""Handwritten monitors in the languages of game engines compute the same as the generated ones and
the reference."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from benchmarks import engine_report
from benchmarks.engine_speed import disagreement, monitor_rows
from benchmarks.engines.engine import OUTPUT_FIELDS, Engine, engines, generate, write_trace
from benchmarks.specs import PAPER_SPECS, source, trace
from benchmarks.store import Store
from tests.benchmarks.test_handwritten import _shuffled
from tltlc import compile_file
from tltlc.monitor import Monitor

ENGINES = {engine.name: engine for engine in engines()}


def test_each_language_has_a_module() -> None:
    assert set(ENGINES) == {"c", "c++", "csharp", "gdscript3", "javascript", "lua5.4", "luajit", "rust"}


@pytest.mark.parametrize("spec", PAPER_SPECS)
@pytest.mark.parametrize("engine", ENGINES.values(), ids=ENGINES)
def test_both_monitors_equal_the_reference(engine: Engine, spec: str, tmp_path: Path) -> None:
    if reason := engine.missing():
        pytest.skip(reason)
    task = generate(engine, spec, tmp_path)
    generator = random.Random(spec)
    recorded = trace(spec)
    walks = [recorded, *(_shuffled(recorded, generator) for _ in range(20))]
    traces = [write_trace(task, walk, tmp_path / f"{place}.txt") for place, walk in enumerate(walks)]
    rows = monitor_rows(task, engine.build(task), traces)
    expected, reached = _expected(spec, walks)
    assert reached >= {"pending", "satisfied"} or reached == {"pending", "holding", "violated"}
    for author, author_rows in rows.items():
        assert disagreement(author_rows, expected) is None, author


def _expected(spec: str, walks: list[list[dict[str, float]]]) -> tuple[list[tuple[str, ...]], set[str]]:
    """Return the rows of the reference monitor, and the verdicts that occur in them."""
    monitor = Monitor(next(fspa for fspa in compile_file(source(spec)) if fspa.name == spec))
    rows: list[tuple[str, ...]] = []
    for walk in walks:
        monitor.reset()
        steps = [monitor.step(sample) for sample in walk]
        rows += [tuple(_cell(getattr(step, field)) for field in OUTPUT_FIELDS) for step in steps]
    return rows, {row[2] for row in rows}


def _cell(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)


def test_a_difference_is_reported() -> None:
    row = ("0", "F a", "pending", "false", "false", "0.5", "0.25", "1", "a", "Reach a.", "", "", "")
    assert disagreement([row], [(*row[:5], "0.5000000000000001", *row[6:])]) is None
    assert disagreement([row], [(*row[:8], "b", *row[9:])]) == "step 1: limiting is 'a', not 'b'"
    assert disagreement([row], [(*row[:6], "0.26", *row[7:])]) == "step 1: reward is '0.25', not '0.26'"
    assert disagreement([row], [(*row[:12], "3")]) == "step 1: failed_step is '', not '3'"
    assert disagreement([row], []) == "1 steps, not 0"


def test_the_goal_covers_each_language_on_each_spec(tmp_path: Path) -> None:
    store = Store(tmp_path / "results.json")
    assert list(engine_report.goals(store)) == []
    assert engine_report.section(store) == ""
    measured = {
        "version": "12.2",
        "steps_per_s": {"generated": 99_500_000, "by_hand": 100_000_000},
        "generated_to_by_hand": (0.98, 0.99, 1.0),
        "bytes": {"file": 30_000, "without comments": 20_000},
        "compiled": {"generated": {"gcc -O2": 4_000}, "by_hand": {"gcc -O2": 2_000}},
    }
    for spec in PAPER_SPECS:
        store.put("engines", f"c {spec}", measured)
        store.put("engines", f"lua5.4 {spec}", {"left_out": "lua5.4 is not installed"})
    assert [row[1:] for row in engine_report.goals(store)] == [("least 0.99", "met")]
    text = engine_report.section(store)
    assert "| C 12.2 | 100 (0.99) | 100 (0.99) | 100 (0.99) |" in text
    assert "| C | 30.0 / 30.0 / 30.0 | 20.0 / 20.0 / 20.0 | gcc -O2 | 4.0 / 4.0 / 4.0 | 2.0 / 2.0 / 2.0 |" in text
    assert "Left out: lua5.4 is not installed." in text
    store.put("engines", "c branching", {**measured, "generated_to_by_hand": (0.7, 0.8, 0.81)})
    assert [row[1:] for row in engine_report.goals(store)] == [
        ("least 0.80; under 0.9: c branching 0.80", "**missed**")
    ]
