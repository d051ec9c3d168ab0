"""MONA 1.4 as a peer: a formula as a program of monadic second-order logic over strings, its time and its size.

A position of the string is a sample, an atom is the set of positions at which it holds, a temporal
operator is a first-order quantifier over the positions that follow.  MONA's automaton is minimal.
It has one initial state more than ours, as it first reads a letter that stands before the string.
A string here is never empty.
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
    """MONA's run on a formula, and the size of its automaton as we count; None where it gave up."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "formula.mona"
        file.write_text(program(formula), encoding="ascii")
        made = run([*COMMAND, str(file)], timeout_s)
    # One that was stopped may have printed a part of its automaton.
    return made, None if made.status else size(made.output)


def size(output: str) -> int | None:
    """The states of the automaton that MONA printed, counted as ours: whether the empty trace is accepted is free.

    MONA rejects it.  Where its state before the first sample differs from another one in acceptance only, ours is
    one smaller.  Its own initial state stands before that one.
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
    """The MONA program whose models are the traces that satisfy the formula at their first sample."""
    names = {atom: f"A{number}" for number, atom in enumerate(formula.atoms())}
    declaration = f"var2 {', '.join(names.values())};\n" if names else ""
    return f"m2l-str;\n{declaration}ex1 o: o = 0 & {_at(formula, 'o', names, count(1))};\n"


def _at(formula: Formula, here: str, names: dict[str, str], numbers: count[int]) -> str:
    """The formula at position ``here``; ``numbers`` makes the names of new position variables."""
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
