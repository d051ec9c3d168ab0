"""Monitors in other languages: how they are built, run, and held against the expected rows."""

from __future__ import annotations

import csv
import importlib
import io
import pkgutil
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from tltlc import backends
from tltlc.conformance.case import Case
from tltlc.conformance.expected import COLUMNS, Expected, Refusal
from tltlc.record import record

LONGEST_BUILD_S = 120
LONGEST_RUN_S = 30

_NUMBERS = ("progress", "reward", "robustness")
_OF_A_FILE = ("no sample", "missing signal", "bad cell")
"""Errors that are those of the file: messages need not tell the step."""


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
    said = done.stderr.decode()
    status = 1 if expected.refusal else 0
    if done.returncode != status:
        yield f"exit status {done.returncode}, not {status}: {said}"
    yield from _in_rows(runner, done.stdout.decode(), expected)
    yield from _in_words(said, expected)


def _in_rows(runner: Runner, printed: str, expected: Expected) -> Iterator[str]:
    """Cell by cell; where the first sample is refused, the header may be missing."""
    rows = [tuple(row) for row in csv.reader(io.StringIO(printed, newline=""), strict=True)]
    header, *found = rows or [COLUMNS]
    if header != COLUMNS:
        yield f"the header is {header}"
    if (rows or expected.rows) and len(found) != len(expected.rows):
        yield f"{len(found)} rows, not {len(expected.rows)}"
    for number, (row, right) in enumerate(zip(found, expected.rows), start=1):  # noqa: B905 (counted above)
        if len(row) != len(right):
            yield f"row {number} has {len(row)} cells: {row}"
            continue
        for column, cell, wanted in zip(COLUMNS, row, right, strict=True):
            if cell != wanted and not (column in _NUMBERS and _near(cell, wanted, runner.tolerance)):
                yield f"row {number}: {column} is {cell!r}, not {wanted!r}"


def _near(cell: str, wanted: str, tolerance: float) -> bool:
    try:
        return tolerance > 0.0 and abs(float(cell) - float(wanted)) <= tolerance
    except ValueError:
        return False


def _in_words(said: str, expected: Expected) -> Iterator[str]:
    """In standard error: a line for an error that names what is to blame, and one for each warning."""
    lines = said.splitlines()
    errors = [line for line in lines if line.startswith("error: ")]
    if expected.refusal is None:
        warnings = sum(line.startswith("warning: ") for line in lines)
        if errors or warnings != expected.warnings:
            yield f"{warnings} warnings, not {expected.warnings}: {said}"
    elif len(errors) != 1:
        yield f"{len(errors)} errors in: {said}"
    else:
        yield from _in_error(errors[0], expected.refusal)


def _in_error(line: str, refusal: Refusal) -> Iterator[str]:
    if refusal.kind not in _OF_A_FILE and not line.startswith(f"error: step {refusal.step}: "):
        yield f"an error at step {refusal.step}, not: {line}"
    for name in refusal.names:
        if not re.search(rf"(?<!\w){re.escape(name)}(?!\w)", line):
            yield f"the error does not name {name}: {line}"
