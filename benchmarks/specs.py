"""The three specs of the paper, their recorded traces, and the handwritten monitors for them."""

from __future__ import annotations

import csv
import importlib
from pathlib import Path
from typing import Any

from benchmarks.store import ROOT

PAPER_SPECS = ("navigation", "cover_and_hide", "branching")


def source(name: str) -> Path:
    """Return the path of the example file of a spec, which has the same name."""
    return ROOT / "examples" / f"{name}.tltl"


def trace(name: str) -> list[dict[str, float]]:
    """Return the recorded trace of a spec: one sample per step, ``true`` and ``false`` as 1 and 0."""
    with source(name).with_suffix(".csv").open(encoding="utf-8", newline="") as file:
        return [{signal: _number(cell) for signal, cell in row.items()} for row in csv.DictReader(file)]


def handwritten_monitor(name: str) -> Any:
    """Return a new handwritten monitor of a spec."""
    return importlib.import_module(f"benchmarks.handwritten.{name}").Monitor()


def _number(cell: str) -> float:
    return {"true": 1.0, "false": 0.0}[cell] if cell in ("true", "false") else float(cell)
