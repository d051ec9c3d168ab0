"""Run LTLf2DFA 2.0.0 on a formula from standard input, and print a JSON object.

The time is that of ``to_dfa`` on a parsed formula, including the MONA process that it starts.
LTLf2DFA passes a file in its own folder to MONA, so a lock prevents two runs at once. Without MONA,
its answers are wrong, so :mod:`benchmarks.compile_table` leaves it out.
"""

from __future__ import annotations

import fcntl
import json
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

from benchmarks.measure import median, run_in_fork
from tltlc.logic.formula import Formula

RUNS = 3
ENOUGH_MS = 3000.0

_UNARY = {"not": "!", "X": "X", "N": "WX", "F": "F", "G": "G"}
_BINARY = {"implies": "->", "iff": "<->", "U": "U", "R": "R"}


def notation(formula: Formula) -> str:
    """Return the formula in LTLf2DFA's notation, with all brackets, and atoms renamed ``p0``, ``p1``, … in order."""
    names = {atom: f"p{number}" for number, atom in enumerate(formula.atoms())}

    def text(node: Formula) -> str:
        if node.op in ("true", "false"):
            return node.op
        if node.op == "atom":
            return names[node.name]
        if node.op in _UNARY:
            return f"{_UNARY[node.op]}({text(node.args[0])})"
        sign = {"and": "&", "or": "|"}.get(node.op) or _BINARY[node.op]
        return "(" + f" {sign} ".join(text(argument) for argument in node.args) + ")"

    return text(formula)


def main() -> None:
    """Read a formula in LTLf2DFA's notation; print the time in milliseconds and the size of the automaton."""
    from ltlf2dfa.ltlf2dfa import to_dfa  # type: ignore[import-untyped,import-not-found,unused-ignore]
    from ltlf2dfa.parser.ltlf import LTLfParser  # type: ignore[import-untyped,import-not-found,unused-ignore]

    formula = LTLfParser()(sys.stdin.read())

    def solve() -> dict[str, Any]:
        dot = to_dfa(formula)
        return {"states": len({end for edge in re.findall(r"(\d+) -> (\d+) \[", dot) for end in edge})}

    runs: list[dict[str, Any]] = []
    with (Path(tempfile.gettempdir()) / "ltlf2dfa-benchmark.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        while len(runs) < RUNS and sum(result["cpu_ms"] for result in runs) < ENOUGH_MS:
            # Run each in a fork, as ours: sympy keeps tables that would make a second run cheaper than the first.
            result = run_in_fork(solve)
            if result is None:
                raise SystemExit(1)
            runs.append(result)
    result = {"ltlf2dfa_ms": median([result["cpu_ms"] for result in runs])}
    print(json.dumps(result | {"ltlf2dfa_states": runs[0]["states"]}))


if __name__ == "__main__":
    main()
