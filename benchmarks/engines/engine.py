"""What a language gives to the benchmark: how its driver is built, what is said of it, and what its monitors weigh."""

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
)
"""Of a row, behind the monitor's name; the fields of the generated Python monitor's step."""


@record
class Signal:
    """A signal: its name in the spec, and that of the field or variable which holds it."""

    name: str
    field: str
    is_bool: bool


@record
class Task:
    """A spec, and the folder in which its generated monitor lies and everything is built."""

    name: str
    signals: tuple[Signal, ...]
    folder: Path


@record
class Engine:
    """A language and its compiler or interpreter.

    ``build`` makes the driver and returns the command that runs it: ``COMMAND rows TRACE...`` prints a row per step, of
    the generated monitor and then of the one written by hand; ``COMMAND time ROUNDS SECONDS TRACE`` prints JSON lines.
    ``compiled`` returns what both monitors take in the compiler's output, in bytes, by who wrote them and the kind of
    output.  ``sources`` are the generated files that a game takes, ``comments`` begin lines that are comments alone.
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
        """Why it cannot be used here, if it cannot."""
        lacking = [tool for tool in self.tools if shutil.which(tool) is None]
        return f"{', '.join(lacking)} is not installed" if lacking else None


def engines() -> tuple[Engine, ...]:
    """Those of all modules beside this one, by name."""
    from benchmarks import engines as package

    found: list[Engine] = []
    for module in pkgutil.iter_modules(package.__path__):
        found += getattr(importlib.import_module(f"{package.__name__}.{module.name}"), "ENGINES", ())
    return tuple(sorted(found, key=lambda engine: engine.name))


def generate(engine: Engine, name: str, folder: Path) -> Task:
    """Write the monitor of a spec, as its target writes it, into a folder."""
    fspa = next(fspa for fspa in compile_file(source(name)) if fspa.name == name)
    for file, content in emit(engine.target, fspa).items():
        (folder / file).write_bytes(content.encode() if isinstance(content, str) else content)
    signals = (Signal(each.name, _field(each.name), each.type == "bool") for each in fspa.signals)
    return Task(name, tuple(signals), folder)


def write_trace(task: Task, samples: Sequence[Mapping[str, float]], path: Path) -> Path:
    """A trace as the drivers read it: a line per sample, the values of the signals in their order."""
    lines = (" ".join(repr(sample[signal.name]) for signal in task.signals) for sample in samples)
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    return path


def make(task: Task, *command: str) -> None:
    """Run a compiler in the folder of a task; AssertionError, with what it says, where it fails."""
    done = subprocess.run(command, cwd=task.folder, capture_output=True, timeout=LONGEST_BUILD_S)
    said = (done.stdout + done.stderr).decode(errors="replace")
    assert done.returncode == 0, f"{' '.join(command)}\n{said}"


def fill(template: Path, task: Task, **tokens: str) -> None:
    """A file of the drivers into the folder of a task, with the text of each token for ``@TOKEN@``."""
    text = template.read_text(encoding="utf-8")
    for token, value in tokens.items():
        text = text.replace(f"@{token.upper()}@", value)
    (task.folder / template.name).write_text(text, encoding="utf-8")


def without_comments(engine: Engine, text: str) -> str:
    """A generated file without blank lines and lines that hold a comment alone."""
    lines = (line.strip() for line in text.splitlines())
    return "".join(f"{line}\n" for line in lines if line and not line.startswith(engine.comments))


def _field(name: str) -> str:
    return re.sub(r"\W+", "_", name).strip("_")
