"""Steps per second of monitors in the languages of engines, generated and written by hand, and what they weigh.

For each language a driver steps both monitors over the recorded trace of each of the paper's specs.  Before anything is
timed they are checked to agree in every field of each step.
"""

from __future__ import annotations

import json
import re
import subprocess
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final

from benchmarks.engines.engine import OUTPUT_FIELDS, Engine, Task, engines, generate, without_comments, write_trace
from benchmarks.measure import median, quartiles
from benchmarks.monitors import ROUND_S, ROUNDS
from benchmarks.specs import PAPER_SPECS, trace
from benchmarks.store import Record, Store, measure_missing

SECTION = "engines"
TIMEOUT_S: Final = 600.0

_TOLERANCE: Final = 1e-12
_WHO: Final = ("generated", "by_hand")

Rows = dict[str, list[tuple[str, ...]]]


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure each language on each spec, unless the store has that already or there is no compiler."""
    found = engines()
    named = {f"{engine.name} {spec}": (engine, spec) for engine in found for spec in PAPER_SPECS}
    measure_missing(store, SECTION, named, lambda name: _measured(*named[name]), say)


def _measured(engine: Engine, spec: str) -> Record:
    reason = engine.missing()
    if reason is not None:
        return {"left_out": reason}
    with tempfile.TemporaryDirectory() as folder:
        task = generate(engine, spec, Path(folder))
        samples = trace(spec)
        written = write_trace(task, samples, task.folder / "trace.txt")
        command = engine.build(task)
        rows = stepped(task, command, [written])
        difference = disagreement(rows["generated"], rows["by_hand"])
        if difference is not None:
            return {"failed": difference}
        said = _said(task, (*command, "time", str(ROUNDS), str(ROUND_S), written.name))
        rounds = [json.loads(line) for line in said.splitlines() if line.startswith("{")]
        return {
            "version": _version(engine),
            "samples": len(samples),
            "rounds": len(rounds),
            "steps_per_s": {who: round(median([each[who] for each in rounds])) for who in _WHO},
            "generated_to_by_hand": quartiles([each["generated"] / each["by_hand"] for each in rounds]),
            "bytes": _bytes(engine, task),
            "compiled": engine.compiled(task),
        }


def stepped(task: Task, command: Sequence[str], traces: Sequence[Path]) -> Rows:
    """What both monitors of a driver say of each step of some traces, in the columns of ``OUTPUT_FIELDS``."""
    rows: Rows = {who: [] for who in _WHO}
    for line in _said(task, (*command, "rows", *(path.name for path in traces))).splitlines():
        who, *cells = line.split("\t")
        if who in rows and len(cells) == len(OUTPUT_FIELDS):
            rows[who].append(tuple(cells))
    return rows


def disagreement(found: Sequence[Sequence[str]], expected: Sequence[Sequence[str]]) -> str | None:
    """The first field of the first step in which two monitors differ, in words; numbers may be off by rounding."""
    if not expected or len(found) != len(expected):
        return f"{len(found)} steps, not {len(expected)}"
    for step, (row, right) in enumerate(zip(found, expected, strict=True), start=1):
        for field, cell, wanted in zip(OUTPUT_FIELDS, row, right, strict=True):
            if cell != wanted and not _near(cell, wanted):
                return f"step {step}: {field} is {cell!r}, not {wanted!r}"
    return None


def _near(cell: str, wanted: str) -> bool:
    try:
        return abs(float(cell) - float(wanted)) <= _TOLERANCE
    except ValueError:
        return False


def _said(task: Task, command: Sequence[str]) -> str:
    done = subprocess.run(command, cwd=task.folder, capture_output=True, text=True, timeout=TIMEOUT_S)
    assert done.returncode == 0, f"{' '.join(command)}\n{done.stdout}{done.stderr}"
    return done.stdout


def _version(engine: Engine) -> str:
    """The first number with dots in what the compiler says of itself."""
    done = subprocess.run(engine.version, capture_output=True, text=True)
    said = re.search(r"\d+(\.\d+)+", done.stdout + done.stderr)
    return said[0] if said else "unknown"


def _bytes(engine: Engine, task: Task) -> Mapping[str, int]:
    """The generated file, as it is and without comments."""
    texts = [(task.folder / name.format(name=task.name)).read_text(encoding="utf-8") for name in engine.sources]
    return {
        "file": sum(len(text.encode()) for text in texts),
        "without comments": sum(len(without_comments(engine, text).encode()) for text in texts),
    }
