"""Build and run generated monitors in other languages, and compare them with the expected rows."""

from __future__ import annotations

import importlib
import pkgutil
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from tests.waiting import HANG_S
from tltlc import backends
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.program.enums import pascal_case
from tltlc.tools.conformance.check import differences
from tltlc.tools.conformance.expected_output import COLUMNS, ExpectedOutput

LONGEST_BUILD_S = LONGEST_RUN_S = HANG_S

Outcome = tuple[int, str, str]
"""Exit status, standard output, standard error."""

Runs = Sequence[tuple[str, bytes]]
"""Pairs of a monitor's name and the trace that it reads."""


@record
class Runner:
    """How to build and run the monitors of one target, from the folder that holds them.

    Commands are lists of words; ``{name}`` in a word stands for the name of the spec, and ``{Name}`` for
    this name in Pascal case. ``build``
    and ``run`` are the commands for one monitor, as a user would type them. ``build_all`` and
    ``run_all`` handle many monitors at once, because compilers and engines are slow to start.
    ``build_all`` takes the folder and the names of the monitors, and makes one program of them.
    ``run_all`` starts this program with alternating names of a monitor and of a trace. For each
    trace the program writes a line ``@@ TRACE`` to standard output and to standard error; then it
    does what the monitor's own program does with ``--full TRACE``; last it writes a line ``@@status
    N`` to standard error.

    ``tools`` are programs that must be installed. ``tolerance`` is the allowed difference between
    numbers; with 0, the printed numbers must be identical. ``target`` is the target of ``tltlc
    compile``; a language may have several runners.
    """

    name: str
    target: str
    run: tuple[str, ...]
    build: tuple[str, ...] = ()
    build_all: Callable[[Path, Sequence[str]], None] | None = None
    run_all: tuple[str, ...] = ()
    tools: tuple[str, ...] = ()
    tolerance: float = 0.0

    def missing(self) -> str | None:
        """Return why this runner cannot be used here, or None if it can."""
        lacking = [tool for tool in self.tools if shutil.which(tool) is None]
        if lacking:
            return f"{self.name}: {', '.join(lacking)} is not installed"
        return None if self.target in backends.targets() else f"{self.name}: there is no target {self.target}"


def runners() -> tuple[Runner, ...]:
    """Return the runners of all modules in ``runners``, sorted by name."""
    from tests.tools.conformance import runners as package

    all_runners: list[Runner] = []
    for module in pkgutil.iter_modules(package.__path__):
        all_runners += importlib.import_module(f"{package.__name__}.{module.name}").RUNNERS
    return tuple(sorted(all_runners, key=lambda runner: runner.name))


def write(runner: Runner, fspa: Fspa, folder: Path) -> None:
    """Write the monitor of an automaton, as the target emits it, into the folder."""
    for name, content in backends.emit(runner.target, fspa).items():
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)


def execute(command: Sequence[str], folder: Path) -> None:
    """Run a command that builds something."""
    process = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_BUILD_S)
    output = (process.stdout + process.stderr).decode(errors="replace")
    assert process.returncode == 0, f"{' '.join(command)}\n{output}"


def build(runner: Runner, name: str, folder: Path) -> None:
    """Build the program of one monitor, whose source is in the folder."""
    if runner.build:
        execute(words_for(runner.build, name), folder)


def words_for(command: Sequence[str], name: str) -> list[str]:
    """Return a command of a runner for the spec called ``name``."""
    return [word.format(name=name, Name=pascal_case(name)) for word in command]


def run_monitor(runner: Runner, name: str, folder: Path, trace: bytes) -> Outcome:
    """Run the program of one monitor, which is already built, on a trace."""
    (folder / f"{name}.trace.csv").write_bytes(trace)
    command = words_for((*runner.run, "--full", "{name}.trace.csv"), name)
    process = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_RUN_S)
    return process.returncode, process.stdout.decode(), process.stderr.decode()


def build_program(runner: Runner, fspas: Sequence[Fspa], folder: Path) -> Callable[[Runs], list[Outcome]]:
    """Build one program for many monitors, or one per monitor if the runner has no ``build_all``.

    Return a function that runs the monitors over traces, in one process where there is one program.
    """
    for fspa in fspas:
        write(runner, fspa, folder)
    names = [fspa.name for fspa in fspas]
    if runner.build_all is None:
        for name in names:
            build(runner, name, folder)
        return lambda runs: [run_monitor(runner, name, folder, trace) for name, trace in runs]
    runner.build_all(folder, names)
    return lambda runs: _run_all(runner, folder, runs)


def _run_all(runner: Runner, folder: Path, runs: Runs) -> list[Outcome]:
    command, traces = [*runner.run_all], []
    for number, (name, trace) in enumerate(runs):
        traces.append(f"{number}.csv")
        (folder / traces[-1]).write_bytes(trace)
        command += [name, traces[-1]]
    process = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_RUN_S)
    outputs, errors = (_output_by_trace(text.decode()) for text in (process.stdout, process.stderr))
    outcomes = []
    for (name, _), trace_name in zip(runs, traces, strict=True):
        err, _, status = errors.get(trace_name, "").rpartition("@@status ")
        whole = re.fullmatch(r"\d+\s*", status) and trace_name in outputs
        assert whole, f"{runner.name}, {name}, {trace_name}: the program ended within it: {status[-5000:]}"
        outcomes.append((int(status), outputs[trace_name], err))
    assert (process.returncode, [*outputs], [*errors]) == (0, traces, traces)
    return outcomes


def _output_by_trace(text: str) -> dict[str, str]:
    """Split the output into the part printed for each trace, by the trace's name."""
    pieces = re.split(r"^@@ (\d+\.csv)\r?\n", text, flags=re.MULTILINE)
    return dict(zip(pieces[1::2], pieces[2::2], strict=True))


def output_differences(
    outcome: Outcome, expected: ExpectedOutput, tolerance: float, columns: Sequence[str] = COLUMNS
) -> Iterator[str]:
    """Yield the differences between a program's outcome and the expected one, on one trace."""
    error = expected.rejection and expected.rejection.document()
    return differences(*outcome, [columns, *expected.rows], expected.warnings, error, tolerance)
