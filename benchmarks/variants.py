"""The shipped levels in their variants, and how each is measured in a process of its own."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterable, Sequence
from importlib.util import find_spec

from benchmarks.measure import run
from benchmarks.store import ROOT, Record, Store, measure_missing


def variants_of_all() -> list[tuple[str, str]]:
    """Each shipped level in each of its variants."""
    from tltl_runtime.stealth.levels.file import level_names, variants

    return [(level, variant) for level in level_names() for variant in variants(level)]


def measure_each(
    store: Store,
    section: str,
    cases: Callable[[], Iterable[Sequence[str]]],
    timeout_s: float,
    say: Callable[[str], None],
) -> None:
    """Run ``python -m benchmarks.SECTION CASE…`` for each case that has no ``source`` in the store yet.

    It prints the record of the case as JSON.  Where the game is not installed, it says so.
    """
    if find_spec("pybullet") is None:
        say(f"{section} left out: pybullet is not installed (the extra `game`, Python 3.10 or 3.11)")
        return

    def measured(name: str) -> Record:
        made = run([sys.executable, "-m", f"benchmarks.{section}", *name.split()], timeout_s, cwd=ROOT)
        record: Record = json.loads(made.output) if made.status == 0 else {"failed": f"exit status {made.status}"}
        return record

    measure_missing(store, section, map(" ".join, cases()), measured, say, done="source")
