"""Monitors in other languages: how they are built, run, and held against the expected rows."""

from __future__ import annotations

import importlib
import pkgutil
import shutil
import subprocess
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from tests.waiting import HANG_S
from tltlc import backends
from tltlc.conformance.case import Case
from tltlc.conformance.check import differences
from tltlc.conformance.expected import COLUMNS, Expected
from tltlc.record import record

LONGEST_BUILD_S = LONGEST_RUN_S = HANG_S


@record
class Runner:
    """How the monitors of one target are built and run, from the folder that holds them.

    Commands are given word by word; ``{name}`` in them is the name of the case.  ``build`` runs once per case.
    ``build_all`` takes the folder and the names of all cases, once, in place of that: for compilers that are slow to
    start.  ``tools`` are programs that must be installed.  ``tolerance`` is how far numbers may be off; with 0 they
    are the same text.  ``target`` is that of ``tltlc compile``; a language may have several runners.
    """

    name: str
    target: str
    run: tuple[str, ...]
    build: tuple[str, ...] = ()
    build_all: Callable[[Path, Sequence[str]], None] | None = None
    tools: tuple[str, ...] = ()
    tolerance: float = 0.0

    def missing(self) -> str | None:
        """Why it cannot be used here, if it cannot."""
        lacking = [tool for tool in self.tools if shutil.which(tool) is None]
        if lacking:
            return f"{self.name}: {', '.join(lacking)} is not installed"
        return None if self.target in backends.targets() else f"{self.name}: there is no target {self.target}"


def runners() -> tuple[Runner, ...]:
    """Those of all modules of ``runners``, by name."""
    from tests.conformance import runners as package

    found: list[Runner] = []
    for module in pkgutil.iter_modules(package.__path__):
        found += importlib.import_module(f"{package.__name__}.{module.name}").RUNNERS
    return tuple(sorted(found, key=lambda runner: runner.name))


def write(runner: Runner, case: Case, folder: Path) -> None:
    """The monitor of a case, as its target writes it, into the folder."""
    for name, content in backends.emit(runner.target, case.fspa).items():
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)


def build(runner: Runner, name: str, folder: Path) -> None:
    """Run what is to be run once per case."""
    if runner.build:
        command = [word.format(name=name) for word in runner.build]
        done = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_BUILD_S)
        said = (done.stdout + done.stderr).decode(errors="replace")
        assert done.returncode == 0, f"{' '.join(command)}\n{said}"


def problems(runner: Runner, name: str, folder: Path, trace: bytes, expected: Expected) -> Iterator[str]:
    """What a monitor that has been built does otherwise than expected, on one trace."""
    (folder / f"{name}.trace.csv").write_bytes(trace)
    command = [word.format(name=name) for word in (*runner.run, "--full", "{name}.trace.csv")]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_RUN_S)
    error = expected.refusal and expected.refusal.document()
    out, err, rows = done.stdout.decode(), done.stderr.decode(), [COLUMNS, *expected.rows]
    return differences(done.returncode, out, err, rows, expected.warnings, error, runner.tolerance)
