"""Measure whole processes: commands of ``tltlc`` and a bare ``python -c pass`` in turns, and the time of imports."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from benchmarks.measure import Run, median, quartiles, run
from benchmarks.specs import source
from benchmarks.store import ROOT, Record, Store, source_digest

SECTION = "process"
ROUNDS = 25
TIMEOUT_S = 60.0
BARE = (sys.executable, "-c", "pass")
TLTLC = (sys.executable, "-m", "tltlc")
SLOWEST_IMPORTS = 12


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure each command without a record in the store, or with a failed one."""
    with tempfile.TemporaryDirectory() as folder:
        for key, arguments in _commands(Path(folder)).items():
            if "cpu_ratio" not in store.section(SECTION).get(key, {}):
                record = _compare_with_bare(arguments, with_bytecode(Path(folder)))
                store.put(SECTION, key, record)
                ratio = f"{record['cpu_ratio'][1]:.1f} times a bare interpreter" if "cpu_ratio" in record else "failed"
                say(f"{key}: {ratio}")


def with_bytecode(folder: Path) -> dict[str, str]:
    """Return the environment of this process, but let Python store compiled modules, as for an installed package."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return environment | {"PYTHONPYCACHEPREFIX": str(folder / "bytecode")}


def _commands(folder: Path) -> dict[str, Sequence[str]]:
    """Return the arguments of each command, by the command line that the report shows."""
    spec = str(source("cover_and_hide"))
    file_name = "cover_and_hide.tltl"
    return {
        f"tltlc compile {file_name}": ("compile", spec, "-o", str(folder)),
        f"tltlc compile {file_name} -t json": ("compile", spec, "-o", str(folder), "-t", "json"),
        f"tltlc check {file_name}": ("check", spec),
        "tltlc --help": ("--help",),
    }


def _compare_with_bare(arguments: Sequence[str], environment: dict[str, str]) -> Record:
    """Compare a command with a bare interpreter in ``ROUNDS`` pairs of runs; return medians and ratios.

    The order of the two runs alternates from pair to pair.
    """

    def run_once(line: Sequence[str]) -> Run:
        return run(line, TIMEOUT_S, cwd=ROOT, environment=environment)

    command = [*TLTLC, *arguments]
    # The first runs compile modules and warm the file system's cache; they do not count.
    first = run_once(command)
    if first.status != 0:
        return {"failed": f"exit status {first.status}"}
    run_once(BARE)
    pairs: list[tuple[Run, Run]] = []
    for number in range(ROUNDS):
        if number % 2:
            ours = run_once(command)
            pairs.append((ours, run_once(BARE)))
        else:
            bare = run_once(BARE)
            pairs.append((run_once(command), bare))
    return {
        "rounds": ROUNDS,
        "cpu_ms": median([ours.cpu_ms for ours, _ in pairs]),
        "wall_ms": median([ours.wall_ms for ours, _ in pairs]),
        "bare_cpu_ms": median([bare.cpu_ms for _, bare in pairs]),
        "bare_wall_ms": median([bare.wall_ms for _, bare in pairs]),
        "cpu_ratio": quartiles([ours.cpu_ms / bare.cpu_ms for ours, bare in pairs]),
        "wall_ratio": quartiles([ours.wall_ms / bare.wall_ms for ours, bare in pairs]),
        "imports": _imports(command, environment),
        "source": source_digest("tltlc"),
    }


def _imports(command: Sequence[str], environment: dict[str, str]) -> list[list[object]]:
    """Return the slowest imports by Python's ``-X importtime``: the module, and its own milliseconds."""
    completed = subprocess.run(
        [command[0], "-X", "importtime", *command[1:]],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=environment,
        check=False,
    )
    own_times = re.findall(r"^import time:\s*(\d+) \|\s*\d+ \|\s*(\S+)$", completed.stderr, flags=re.MULTILINE)
    slowest = sorted(((int(us) / 1e3, module) for us, module in own_times), reverse=True)[:SLOWEST_IMPORTS]
    return [[module, ms] for ms, module in slowest]
