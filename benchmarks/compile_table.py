"""The compile table: every formula of the reference corpus with us, MONA and LTLf2DFA, one after the other."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable

from benchmarks import mona
from benchmarks.ltlf2dfa_peer import notation
from benchmarks.machine import facts
from benchmarks.measure import median, run
from benchmarks.reference import Reference, references
from benchmarks.store import ROOT, Record, Store, source_digest
from tests.reference_formulas import read_formula
from tltlc.logic.formula import Formula

SECTION = "compile"
OUR_TIMEOUT_S = 300.0
MONA_RUNS = 5
MONA_ENOUGH_MS = 1000.0
LTLF2DFA_FAILURES = 3
"""Once so many formulas of a family were too much for LTLf2DFA, it is spared the rest of that family."""


def measure(store: Store, timeout_s: float, say: Callable[[str], None]) -> None:
    """Measure each formula that the store does not have yet; peers are killed after ``timeout_s`` seconds."""
    with_mona = mona.available()
    with_ltlf2dfa = with_mona and facts()["ltlf2dfa"] != "not installed"
    for reference in references():
        if reference.name in store.section(SECTION):
            continue
        formula = read_formula(reference.formula)
        record: Record = {"family": reference.family, "states_expected": reference.states}
        record |= _ours(reference)
        if with_mona:
            record |= _mona(formula, timeout_s)
        if with_ltlf2dfa:
            record |= _ltlf2dfa(formula, timeout_s, _failures(store, reference.family))
        record["source"] = source_digest("tltlc/logic", "tltlc/automaton")
        store.put(SECTION, reference.name, record)
        say(f"{reference.name}: {_brief(record)}")


def _ours(reference: Reference) -> Record:
    made = run([sys.executable, "-m", "benchmarks.ours"], OUR_TIMEOUT_S, reference.formula, cwd=ROOT)
    lines = [json.loads(line) for line in made.output.splitlines()]
    record: Record = {}
    for line in lines:
        if "states" not in line:
            record |= line
    builds = [line for line in lines if "states" in line]
    if builds:
        record["states"] = builds[0]["states"]
        record["build_ms"] = median([line["cpu_ms"] for line in builds])
        record["build_mb"] = max(line["peak_mb"] for line in builds)
    if "minimal_ms" not in record and "minimal_failed" not in record:
        record["minimal_failed"] = _why(made.timed_out, OUR_TIMEOUT_S)
    elif not builds and "minimal_ms" in record and "build_failed" not in record:
        record["build_failed"] = _why(made.timed_out, OUR_TIMEOUT_S)
    return record


def _mona(formula: Formula, timeout_s: float) -> Record:
    times: list[float] = []
    states = None
    while len(times) < MONA_RUNS and sum(times) < MONA_ENOUGH_MS:
        made, states = mona.solve(formula, timeout_s)
        if states is None:
            return {"mona_failed": _why(made.timed_out, timeout_s)}
        times.append(made.cpu_ms)
    return {"mona_ms": median(times), "mona_states": states}


def _failures(store: Store, family: str) -> int:
    done = [record for record in store.section(SECTION).values() if record["family"] == family]
    return sum("ltlf2dfa_failed" in record for record in done)


def _ltlf2dfa(formula: Formula, timeout_s: float, failures: int) -> Record:
    if failures >= LTLF2DFA_FAILURES:
        return {"ltlf2dfa_failed": "left out"}
    made = run([sys.executable, "-m", "benchmarks.ltlf2dfa_peer"], timeout_s, notation(formula), cwd=ROOT)
    lines = made.output.splitlines()
    if made.status == 0 and lines:
        record: Record = json.loads(lines[-1])
        return record
    return {"ltlf2dfa_failed": _why(made.timed_out, timeout_s)}


def _why(timed_out: bool, timeout_s: float) -> str:
    return f"over {timeout_s:g} s" if timed_out else "failed"


def _brief(record: Record) -> str:
    parts = [
        f"{side} {record[f'{side}_ms']:.2f} ms" if f"{side}_ms" in record else f"{side} {record[f'{side}_failed']}"
        for side in ("minimal", "guarded", "build", "mona", "ltlf2dfa")
        if f"{side}_ms" in record or f"{side}_failed" in record
    ]
    return ", ".join(parts)
