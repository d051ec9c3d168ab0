"""Measure how long tltlc, MONA and LTLf2DFA take for every formula of the reference corpus, one after another."""

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
"""After this many failures of LTLf2DFA in a family, the rest of the family is left out."""


def measure(store: Store, timeout_s: float, say: Callable[[str], None]) -> None:
    """Measure each formula without a record in the store; peers are killed after ``timeout_s`` seconds."""
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
        say(f"{reference.name}: {_summary(record)}")


def _ours(reference: Reference) -> Record:
    process_run = run([sys.executable, "-m", "benchmarks.ours"], OUR_TIMEOUT_S, reference.formula, cwd=ROOT)
    lines = [json.loads(line) for line in process_run.output.splitlines()]
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
        record["minimal_failed"] = _failure_reason(process_run.timed_out, OUR_TIMEOUT_S)
    elif not builds and "minimal_ms" in record and "build_failed" not in record:
        record["build_failed"] = _failure_reason(process_run.timed_out, OUR_TIMEOUT_S)
    return record


def _mona(formula: Formula, timeout_s: float) -> Record:
    times: list[float] = []
    states = None
    while len(times) < MONA_RUNS and sum(times) < MONA_ENOUGH_MS:
        process_run, states = mona.solve(formula, timeout_s)
        if states is None:
            return {"mona_failed": _failure_reason(process_run.timed_out, timeout_s)}
        times.append(process_run.cpu_ms)
    return {"mona_ms": median(times), "mona_states": states}


def _failures(store: Store, family: str) -> int:
    family_records = [record for record in store.section(SECTION).values() if record["family"] == family]
    return sum("ltlf2dfa_failed" in record for record in family_records)


def _ltlf2dfa(formula: Formula, timeout_s: float, failures: int) -> Record:
    if failures >= LTLF2DFA_FAILURES:
        return {"ltlf2dfa_failed": "left out"}
    process_run = run([sys.executable, "-m", "benchmarks.ltlf2dfa_peer"], timeout_s, notation(formula), cwd=ROOT)
    lines = process_run.output.splitlines()
    if process_run.status == 0 and lines:
        record: Record = json.loads(lines[-1])
        return record
    return {"ltlf2dfa_failed": _failure_reason(process_run.timed_out, timeout_s)}


def _failure_reason(timed_out: bool, timeout_s: float) -> str:
    return f"over {timeout_s:g} s" if timed_out else "failed"


def _summary(record: Record) -> str:
    parts = [
        f"{tool} {record[f'{tool}_ms']:.2f} ms" if f"{tool}_ms" in record else f"{tool} {record[f'{tool}_failed']}"
        for tool in ("minimal", "guarded", "build", "mona", "ltlf2dfa")
        if f"{tool}_ms" in record or f"{tool}_failed" in record
    ]
    return ", ".join(parts)
