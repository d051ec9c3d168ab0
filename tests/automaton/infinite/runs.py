"""Runs of automata over infinite traces, on traces that end in a cycle, directly from the definition."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

from tests.automaton.letters import Letter, holds, letters
from tests.reference_formulas import read_formula
from tltlc.automaton.finite.build import spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.build import build_infinite
from tltlc.core.record import replace
from tltlc.logic.formula import Formula


def compiled(formula: Formula | str, *exclusive: tuple[str, ...]) -> Fspa:
    """Compile a formula to its automaton over infinite traces; ``exclusive`` are groups of its atoms."""
    if isinstance(formula, str):
        formula = read_formula(formula)
    return build_infinite(replace(spec_from_formula(formula, exclusive=exclusive), semantics="infinite"))


def accepts(fspa: Fspa, prefix: Sequence[Letter], cycle: Sequence[Letter], state: int = 0) -> bool:
    """Whether the automaton accepts, from ``state``, ``prefix`` followed by ``cycle`` forever.

    Asserts that exactly one guard is true at each step.
    """
    for letter in prefix:
        state = fspa.edges[_edge(fspa, state, letter)].target
    first_rounds: dict[int, int] = {}
    rounds: list[set[int]] = []
    while state not in first_rounds:
        first_rounds[state] = len(rounds)
        taken = []
        for letter in cycle:
            taken.append(_edge(fspa, state, letter))
            state = fspa.edges[taken[-1]].target
        rounds.append(set(taken))
    recurring = set().union(*rounds[first_rounds[state] :])
    return any(not recurring & set(pair.fin) and recurring & set(pair.inf) for pair in fspa.acceptance)


def lassos(fspa: Fspa, longest: int) -> list[tuple[tuple[Letter, ...], tuple[Letter, ...]]]:
    """Return every lasso whose prefix and cycle together have at most ``longest`` letters."""
    possible = letters(fspa)
    return [
        (prefix, cycle)
        for before in range(longest)
        for after in range(1, longest - before + 1)
        for prefix in product(possible, repeat=before)
        for cycle in product(possible, repeat=after)
    ]


def _edge(fspa: Fspa, state: int, letter: Letter) -> int:
    (taken,) = (index for index, edge in enumerate(fspa.edges) if edge.source == state and holds(edge, letter))
    return taken
