"""Measure the speed and size of monitors in the languages of engines, generated and written by hand.

For each language, a driver steps both monitors over the recorded trace of each of the paper's specs.
Before anything is timed, all fields of all their steps are compared.
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
from tltlc.program.enums import pascal_case

SECTION = "engines"
TIMEOUT_S: Final = 600.0

_TOLERANCE: Final = 1e-12
_AUTHORS: Final = ("generated", "by_hand")

Rows = dict[str, list[tuple[str, ...]]]


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure each language on each spec that has no record in the store."""
    all_engines = engines()
    tasks = {f"{engine.name} {spec}": (engine, spec) for engine in all_engines for spec in PAPER_SPECS}
    measure_missing(store, SECTION, tasks, lambda name: _measure_engine(*tasks[name]), say)


def _measure_engine(engine: Engine, spec: str) -> Record:
    reason = engine.missing()
    if reason is not None:
        return {"left_out": reason}
    with tempfile.TemporaryDirectory() as folder:
        task = generate(engine, spec, Path(folder))
        samples = trace(spec)
        trace_path = write_trace(task, samples, task.folder / "trace.txt")
        command = engine.build(task)
        rows = monitor_rows(task, command, [trace_path])
        difference = disagreement(rows["generated"], rows["by_hand"])
        if difference is not None:
            return {"failed": difference}
        output = _output_of(task, (*command, "time", str(ROUNDS), str(ROUND_S), trace_path.name))
        rounds = [json.loads(line) for line in output.splitlines() if line.startswith("{")]
        return {
            "version": _version(engine),
            "samples": len(samples),
            "rounds": len(rounds),
            "steps_per_s": {author: round(median([rates[author] for rates in rounds])) for author in _AUTHORS},
            "generated_to_by_hand": quartiles([rates["generated"] / rates["by_hand"] for rates in rounds]),
            "bytes": _bytes(engine, task),
            "compiled": engine.compiled(task),
        }


def monitor_rows(task: Task, command: Sequence[str], traces: Sequence[Path]) -> Rows:
    """Return the rows of both monitors of a driver for each step of some traces, in the order of ``OUTPUT_FIELDS``."""
    rows: Rows = {author: [] for author in _AUTHORS}
    for line in _output_of(task, (*command, "rows", *(path.name for path in traces))).splitlines():
        author, *cells = line.split("\t")
        if author in rows and len(cells) == len(OUTPUT_FIELDS):
            rows[author].append(tuple(cells))
    return rows


def disagreement(actual: Sequence[Sequence[str]], expected: Sequence[Sequence[str]]) -> str | None:
    """Return the first difference of two monitors as text, None if there is none; numbers may differ by 1e-12."""
    if not expected or len(actual) != len(expected):
        return f"{len(actual)} steps, not {len(expected)}"
    for step, (row, right) in enumerate(zip(actual, expected, strict=True), start=1):
        for field, cell, right_cell in zip(OUTPUT_FIELDS, row, right, strict=True):
            if cell != right_cell and not _is_near(cell, right_cell):
                return f"step {step}: {field} is {cell!r}, not {right_cell!r}"
    return None


def _is_near(cell: str, right_cell: str) -> bool:
    try:
        return abs(float(cell) - float(right_cell)) <= _TOLERANCE
    except ValueError:
        return False


def _output_of(task: Task, command: Sequence[str]) -> str:
    completed = subprocess.run(command, cwd=task.folder, capture_output=True, text=True, timeout=TIMEOUT_S)
    assert completed.returncode == 0, f"{' '.join(command)}\n{completed.stdout}{completed.stderr}"
    return completed.stdout


def _version(engine: Engine) -> str:
    """Return the version of a compiler: the first number with dots that it prints."""
    completed = subprocess.run(engine.version, capture_output=True, text=True)
    number = re.search(r"\d+(\.\d+)+", completed.stdout + completed.stderr)
    return number[0] if number else "unknown"


def _bytes(engine: Engine, task: Task) -> Mapping[str, int]:
    """Return the bytes of the generated files, as they are and without comments."""
    files = [file.format(name=task.name, Name=pascal_case(task.name)) for file in engine.sources]
    texts = [(task.folder / file).read_text(encoding="utf-8") for file in files]
    return {
        "file": sum(len(text.encode()) for text in texts),
        "without comments": sum(len(without_comments(engine, text).encode()) for text in texts),
    }
