"""Measure monitors of an automaton that counts: their size, and the time of steps early and late in the count.

Most of its 602 states count the steps after a player has touched a pit. The monitor as it is printed
reads tables. It is compared with one that has code for each state.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Final
from unittest.mock import patch

from benchmarks.markdown import met_or_missed, spread, table
from benchmarks.measure import median, quartiles
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.record import record
from tltlc.program import shapes

SECTION = "tables"
FACTOR: Final = 1.2
LARGEST: Final = 100_000
ROUNDS: Final = 15
_DRIVERS: Final = ROOT / "benchmarks" / "engines" / "counting"
_TIMEOUT_S: Final = 600.0
_SPEC: Final = """
clock 60 Hz
signal pit: bool
spec quiet { keep pit implies next (always for 10 s not pit and true) }
"""


@record
class Language:
    """A language: its driver, and the commands that build and run it.

    ``{source}`` in ``build`` stands for the generated file. So many ``monitors`` take the same steps
    in turn that their time can be measured. ``run`` is None if the language cannot run here.
    """

    title: str
    target: str
    driver: str
    run: tuple[str, ...] | None
    build: tuple[str, ...] = ()
    monitors: int = 4000


_GODOT: Final = ("env", "LANG=en", "godot3-server", "--path", ".", "-s", "steps.gd")
LANGUAGES: Final = {
    "c": Language("C", "c", "steps.c", ("./steps",), ("gcc", "-std=c99", "-O2", "steps.c", "-o", "steps", "-lm")),
    "rust": Language("Rust", "rust", "steps.rs", ("./steps",), ("rustc", "--edition", "2021", "-O", "steps.rs")),
    "csharp": Language(
        "C#, Mono",
        "csharp",
        "Steps.cs",
        ("mono", "steps.exe"),
        ("mcs", "-optimize+", "-out:steps.exe", "Steps.cs", "QuietMonitor.cs"),
    ),
    "javascript": Language("JavaScript, Node", "javascript", "steps.mjs", ("node", "steps.mjs")),
    "lua": Language("Lua", "lua", "steps.lua", ("lua", "steps.lua"), monitors=400),
    "luajit": Language("LuaJIT", "lua", "steps.lua", ("luajit", "steps.lua"), monitors=400),
    "python": Language("Python", "python", "steps.py", (sys.executable, "steps.py"), monitors=400),
    "gdscript3": Language("GDScript, Godot 3", "gdscript3", "steps.gd", _GODOT, monitors=300),
    "gdscript": Language("GDScript, Godot 4", "gdscript", "steps.gd", None),
}


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure each language that has no record of the present code."""
    code = {"source": source_digest("tltlc/program", "tltlc/backends")}
    (fspa,) = compile_text(_SPEC)
    measure_missing(
        store,
        SECTION,
        LANGUAGES,
        lambda name: {**measure_language(LANGUAGES[name], fspa), **code},
        say,
        field="bytes",
        current=code,
    )


def measure_language(language: Language, fspa: Fspa) -> Record:
    """Return the bytes and the times of both monitors."""
    with patch.object(shapes, "_LEAST_STATES", len(fspa.states) + 1):
        files = {"ladder": emit(language.target, fspa)}
    files["table"] = emit(language.target, fspa)
    sizes = {form: len(_content(next(iter(contents.values())))) for form, contents in files.items()}
    if language.run is None or shutil.which((*language.build, *language.run)[0]) is None:
        return {"states": len(fspa.states), "bytes": sizes}
    rounds: dict[str, list[dict[str, float]]] = {}
    for form, contents in files.items():
        with tempfile.TemporaryDirectory() as folder:
            for name, content in contents.items():
                Path(folder, name).write_bytes(_content(content))
            shutil.copy(_DRIVERS / language.driver, folder)
            Path(folder, "project.godot").touch()
            rounds[form] = _times(language, Path(folder))
    return {
        "states": len(fspa.states),
        "bytes": sizes,
        "ns": {
            form: {end: median([t[end] for t in times]) for end in ("first", "last")} for form, times in rounds.items()
        },
        "ratio": {form: quartiles([t["last"] / t["first"] for t in times]) for form, times in rounds.items()},
    }


def _times(language: Language, folder: Path) -> list[dict[str, float]]:
    """Return the times in nanoseconds of a step in each round but the first, when code may still be compiled."""
    if language.build:
        subprocess.run(language.build, cwd=folder, check=True, capture_output=True, timeout=_TIMEOUT_S)
    command = [*(language.run or ()), str(ROUNDS + 1), str(language.monitors)]
    output = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True, timeout=_TIMEOUT_S).stdout
    return [json.loads(line) for line in output.splitlines() if line.startswith("{")][1:]


def _content(content: str | bytes) -> bytes:
    return content.encode() if isinstance(content, str) else content


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals, if anything was measured."""
    sizes = {name: entry["bytes"]["table"] for name, entry in records.items()}
    ratios = {name: entry["ratio"]["table"][1] for name, entry in records.items() if "ratio" in entry}
    if not ratios:
        return
    largest, slowest = max(sizes, key=lambda name: sizes[name]), max(ratios, key=lambda name: ratios[name])
    yield (
        f"a monitor of 600 states under {LARGEST // 1000} KB in every language",
        f"largest {sizes[largest] / 1000:.0f} KB ({LANGUAGES[largest].title})",
        met_or_missed(sizes[largest] < LARGEST),
    )
    yield (
        f"a step from one of the last of 600 states at most {FACTOR:g} times one from the first, in every language",
        f"most {ratios[slowest]:.2f} ({LANGUAGES[slowest].title})",
        met_or_missed(ratios[slowest] <= FACTOR),
    )


def section(records: Mapping[str, Record]) -> str:
    """Return the section on monitors that count; empty without measurements."""
    rows = [_row(LANGUAGES[name].title, entry) for name, entry in records.items() if "bytes" in entry]
    if not rows:
        return ""
    states = next(iter(records.values()))["states"]
    header = [
        "language",
        "ladder, KB",
        "table, KB",
        "ladder, first",
        "last",
        "table, first",
        "last",
        "table, last / first",
    ]
    return f"""
## Monitors of automata that count

`keep pit implies next (always for 10 s not pit and true)`, in which no timer keeps the bound, has {states} states at
60 Hz, most of which count. Monitors of such automata read tables (`python -m benchmarks --only {SECTION}`). *Ladder* is
the same monitor without tables, with code for each state. *First* and *last* are nanoseconds of a step: of 20 steps
after the count began, and of 20 steps 570 steps later, as medians of {ROUNDS} rounds. Both were measured in turns, with
many monitors that take the same steps. *last / first* has the median of the ratios, with the quartiles. They are wall
times in Rust and GDScript, and CPU times in the other languages. Godot 4 does not run here.

{table(header, rows)}
"""


def _row(title: str, entry: Record) -> Sequence[str]:
    sizes = [f"{entry['bytes'][form] / 1000:.0f}" for form in ("ladder", "table")]
    if "ns" not in entry:
        return title, *sizes, "–", "–", "–", "–", "–"
    times = [_nanoseconds(entry["ns"][form][end]) for form in ("ladder", "table") for end in ("first", "last")]
    return title, *sizes, *times, spread(entry["ratio"]["table"], 2)


def _nanoseconds(time: float) -> str:
    return f"{time:,.0f}" if time >= 100 else f"{time:.3g}"
