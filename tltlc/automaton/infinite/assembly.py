"""States, edges and pairs as an :class:`~tltlc.automaton.fspa.Fspa` has them, of functions from letters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

from tltlc.automaton.diagrams import IMPOSSIBLE, Diagrams
from tltlc.automaton.finite.build import allowed_letters, breadth_first, distances
from tltlc.automaton.fspa import Edge, Guard, Pair, State, Text, Verdict
from tltlc.automaton.guards import Guards, TooManyPrimes
from tltlc.automaton.infinite.automaton import Rabin
from tltlc.automaton.infinite.letters import LEAF, Letters
from tltlc.core.record import record
from tltlc.io.limits import WORK


class Analysis(Protocol):
    """What is known of states by where they lead, as :class:`~tltlc.automaton.infinite.analysis.Analysis` has it."""

    targets: dict[int, list[int]]
    goals: set[int]

    def verdict(self, state: int) -> Verdict:
        """The verdict of a state."""


@record
class Parts:
    """The fields of an Fspa that depend on the steps; edges are sorted by source, target and marks."""

    states: tuple[State, ...]
    edges: tuple[Edge, ...]
    acceptance: tuple[Pair, ...]
    spec_size: int


def assembled(
    automaton: Rabin,
    analysis: Analysis,
    atoms: Sequence[str],
    exclusive: Sequence[Sequence[int]],
    text: Callable[[int], Text],
    first: Sequence[int] | None = None,
) -> Parts:
    """States in the order of an artefact; ``text`` gives the label of a state by its number in the automaton.

    Of states that may come in any order those come first that do in ``first``, which has all of them.

    Raises :class:`~tltlc.automaton.guards.TooManyPrimes`, :class:`~tltlc.automaton.diagrams.OutOfSteps`.
    """
    distance = distances(analysis.targets, accepting=analysis.goals.__contains__)
    targets = {state: analysis.targets[state] for state in first} if first else analysis.targets
    order = breadth_first(0, targets, distance)
    number = {state: place for place, state in enumerate(order)}
    states = tuple(
        State(number[state], text(state), state in analysis.goals, analysis.verdict(state), distance[state])
        for state in order
    )
    edges, pairs = _edges(automaton, order, number, atoms, exclusive)
    return Parts(states, edges, pairs, max((d for d in distance.values() if d is not None), default=0))


def _edges(
    automaton: Rabin,
    order: Sequence[int],
    number: Mapping[int, int],
    atoms: Sequence[str],
    exclusive: Sequence[Sequence[int]],
) -> tuple[tuple[Edge, ...], tuple[Pair, ...]]:
    """The edges, each with one set of marks, by source, target and marks; and the pairs, by the places of edges."""
    diagrams, leaves = Diagrams(), _Leaves()
    guards = Guards(diagrams, atoms, allowed_letters(diagrams, exclusive))
    made: dict[int, Guard] = {}
    found: list[tuple[int, int, list[Any], Guard]] = []
    for state in order:
        transition = leaves.transition(automaton.letters, automaton.steps[state], diagrams)
        for leaf, guard in guards.by_leaf(transition).items():
            if guard not in made:
                made[guard] = Guard(guards.text(guard), guards.primes(guard))
            target, marks = leaves.values[diagrams.low[leaf]]
            found.append((number[state], number[target], sorted(marks), made[guard]))
            if len(found) > WORK["edges"]:
                raise TooManyPrimes("the automaton", WORK["edges"], "edges")
    found.sort(key=lambda each: each[:3])

    def marked(pair: int, kind: str) -> tuple[int, ...]:
        return tuple(place for place, (_, _, marks, _) in enumerate(found) if (pair, kind) in marks)

    pairs = tuple(Pair(marked(pair, "fin"), marked(pair, "inf")) for pair in range(automaton.pairs))
    return tuple(Edge(source, target, guard) for source, target, _, guard in found), pairs


class _Leaves:
    """Steps as transitions of diagrams, whose leaves count targets and marks from 0 on."""

    def __init__(self) -> None:
        self.values: list[Any] = []
        self._numbers: dict[Any, int] = {}
        self._known: dict[int, int] = {}

    def transition(self, letters: Letters[Any], step: int, diagrams: Diagrams) -> int:
        """A step as a transition."""
        found = self._known.get(step)
        if found is None:
            if letters.atom[step] != LEAF:
                low = self.transition(letters, letters.low[step], diagrams)
                high = self.transition(letters, letters.high[step], diagrams)
                found = diagrams.node(letters.atom[step], low, high)
            elif letters.value[step] is None:
                found = IMPOSSIBLE
            else:
                found = diagrams.leaf(self._number(letters.value[step]), 0)
            self._known[step] = found
        return found

    def _number(self, value: Any) -> int:
        if value not in self._numbers:
            self._numbers[value] = len(self.values)
            self.values.append(value)
        return self._numbers[value]
