"""Run MONA 1.4 on a formula, as a program of monadic second-order logic over strings.

A position of the string is a sample, an atom is the set of positions at which it holds, and a
temporal operator is a first-order quantifier over the positions that follow. Strings are not empty.
MONA's automaton is minimal. It has one more initial state than ours, because it first reads a letter
before the string.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from itertools import count
from pathlib import Path

from benchmarks.measure import Run, run
from tltlc.logic.formula import Formula

COMMAND = ("mona", "-q", "-u", "-w")


def available() -> bool:
    """Whether MONA is installed."""
    return shutil.which("mona") is not None


def solve(formula: Formula, timeout_s: float) -> tuple[Run, int | None]:
    """Run MONA on a formula; return the run and the :func:`size` of the automaton, None if there is no automaton."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "formula.mona"
        file.write_text(program(formula), encoding="ascii")
        process_run = run([*COMMAND, str(file)], timeout_s)
    # A run that was stopped may have printed a part of its automaton.
    return process_run, None if process_run.status else size(process_run.output)


def size(output: str) -> int | None:
    """Return the number of states of the automaton that MONA printed, counted as ours; None if it printed none.

    MONA's own initial state is not counted. MONA also rejects the empty trace, while our automata do
    not judge it. So if the state before the first sample differs from another state only in
    acceptance, our automaton has one state fewer.
    """
    if "Formula is unsatisfiable" in output:
        return 1  # it prints no automaton then
    total = re.search(r"Automaton has (\d+) states?", output)
    accepting = re.search(r"^Accepting states:(.*)$", output, flags=re.MULTILINE)
    if not total or not accepting:
        return None
    edges: dict[str, set[tuple[str, str]]] = {}
    for source, letters, target in re.findall(r"^State (\d+): ?(\S*) ?-> state (\d+)$", output, flags=re.MULTILINE):
        edges.setdefault(source, set()).add((letters, target))
    ((_, first),) = edges["0"]
    reached_again = any(target == first for state in edges if state != "0" for _, target in edges[state])
    shared = not reached_again and any(edges[state] == edges[first] for state in accepting.group(1).split())
    return int(total.group(1)) - (2 if shared else 1)


def program(formula: Formula) -> str:
    """Return the MONA program whose models are the traces that satisfy the formula at their first sample."""
    names = {atom: f"A{number}" for number, atom in enumerate(formula.atoms())}
    declaration = f"var2 {', '.join(names.values())};\n" if names else ""
    return f"m2l-str;\n{declaration}ex1 o: o = 0 & {_at(formula, 'o', names, count(1))};\n"


def _at(formula: Formula, here: str, names: dict[str, str], numbers: count[int]) -> str:
    """Return the formula at position ``here``; ``numbers`` numbers new position variables.

    Raises ValueError for operators that the corpus does not have.
    """
    op, args = formula.op, formula.args

    def at(argument: Formula, position: str) -> str:
        return _at(argument, position, names, numbers)

    if op in ("true", "false"):
        return op
    if op == "atom":
        return f"{here} in {names[formula.name]}"
    if op == "not":
        return f"~({at(args[0], here)})"
    if op in ("and", "or"):
        return "(" + (" & " if op == "and" else " | ").join(at(argument, here) for argument in args) + ")"
    if op in ("implies", "iff"):
        return f"({at(args[0], here)} {'=>' if op == 'implies' else '<=>'} {at(args[1], here)})"
    there = f"t{next(numbers)}"
    if op == "X":
        return f"({here} < max($) & (ex1 {there}: {there} = {here} + 1 & {at(args[0], there)}))"
    if op == "N":
        return f"({here} = max($) | (ex1 {there}: {there} = {here} + 1 & {at(args[0], there)}))"
    if op == "F":
        return f"(ex1 {there}: {here} <= {there} & {at(args[0], there)})"
    if op == "G":
        return f"(all1 {there}: {here} <= {there} => {at(args[0], there)})"
    between = f"t{next(numbers)}"
    span = f"{here} <= {between} & {between} < {there}"
    if op == "U":
        before = f"(all1 {between}: {span} => {at(args[0], between)})"
        return f"(ex1 {there}: {here} <= {there} & {at(args[1], there)} & {before})"
    if op == "R":
        before = f"(ex1 {between}: {span} & {at(args[0], between)})"
        return f"(all1 {there}: {here} <= {there} => ({at(args[1], there)} | {before}))"
    # `p W q` is `q R (p | q)`, `p M q` is `q U (p & q)`.
    raise ValueError(f"the corpus has no operator {op}")
