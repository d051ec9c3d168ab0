"""Monitors in other languages: how they are built, run, and held against the expected rows."""

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
from tltlc.tools.conformance.check import differences
from tltlc.tools.conformance.expected import COLUMNS, Expected

LONGEST_BUILD_S = LONGEST_RUN_S = HANG_S

Outcome = tuple[int, str, str]
"""Exit status, standard output, standard error."""

Runs = Sequence[tuple[str, bytes]]
"""Names of monitors, each with a trace that it reads."""


@record
class Runner:
    """How the monitors of one target are built and run, from the folder that holds them.

    Commands are given word by word; ``{name}`` in them is the name of the monitor.  ``build`` and ``run`` are what a
    person does who has one monitor.  ``build_all`` and ``run_all`` are for many, since compilers and engines are slow
    to start: the first takes the folder and the names of monitors, and makes one program of theirs; the second starts
    it, with the names of a monitor and of a trace, of another monitor and of another trace, and so on.  For each trace
    the program writes a line ``@@ TRACE`` to standard output and to standard error; then it does what the monitor's
    own program does with ``--full TRACE``; last it writes a line ``@@status N`` to standard error.
    ``tools`` are programs that must be installed.  ``tolerance`` is how far numbers may be off; with 0 they are the
    same text.  ``target`` is that of ``tltlc compile``; a language may have several runners.
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
        """Why it cannot be used here, if it cannot."""
        lacking = [tool for tool in self.tools if shutil.which(tool) is None]
        if lacking:
            return f"{self.name}: {', '.join(lacking)} is not installed"
        return None if self.target in backends.targets() else f"{self.name}: there is no target {self.target}"


def runners() -> tuple[Runner, ...]:
    """Those of all modules of ``runners``, by name."""
    from tests.tools.conformance import runners as package

    found: list[Runner] = []
    for module in pkgutil.iter_modules(package.__path__):
        found += importlib.import_module(f"{package.__name__}.{module.name}").RUNNERS
    return tuple(sorted(found, key=lambda runner: runner.name))


def write(runner: Runner, fspa: Fspa, folder: Path) -> None:
    """The monitor of an automaton, as the target writes it, into the folder."""
    for name, content in backends.emit(runner.target, fspa).items():
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)


def execute(command: Sequence[str], folder: Path) -> None:
    """Run a command that builds something."""
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_BUILD_S)
    output = (done.stdout + done.stderr).decode(errors="replace")
    assert done.returncode == 0, f"{' '.join(command)}\n{output}"


def build(runner: Runner, name: str, folder: Path) -> None:
    """Build the program of one monitor, which lies in the folder."""
    if runner.build:
        execute([word.format(name=name) for word in runner.build], folder)


def ran(runner: Runner, name: str, folder: Path, trace: bytes) -> Outcome:
    """What the program of one monitor does with a trace; it has been built."""
    (folder / f"{name}.trace.csv").write_bytes(trace)
    command = [word.format(name=name) for word in (*runner.run, "--full", "{name}.trace.csv")]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_RUN_S)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def built(runner: Runner, fspas: Sequence[Fspa], folder: Path) -> Callable[[Runs], list[Outcome]]:
    """Build one program of many monitors, or many programs where the language has no other way.

    Returns what runs them over traces, in one process where there is one program.
    """
    for fspa in fspas:
        write(runner, fspa, folder)
    names = [fspa.name for fspa in fspas]
    if runner.build_all is None:
        for name in names:
            build(runner, name, folder)
        return lambda runs: [ran(runner, name, folder, trace) for name, trace in runs]
    runner.build_all(folder, names)
    return lambda runs: _ran_together(runner, folder, runs)


def _ran_together(runner: Runner, folder: Path, runs: Runs) -> list[Outcome]:
    command, traces = [*runner.run_all], []
    for number, (name, trace) in enumerate(runs):
        traces.append(f"{number}.csv")
        (folder / traces[-1]).write_bytes(trace)
        command += [name, traces[-1]]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_RUN_S)
    outs, errs = (_pieces(text.decode()) for text in (done.stdout, done.stderr))
    outcomes = []
    for (name, _), trace_name in zip(runs, traces, strict=True):
        err, _, status = errs.get(trace_name, "").rpartition("@@status ")
        whole = re.fullmatch(r"\d+\s*", status) and trace_name in outs
        assert whole, f"{runner.name}, {name}, {trace_name}: the program ended within it: {status[-5000:]}"
        outcomes.append((int(status), outs[trace_name], err))
    assert (done.returncode, [*outs], [*errs]) == (0, traces, traces)
    return outcomes


def _pieces(text: str) -> dict[str, str]:
    """What was printed for each trace."""
    pieces = re.split(r"^@@ (\d+\.csv)\r?\n", text, flags=re.MULTILINE)
    return dict(zip(pieces[1::2], pieces[2::2], strict=True))


def problems(outcome: Outcome, expected: Expected, tolerance: float) -> Iterator[str]:
    """What a program did otherwise than expected, on one trace."""
    error = expected.refusal and expected.refusal.document()
    return differences(*outcome, [COLUMNS, *expected.rows], expected.warnings, error, tolerance)
