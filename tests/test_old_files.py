"""Artefacts and generated monitors of an older version give the same states, verdicts and rewards today."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import tltlc
from tltlc.monitor import Monitor

OLD = Path(__file__).with_name("old_files")
EXPECTED: dict[str, Any] = json.loads((OLD / "expected.json").read_text(encoding="utf-8"))


def trace() -> list[dict[str, float]]:
    with (OLD / "trace.csv").open(encoding="utf-8", newline="") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


@pytest.mark.parametrize(
    ("name", "samples"),
    [("cover_and_hide", trace()), ("patrols", EXPECTED["patrols_trace"])],
    ids=["finite", "infinite"],
)
def test_an_old_artefact_gives_the_same_verdicts(name: str, samples: list[dict[str, float]]) -> None:
    monitor = Monitor(tltlc.load(OLD / f"{name}.fspa.json"))
    steps = [monitor.step(sample) for sample in samples]
    assert [[step.state, step.verdict, step.done, step.progress, step.reward] for step in steps] == EXPECTED[name]


def test_an_old_generated_monitor_agrees_with_the_monitor(tmp_path: Path) -> None:
    """The generated file is a program of its own; what it prints has the meaning that the monitor gives it today."""
    program = tmp_path / "cover_and_hide_monitor.py"
    program.write_bytes((OLD / "cover_and_hide_monitor.py.txt").read_bytes())
    command = [sys.executable, str(program), str(OLD / "trace.csv")]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    rows = list(csv.DictReader(printed.splitlines()))
    monitor = Monitor(tltlc.load(OLD / "cover_and_hide.fspa.json"))
    steps = [monitor.step(sample) for sample in trace()]
    assert [(int(row["state"]), row["verdict"], float(row["reward"])) for row in rows] == [
        (step.state, step.verdict, step.reward) for step in steps
    ]
