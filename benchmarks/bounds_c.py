"""Build C monitors of a spec with bounds, and run them on the same traces: generated ones and handwritten ones.

The handwritten monitors are in ``benchmarks/handwritten/c/bounds``. Those named ``SPEC_verdict`` keep a counter per
clause and compute only the verdict, as Copilot and R2U2 do; those named ``SPEC`` compute every field of a step.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from benchmarks.bounds_specs import ATOMS, SPECS, TIMERLESS, Trace
from benchmarks.engines.engine import BY_HAND, DRIVERS, Signal, Task, field, fill, make, write_trace
from benchmarks.monitors import ROUND_S
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.record import record
from tltlc.monitor import Monitor

TIMED: Final = ("generated", "no_registers", "generated_verdict", "without_timers", "by_hand", "verdict_only")
MACROS: Final = {
    "generated": ("TLTL_SPARSE",),
    "no_registers": ("TLTL_SPARSE", "TLTL_NO_REGISTERS"),
    "generated_verdict": ("TLTL_SPARSE", "TLTL_VERDICT_ONLY"),
    "without_timers": ("TLTL_SPARSE",),
}
"""The macros with which generated monitors are compiled: as handwritten ones, they do not refuse a missing bool."""
LONGEST_RUN_S: Final = 600.0
_STATE: Final = 6
"""The place of the state in a row of a monitor that computes every field."""
_FLAGS: Final = ("gcc", "-std=c99", "-O2", "-falign-functions=64", "-Wall", "-Wextra", "-Werror")
"""Functions begin at lines of the cache: otherwise rates change by up to a tenth with what else is linked."""


@record
class Program:
    """A program that runs the monitors of ``TIMED``, and the verdicts of :class:`tltlc.monitor.Monitor` per trace."""

    folder: Path
    verdicts: tuple[tuple[str, ...], ...]


def build(name: str, folder: Path, traces: Sequence[Trace]) -> Program:
    """Build the program of a spec in an empty folder, with the files of its traces."""
    (fspa,) = compile_text(SPECS[name])
    (timerless,) = compile_text(TIMERLESS[name])
    assert len(timerless.states) == len(fspa.states), "the automaton without timers is another one"
    verdicts, inner = zip(*(_reference(name, fspa, trace) for trace in traces), strict=True)
    signals, inner_signals = [signal.name for signal in fspa.signals], [signal.name for signal in timerless.signals]
    bounds = DRIVERS / "bounds"
    for author in TIMED:
        of, its_signals, its_traces = (
            (timerless, inner_signals, inner) if author == "without_timers" else (fspa, signals, traces)
        )
        task = Task(author, tuple(Signal(signal, field(signal), True) for signal in its_signals), folder / author)
        task.folder.mkdir()
        if author in MACROS:
            for file, content in emit("c", of).items():
                (task.folder / file).write_text(str(content), encoding="utf-8")
            fill(bounds / "generated.h", task, spec=of.name)
            adapter = "generated.h"
        else:
            spec = f"{name}_verdict" if author == "verdict_only" else name
            fill(bounds / "by_hand.h", task, by_hand=str(BY_HAND / "c/bounds"), spec=spec)
            adapter = "by_hand.h"
        assignments = [f"    sample.{s.field} = numbers[{place}] != 0.0;" for place, s in enumerate(task.signals)]
        fill(DRIVERS / "c/sample.h", task, assignments="\n".join(assignments))
        for file in ("pass.c", "pass.h"):
            shutil.copy(bounds / file, task.folder)
        defines = [f'-DADAPTER="{adapter}"', f"-DWHO={author}", f"-DCOLUMNS={len(task.signals)}"]
        defines += [f"-D{macro}" for macro in MACROS.get(author, ())]
        make(task, *_FLAGS, *defines, "-c", "pass.c", "-o", f"../{author}.o")
        for place, trace in enumerate(its_traces):
            write_trace(task, trace, folder / f"{author}_{place}.txt")
    task = Task("driver", (), folder)
    fill(bounds / "driver.c", task, names=", ".join(TIMED), places=", ".join(f"&{author}" for author in TIMED))
    shutil.copy(bounds / "pass.h", folder)
    make(task, *_FLAGS, "driver.c", *(f"{author}.o" for author in TIMED), "-o", "driver", "-lm")
    return Program(folder, verdicts)


def _reference(name: str, fspa: Fspa, trace: Trace) -> tuple[tuple[str, ...], Trace]:
    """Return the verdicts after each sample, and the samples of the spec without timers."""
    monitor = Monitor(fspa)
    places = {atom.name: place for place, atom in enumerate(fspa.atoms)}
    verdicts, inner = [], []
    for sample in trace:
        verdicts.append(monitor.step(sample).verdict)
        inner.append({signal: float(monitor.values[places[atom]] > 0) for signal, atom in ATOMS[name].items()})
    return tuple(verdicts), inner


def disagreement(program: Program) -> str | None:
    """Return the first difference between monitors on a trace, as text; None if there is none.

    Each verdict must be that of the reference, and each field of the handwritten monitor, and of the one that has no
    registers to read, that of the generated one. The generated one that finds only verdicts must find its states, too.
    """
    rows: dict[str, list[list[str]]] = {author: [] for author in TIMED}
    for line in _output(program, "rows", str(len(program.verdicts))).splitlines():
        author, *cells = line.split("\t")
        rows[author].append(cells)
    expected = [verdict for verdicts in program.verdicts for verdict in verdicts]
    for author in TIMED:
        if len(rows[author]) != len(expected):
            return f"{author}: {len(rows[author])} steps, not {len(expected)}"
        for step, (row, verdict) in enumerate(zip(rows[author], expected, strict=True)):
            if row[0] != verdict:
                return f"{author}, step {step}: {row[0]}, not {verdict}"
            if author in ("by_hand", "no_registers") and row != rows["generated"][step]:
                return f"{author}, step {step}: {row}, not {rows['generated'][step]}"
            if author == "generated_verdict" and row[1:] != rows["generated"][step][_STATE : _STATE + 1]:
                return f"{author}, step {step}: state {row[1]}, not {rows['generated'][step][_STATE]}"
    return None


def time_rounds(program: Program, rounds: int) -> list[Mapping[str, float]]:
    """Return the steps per second of CPU time on the first trace, by author; all run in turn in each round."""
    lines = _output(program, "time", str(rounds), str(ROUND_S)).splitlines()
    return [json.loads(line) for line in lines]


def _output(program: Program, *words: str) -> str:
    completed = subprocess.run(
        ["./driver", *words], cwd=program.folder, capture_output=True, text=True, timeout=LONGEST_RUN_S
    )
    assert completed.returncode == 0, completed.stderr
    return completed.stdout
