"""A table of formulas over infinite traces with the sizes of their automata; tests check that no size grows.

``python -m tests.automaton.infinite.reference`` measures the table again, in a minute or two.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import NamedTuple

from tests.reference_formulas import read_formula
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.infinite.analysis import analysis_of_rabin
from tltlc.automaton.infinite.automaton import Rabin
from tltlc.automaton.infinite.construct import rabin
from tltlc.automaton.work import DEFAULT_WORK, Work
from tltlc.logic.formula import Formula

TABLE = Path(__file__).parents[2] / "corpus" / "infinite_sizes.tsv"
_COLUMNS = ("source", "formula", "states", "pairs", "steps")
_PLENTY = 10**9


class Entry(NamedTuple):
    """A formula, its source (``owl`` or ``families``), and the size of its automaton.

    ``states`` leaves out the trap; ``steps`` is the work of the construction.
    """

    source: str
    formula: Formula
    states: int
    pairs: int
    steps: int


def entries() -> list[Entry]:
    """Return the rows of the table, in file order."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        return [
            Entry(row["source"], read_formula(row["formula"]), *(int(row[name]) for name in _COLUMNS[2:]))
            for row in csv.DictReader(file, delimiter="\t")
        ]


def automaton_of(formula: Formula) -> Rabin:
    """Return the automaton of a formula of the table."""
    with recursion_room():
        return rabin(formula)


def states(automaton: Rabin) -> int:
    """Return the number of states without the trap, at least one."""
    analysis = analysis_of_rabin(automaton, Work(_PLENTY))
    states_ = range(len(automaton.steps))
    return max(1, sum(analysis.verdict(state) != "violated" for state in states_))


def _measure() -> None:
    old = entries()
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, delimiter="\t", lineterminator="\n")
        table.writerow(_COLUMNS)
        for entry in old:
            automaton = automaton_of(entry.formula)
            steps = DEFAULT_WORK - automaton.letters.work.left
            table.writerow([entry.source, entry.formula, states(automaton), automaton.pairs, steps])


if __name__ == "__main__":
    _measure()
