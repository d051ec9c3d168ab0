"""List the shipped levels in their variants, and measure each in a process of its own."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterable, Sequence
from importlib.util import find_spec

from benchmarks.measure import run
from benchmarks.store import ROOT, Record, Store, measure_missing


def variants_of_all() -> list[tuple[str, str]]:
    """Return each shipped level with each of its variants."""
    from tltl_runtime.stealth.levels.file import level_names, variants

    return [(level, variant) for level in level_names() for variant in variants(level)]


def measure_each(
    store: Store,
    section: str,
    cases: Callable[[], Iterable[Sequence[str]]],
    timeout_s: float,
    say: Callable[[str], None],
) -> None:
    """Run ``python -m benchmarks.SECTION CASE…`` for each case without a ``source`` in the store.

    The process prints the record of the case as JSON. Without pybullet, nothing is measured.
    """
    if find_spec("pybullet") is None:
        say(f"{section} left out: pybullet is not installed (the extra `game`, Python 3.10 or 3.11)")
        return

    def measure(name: str) -> Record:
        process_run = run([sys.executable, "-m", f"benchmarks.{section}", *name.split()], timeout_s, cwd=ROOT)
        record: Record = (
            json.loads(process_run.output)
            if process_run.status == 0
            else {"failed": f"exit status {process_run.status}"}
        )
        return record

    measure_missing(store, section, map(" ".join, cases()), measure, say, field="source")
