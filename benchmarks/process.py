"""The whole process: commands of ``tltlc`` beside a bare ``python -c pass``, in turns, and what their imports cost."""

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
    """Measure each command that the store does not have yet, or that failed."""
    with tempfile.TemporaryDirectory() as folder:
        for key, arguments in _commands(Path(folder)).items():
            if "cpu_ratio" not in store.section(SECTION).get(key, {}):
                record = _compared(arguments, with_bytecode(Path(folder)))
                store.put(SECTION, key, record)
                ratio = f"{record['cpu_ratio'][1]:.1f} times a bare interpreter" if "cpu_ratio" in record else "failed"
                say(f"{key}: {ratio}")


def with_bytecode(folder: Path) -> dict[str, str]:
    """The variables of this process, but with compiled modules kept, as they are of an installed package."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return environment | {"PYTHONPYCACHEPREFIX": str(folder / "bytecode")}


def _commands(folder: Path) -> dict[str, Sequence[str]]:
    """The arguments of ``tltlc`` by the command as a reader would type it."""
    spec = str(source("cover_and_hide"))
    shown = "cover_and_hide.tltl"
    return {
        f"tltlc compile {shown}": ("compile", spec, "-o", str(folder)),
        f"tltlc compile {shown} -t json": ("compile", spec, "-o", str(folder), "-t", "json"),
        f"tltlc check {shown}": ("check", spec),
        "tltlc --help": ("--help",),
    }


def _compared(arguments: Sequence[str], environment: dict[str, str]) -> Record:
    """Medians of ``ROUNDS`` pairs of runs, each of the two first in turn; ratios are taken pair by pair."""

    def once(line: Sequence[str]) -> Run:
        return run(line, TIMEOUT_S, cwd=ROOT, environment=environment)

    command = [*TLTLC, *arguments]
    # The first runs compile modules and warm the file system's cache; they do not count.
    first = once(command)
    if first.status != 0:
        return {"failed": f"exit status {first.status}"}
    once(BARE)
    pairs: list[tuple[Run, Run]] = []
    for number in range(ROUNDS):
        if number % 2:
            ours = once(command)
            pairs.append((ours, once(BARE)))
        else:
            bare = once(BARE)
            pairs.append((once(command), bare))
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
    """The slowest imports, as Python's ``-X importtime`` sees them: module and milliseconds of its own."""
    made = subprocess.run(
        [command[0], "-X", "importtime", *command[1:]],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=environment,
        check=False,
    )
    own = re.findall(r"^import time:\s*(\d+) \|\s*\d+ \|\s*(\S+)$", made.stderr, flags=re.MULTILINE)
    slowest = sorted(((int(us) / 1e3, module) for us, module in own), reverse=True)[:SLOWEST_IMPORTS]
    return [[module, ms] for ms, module in slowest]
