"""Measure how long tltlc takes for a formula from standard input, and print the results.

``python -m benchmarks.ours`` prints each result at once, as a JSON object on a line, so that a
process that is killed loses only the missing results. The results are the time from the formula to
the minimal automaton, the times of complete builds, and the time to the minimal automaton with its
guards as text.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from typing import Any

from benchmarks.measure import cpu_s, cpu_times_ms, median, peak_memory_mb, run_in_fork
from tests.reference_formulas import read_formula
from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET, build, minimal_machine, spec_from_formula
from tltlc.automaton.finite.machine import OutOfStates
from tltlc.automaton.guards import Guards, TooManyPrimes
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.logic.formula import Formula

RUNS = 15
ENOUGH_S = 1.5
BUILDS = 3
ENOUGH_BUILDS_S = 10.0


def main() -> None:
    """Print ``minimal_ms``; for each build ``cpu_ms``, ``peak_mb`` and ``states``; and ``guarded_ms``."""
    formula = read_formula(sys.stdin.read())
    atoms = formula.atoms()
    try:
        with recursion_room():
            times = cpu_times_ms(
                lambda: minimal_machine(formula, atoms, DEFAULT_STATE_BUDGET), runs=RUNS, enough_s=ENOUGH_S
            )
    except (OutOfStates, OutOfSteps):
        _print_result({"minimal_failed": "TLT0501"})
        return
    _print_result({"minimal_ms": median(times), "minimal_mb": peak_memory_mb()})
    build(spec_from_formula(read_formula("a")))  # loads the modules that a build needs
    start = cpu_s()
    for _ in range(BUILDS):
        if cpu_s() - start > ENOUGH_BUILDS_S:
            break
        # Build in a fork: the tables that a first build fills would make the second one cheaper.
        _print_result(run_in_fork(lambda: _build(formula)) or {"build_failed": "failed"})
    try:
        with recursion_room():
            guard_times = cpu_times_ms(lambda: _guard_texts(formula, atoms), runs=RUNS, enough_s=ENOUGH_S)
    except TooManyPrimes:
        _print_result({"guarded_failed": "TLT0502"})
    else:
        _print_result({"guarded_ms": median(guard_times)})


def _guard_texts(formula: Formula, atoms: Sequence[str]) -> list[str]:
    """Return the guard of each edge of the minimal automaton as a short text, which is what LTLf2DFA gives."""
    successors, machine, allowed = minimal_machine(formula, atoms, DEFAULT_STATE_BUDGET)
    guards = Guards(successors.diagrams, atoms, allowed)
    edges = {guard for transition in machine.transitions.values() for guard in guards.by_leaf(transition).values()}
    return [str(guards.formula(guard)) for guard in edges]


def _build(formula: Formula) -> dict[str, Any]:
    try:
        fspa = build(spec_from_formula(formula))
    except TltlError as error:
        return {"build_failed": error.diagnostics[0].code}
    return {"states": len(fspa.states)}


def _print_result(result: dict[str, Any]) -> None:
    print(json.dumps(result), flush=True)


if __name__ == "__main__":
    main()
