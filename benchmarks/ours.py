"""Our side of the compile table, in a process of its own: formula on standard input, results on standard output.

``python -m benchmarks.ours`` prints one JSON object per line as soon as it is known: first the time from formula to
minimal automaton, then those of complete builds, then the time with its guards as text, so that a kill loses only
what is missing.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from typing import Any

from benchmarks.measure import cpu_s, cpu_times_ms, forked, median, peak_memory_mb
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
    """Print ``minimal_ms``, for each build ``cpu_ms``, ``peak_mb``, ``states``, and ``guarded_ms``."""
    formula = read_formula(sys.stdin.read())
    atoms = formula.atoms()
    try:
        with recursion_room():
            times = cpu_times_ms(
                lambda: minimal_machine(formula, atoms, DEFAULT_STATE_BUDGET), runs=RUNS, enough_s=ENOUGH_S
            )
    except (OutOfStates, OutOfSteps):
        _say({"minimal_failed": "TLT0501"})
        return
    _say({"minimal_ms": median(times), "minimal_mb": peak_memory_mb()})
    build(spec_from_formula(read_formula("a")))  # loads the modules that a build needs
    started = cpu_s()
    for _ in range(BUILDS):
        if cpu_s() - started > ENOUGH_BUILDS_S:
            break
        # The tables of rewriting that a first build fills would make a second one in the same process cheaper.
        _say(forked(lambda: _build(formula)) or {"build_failed": "failed"})
    try:
        with recursion_room():
            guarded = cpu_times_ms(lambda: _guarded(formula, atoms), runs=RUNS, enough_s=ENOUGH_S)
    except TooManyPrimes:
        _say({"guarded_failed": "TLT0502"})
    else:
        _say({"guarded_ms": median(guarded)})


def _guarded(formula: Formula, atoms: Sequence[str]) -> list[str]:
    """What LTLf2DFA gives: the minimal automaton with each edge's guard as a short text."""
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


def _say(result: dict[str, Any]) -> None:
    print(json.dumps(result), flush=True)


if __name__ == "__main__":
    main()
