"""Measure how fast ``tltlc monitor`` judges many traces, as a multiple of the time of reading them."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from random import Random
from typing import Final

from benchmarks.markdown import met_or_missed, spread, table
from benchmarks.measure import median, quartiles, run
from benchmarks.process import TLTLC, with_bytecode
from benchmarks.specs import source
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest

SECTION = "judge"
FACTOR: Final = 2.0
"""Judging the traces may take this many times as long as reading them."""
TRACES: Final = 10_000
SAMPLES: Final = 1_000
ROUNDS: Final = 3
_KEY: Final = "cover_and_hide"
_TIMEOUT_S: Final = 1_800.0

_READ: Final = """
import csv, multiprocessing, sys
from pathlib import Path

def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return len([{name: float(cell) for name, cell in row.items()} for row in csv.DictReader(file)])

if __name__ == "__main__":
    paths = sorted(Path(sys.argv[1]).iterdir())
    with multiprocessing.Pool(int(sys.argv[2])) as pool:
        print(sum(pool.imap(read, paths, chunksize=8)))
"""
"""A program that reads all traces with Python's own reader, in as many processes as ``tltlc monitor`` uses."""


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure both programs in turns, unless the store has a record of this code."""
    code = {"source": source_digest("tltlc")}
    measure_missing(store, SECTION, [_KEY], lambda _: {**_compare(), **code}, say, field="ratio", current=code)


def _compare() -> Record:
    """Return the wall times of judging and of reading, and their ratio in each round."""
    cores = len(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory() as folder:
        traces, reader = Path(folder, "traces"), Path(folder, "read.py")
        traces.mkdir()
        reader.write_text(_READ, encoding="utf-8")
        for number in range(TRACES):
            (traces / f"{number:05}.csv").write_text(_trace(Random(number)), encoding="utf-8")
        environment = with_bytecode(Path(folder))
        lines = {
            "judge": [*TLTLC, "monitor", str(source(_KEY)), str(traces), "--workers", str(cores)],
            "read": [sys.executable, str(reader), str(traces), str(cores)],
        }
        times: dict[str, list[float]] = {name: [] for name in lines}
        accepted = ""
        for _ in range(ROUNDS):
            for name, line in lines.items():
                outcome = run(line, _TIMEOUT_S, cwd=ROOT, environment=environment)
                if not outcome.output or outcome.status not in (0, 1):
                    return {"failed": f"{name}: exit status {outcome.status}"}
                times[name].append(outcome.wall_ms)
                accepted = outcome.output.splitlines()[-1] if name == "judge" else accepted
    ratios = [judged / read for judged, read in zip(times["judge"], times["read"], strict=True)]
    return {
        "cores": cores,
        "summary": accepted,
        "judge_ms": median(times["judge"]),
        "read_ms": median(times["read"]),
        "ratio": quartiles(ratios),
    }


def _trace(random: Random) -> str:
    """Return a trace of the spec; about half of such traces are accepted."""
    goals, death = sorted(random.sample(range(SAMPLES), 3)), random.randrange(2 * SAMPLES)
    lines = ["distance(s1),distance(s2),distance(exit),health"]
    for sample in range(SAMPLES):
        distances = [0.5 if sample == goal else random.uniform(2.0, 20.0) for goal in goals]
        lines.append(",".join([*(f"{distance:.3f}" for distance in distances), "0.0" if sample >= death else "1.0"]))
    return "\n".join([*lines, ""])


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the row of the table of goals, if there is a measurement."""
    record = records.get(_KEY, {})
    if "ratio" in record:
        goal = f"{TRACES:,} traces of {SAMPLES:,} samples judged in {FACTOR:g} times the time of reading them"
        yield goal, f"{record['ratio'][1]:.2f}", met_or_missed(record["ratio"][1] <= FACTOR)


def section(records: Mapping[str, Record]) -> str:
    """Return the section on many traces; empty without measurements."""
    record = records.get(_KEY, {})
    if "ratio" not in record:
        return ""
    row = (f"{record['judge_ms'] / 1e3:.1f}", f"{record['read_ms'] / 1e3:.1f}", spread(record["ratio"]))
    return f"""
## Many traces

`tltlc monitor {_KEY}.tltl FOLDER` on {TRACES:,} traces in CSV with {SAMPLES:,} samples each, in {record["cores"]}
processes, and a program that only reads them, with Python's `csv.DictReader` and `float`, in as many processes. Wall
times in {ROUNDS} rounds, in turns. What it says: {record["summary"]}

{table(("judging, s", "reading, s", "ratio"), [row])}
"""
