"""Brute-force reference for automata, over all letters: slow, simple, independent of the diagrams."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

from tltlc.automaton.fspa import Edge, Fspa

Letter = tuple[bool, ...]


def letters(fspa: Fspa) -> list[Letter]:
    """Return every truth assignment of the atoms that the ``exclusive`` declarations allow."""
    return [
        letter
        for letter in product((False, True), repeat=len(fspa.atoms))
        if all(sum(letter[atom] for atom in group) <= 1 for group in fspa.exclusive)
    ]


def holds(edge: Edge, letter: Letter) -> bool:
    """Whether a letter satisfies the guard of an edge, by its prime implicants."""
    return any(all(letter[atom] == polarity for atom, polarity in prime) for prime in edge.guard.primes)


def step(fspa: Fspa, state: int, letter: Letter) -> int:
    """Return the successor of a state; asserts that exactly one guard is true."""
    taken = [edge.target for edge in fspa.edges_from(state) if holds(edge, letter)]
    assert len(taken) == 1, (state, letter, taken)
    return taken[0]


def table(fspa: Fspa) -> dict[int, dict[Letter, int]]:
    """Return the transition function as a table."""
    return {state.id: {letter: step(fspa, state.id, letter) for letter in letters(fspa)} for state in fspa.states}


def run(fspa: Fspa, trace: Sequence[Letter], state: int = 0) -> int:
    """Return the state after a trace."""
    for letter in trace:
        state = step(fspa, state, letter)
    return state


def traces(fspa: Fspa, longest: int) -> Iterator[tuple[Letter, ...]]:
    """Yield every non-empty trace of up to ``longest`` letters."""
    for length in range(1, longest + 1):
        yield from product(letters(fspa), repeat=length)


def named(fspa: Fspa, trace: Sequence[Letter]) -> list[frozenset[str]]:
    """Return the trace in the form of the oracle: the names of the true atoms of each sample."""
    return [frozenset(atom.name for atom, value in zip(fspa.atoms, letter, strict=True) if value) for letter in trace]


def minimal_size(fspa: Fspa, accepting: set[int]) -> int:
    """Return the size of the minimal complete automaton with these accepting states, by Moore's algorithm."""
    moves = table(fspa)
    block = {state: int(state in accepting) for state in moves}
    while True:
        signature = {state: (block[state], *(block[target] for target in row.values())) for state, row in moves.items()}
        numbers = {key: number for number, key in enumerate(dict.fromkeys(signature.values()))}
        refined = {state: numbers[key] for state, key in signature.items()}
        if len(numbers) == len(set(block.values())):
            reached, queue = {0}, [0]
            for state in queue:
                for target in moves[state].values():
                    if target not in reached:
                        reached.add(target)
                        queue.append(target)
            return len({block[state] for state in reached})
        block = refined
