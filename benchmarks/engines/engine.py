"""Describe a language for the benchmark: how to build its driver, and how large its monitors are."""

from __future__ import annotations

import importlib
import pkgutil
import re
import shutil
import subprocess
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final

from benchmarks.specs import source
from benchmarks.store import ROOT
from tltlc import compile_file
from tltlc.backends import emit
from tltlc.core.record import record

LONGEST_BUILD_S: Final = 120.0
DRIVERS: Final = ROOT / "benchmarks/engines/drivers"
BY_HAND: Final = ROOT / "benchmarks/handwritten"
OUTPUT_FIELDS: Final = (
    "state",
    "label",
    "verdict",
    "accepting",
    "done",
    "progress",
    "reward",
    "robustness",
    "limiting",
    "label_english",
    "failed_clause",
    "failed_atom",
    "failed_step",
)
"""The columns of a row after the monitor's name: the fields of a step; a cell is empty if there is none."""


@record
class Signal:
    """A signal: its name in the spec, and the name of its field or variable in the generated code."""

    name: str
    field: str
    is_bool: bool


@record
class Task:
    """A spec, and the folder that has its generated monitor and in which everything is built."""

    name: str
    signals: tuple[Signal, ...]
    folder: Path


@record
class Engine:
    """A language and its compiler or interpreter.

    ``build`` makes the driver and returns the command that runs it: ``COMMAND rows TRACE...`` prints a
    row per step, first of the generated monitor and then of the handwritten one; ``COMMAND time
    ROUNDS SECONDS TRACE`` prints JSON lines. ``compiled`` returns the bytes of both monitors in the
    compiler's output, by author and kind of output. ``sources`` are the generated files that a game
    uses; ``{name}`` in them stands for the name of the spec, and ``{Name}`` for this name in Pascal
    case. Lines that start with one of ``comments`` contain only a comment.
    """

    name: str
    title: str
    target: str
    version: tuple[str, ...]
    sources: tuple[str, ...]
    comments: tuple[str, ...]
    build: Callable[[Task], tuple[str, ...]]
    compiled: Callable[[Task], Mapping[str, Mapping[str, int]]]
    tools: tuple[str, ...] = ()

    def missing(self) -> str | None:
        """Return why the language cannot be measured on this machine; None if it can."""
        missing = [tool for tool in self.tools if shutil.which(tool) is None]
        return f"{', '.join(missing)} is not installed" if missing else None


def engines() -> tuple[Engine, ...]:
    """Return the engines of all modules in this package, sorted by name."""
    from benchmarks import engines as package

    all_engines: list[Engine] = []
    for module in pkgutil.iter_modules(package.__path__):
        all_engines += getattr(importlib.import_module(f"{package.__name__}.{module.name}"), "ENGINES", ())
    return tuple(sorted(all_engines, key=lambda engine: engine.name))


def generate(engine: Engine, name: str, folder: Path) -> Task:
    """Write the generated monitor of a spec into a folder; return the task of building and running it."""
    fspa = next(fspa for fspa in compile_file(source(name)) if fspa.name == name)
    for file, content in emit(engine.target, fspa).items():
        (folder / file).write_bytes(content.encode() if isinstance(content, str) else content)
    signals = (Signal(signal.name, field(signal.name), signal.type == "bool") for signal in fspa.signals)
    return Task(name, tuple(signals), folder)


def write_trace(task: Task, samples: Sequence[Mapping[str, float]], path: Path) -> Path:
    """Write a trace for the drivers: a line per sample, with the values of the signals in order; return the path."""
    lines = (" ".join(repr(sample[signal.name]) for signal in task.signals) for sample in samples)
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    return path


def make(task: Task, *command: str) -> None:
    """Run a compiler in the folder of a task; raise AssertionError with its output if it fails."""
    completed = subprocess.run(command, cwd=task.folder, capture_output=True, timeout=LONGEST_BUILD_S)
    output = (completed.stdout + completed.stderr).decode(errors="replace")
    assert completed.returncode == 0, f"{' '.join(command)}\n{output}"


def fill(template: Path, task: Task, **tokens: str) -> None:
    """Copy a file of the drivers into the folder of a task, and replace each ``@TOKEN@`` by its text."""
    text = template.read_text(encoding="utf-8")
    for token, value in tokens.items():
        text = text.replace(f"@{token.upper()}@", value)
    (task.folder / template.name).write_text(text, encoding="utf-8")


def without_comments(engine: Engine, text: str) -> str:
    """Return a generated file without blank lines and without lines that contain only a comment."""
    lines = (line.strip() for line in text.splitlines())
    return "".join(f"{line}\n" for line in lines if line and not line.startswith(engine.comments))


def field(name: str) -> str:
    """Return the name of a signal's field in generated code, if it is no keyword."""
    return re.sub(r"\W+", "_", name).strip("_")
