"""Make the paper's Table I with ``tltlc table1``, and compare agents that learn from specs with agents that imitate."""

from __future__ import annotations

import json
import shutil
import statistics
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from benchmarks.markdown import met_or_missed
from benchmarks.measure import run
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest

SECTION = "table1"
COMMAND: Final = "tltlc table1 --shipped"
TIMEOUT_S: Final = 4 * 3600.0
FOLDER: Final = Path(__file__).with_name(".table1")
FIGURES: Final = ("pass rate", "progress", "reward")


def measure(store: Store, _: float, say: Callable[[str], None], folder: Path = FOLDER) -> None:
    """Make the table if the store has none; ``folder`` keeps the trainings and episodes of interrupted runs."""
    if find_spec("torch") is None or find_spec("pybullet") is None:
        say(f"{SECTION} left out: torch or pybullet is not installed (the extra `rl`, Python 3.10 or 3.11)")
        return
    measure_missing(store, SECTION, [COMMAND], lambda _: _make_table(folder), say, field="table")


def discard(folder: Path = FOLDER) -> None:
    """Delete the stored trainings and episodes."""
    shutil.rmtree(folder, ignore_errors=True)


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the row of the table of goals, once the table was made."""
    cells = records.get(COMMAND, {}).get("cells")
    if not cells:
        return
    comparisons = [
        (f"{level} {figure}", cells[f"{level} v0 ours"][figure], cells[f"{level} v0 imitation"][figure])
        for level in dict.fromkeys(name.split()[0] for name in cells)
        for figure in FIGURES
    ]
    yield (
        "an agent that learns from its spec is above one that imitates, in every column of v0 in Table I",
        ", ".join(f"{column} {ours:.2f} against {imitation:.2f}" for column, ours, imitation in comparisons),
        met_or_missed(all(ours > imitation for _, ours, imitation in comparisons)),
    )


def section(records: Mapping[str, Record]) -> str:
    """Return the section on Table I; empty without measurements."""
    record = records.get(COMMAND, {})
    if "table" not in record:
        return ""
    return f"""
## The paper's Table I

`python -m benchmarks --only {SECTION}` runs `{COMMAND}` on two cores; [its page](../docs/table1.md) explains what
can be compared.

{record["table"]}
"""


def _make_table(folder: Path) -> Record:
    process_run = run([sys.executable, "-m", "tltlc", "table1", "--shipped", "--out", str(folder)], TIMEOUT_S, cwd=ROOT)
    if process_run.status != 0:
        return {"failed": f"exit status {process_run.status}"}
    cells = {path.stem.replace("-", " "): _figures(path) for path in sorted(folder.glob("*.json"))}
    return {"table": process_run.output, "cells": cells, "source": source_digest("tltlc", "runtime")}


def _figures(path: Path) -> Record:
    episodes: list[Mapping[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["content"]
    means = (statistics.fmean(episode[key] for episode in episodes) for key in ("success", "progress", "reward"))
    return dict(zip(FIGURES, means, strict=True))
