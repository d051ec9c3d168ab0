"""Convert a Rabin automaton to the states, edges and pairs of an :class:`~tltlc.automaton.fspa.Fspa`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

from tltlc.automaton.diagrams import LEAF, Diagrams
from tltlc.automaton.finite.build import breadth_first, distances
from tltlc.automaton.fspa import Edge, Guard, Pair, State, Text, Verdict
from tltlc.automaton.guards import Guards, TooManyPrimes
from tltlc.automaton.infinite.automaton import Rabin
from tltlc.automaton.transitions import IMPOSSIBLE, TransitionDiagrams
from tltlc.core.record import record
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula


class TargetsAndGoals(Protocol):
    """The part of :class:`~tltlc.automaton.infinite.analysis.Analysis` that :func:`assemble` needs."""

    targets: dict[int, list[int]]
    goals: set[int]

    def verdict(self, state: int) -> Verdict:
        """Return the verdict of the state with this number."""


@record
class AssembledParts:
    """The fields of an Fspa that are computed from a Rabin automaton.

    Edges are sorted by source, target and marks.
    """

    states: tuple[State, ...]
    edges: tuple[Edge, ...]
    acceptance: tuple[Pair, ...]
    spec_size: int


def assemble(
    automaton: Rabin,
    analysis: TargetsAndGoals,
    atoms: Sequence[str],
    exclusive: Sequence[Sequence[int]],
    label: Callable[[int], Formula | Text],
    first: Sequence[int] | None = None,
) -> AssembledParts:
    """Return the states, edges and Rabin pairs of an automaton, with the states numbered breadth-first.

    ``atoms`` are the names of the atoms, ``exclusive`` groups of their indices. ``label`` returns
    the label of a state, given its number in ``automaton``. The successors of a state are numbered
    in order of their distance to a goal. Successors with the same distance are numbered in the
    order of ``first``, a list of all states; by default in the order of their old numbers.

    Raises :class:`~tltlc.automaton.guards.TooManyPrimes` and
    :class:`~tltlc.automaton.diagrams.OutOfSteps`.
    """
    distance = distances(analysis.targets, accepting=analysis.goals.__contains__)
    targets = {state: analysis.targets[state] for state in first} if first else analysis.targets
    order = breadth_first(0, targets, distance)
    number = {state: place for place, state in enumerate(order)}
    states = tuple(
        State(number[state], label(state), state in analysis.goals, analysis.verdict(state), distance[state])
        for state in order
    )
    edges, pairs = _edges(automaton, order, number, atoms, exclusive)
    return AssembledParts(states, edges, pairs, max((d for d in distance.values() if d is not None), default=0))


def _edges(
    automaton: Rabin,
    order: Sequence[int],
    number: Mapping[int, int],
    atoms: Sequence[str],
    exclusive: Sequence[Sequence[int]],
) -> tuple[tuple[Edge, ...], tuple[Pair, ...]]:
    """Return the edges and the Rabin pairs of the Fspa; the edges are sorted by source, target and marks.

    Two edges may have the same source and target if they have different marks.
    """
    diagrams, leaves = TransitionDiagrams(), _Leaves()
    guards = Guards(diagrams, atoms, diagrams.allowed_letters(exclusive))
    guard_of: dict[int, Guard] = {}
    marked_edges: list[tuple[int, int, list[Any], Guard]] = []
    for state in order:
        transition = leaves.transition(automaton.letters, automaton.steps[state], diagrams)
        for leaf, guard in guards.by_leaf(transition).items():
            if guard not in guard_of:
                guard_of[guard] = Guard(guards.formula(guard), guards.primes(guard))
            target, marks = leaves.values[diagrams.value[leaf][0]]
            marked_edges.append((number[state], number[target], sorted(marks), guard_of[guard]))
            if len(marked_edges) > WORK["edges"]:
                raise TooManyPrimes("the automaton", WORK["edges"], "edges")
    marked_edges.sort(key=lambda edge: edge[:3])

    def marked(pair: int, kind: str) -> tuple[int, ...]:
        return tuple(place for place, (_, _, marks, _) in enumerate(marked_edges) if (pair, kind) in marks)

    pairs = tuple(Pair(marked(pair, "fin"), marked(pair, "inf")) for pair in range(automaton.pairs))
    return tuple(Edge(source, target, guard) for source, target, _, guard in marked_edges), pairs


class _Leaves:
    """Converts the steps of a Rabin automaton to transitions in another table of decision diagrams.

    A step is a function from the letter to a target and marks. A leaf of a transition can store
    only ints, so it has an index into ``values``, a list of targets with their marks.
    """

    def __init__(self) -> None:
        self.values: list[Any] = []
        self._numbers: dict[Any, int] = {}
        self._known: dict[int, int] = {}

    def transition(self, letters: Diagrams[Any], step: int, diagrams: TransitionDiagrams) -> int:
        """Convert ``step``, a node of the table ``letters``, to a transition, a node of the table ``diagrams``."""
        node = self._known.get(step)
        if node is None:
            if letters.variable[step] != LEAF:
                low = self.transition(letters, letters.low[step], diagrams)
                high = self.transition(letters, letters.high[step], diagrams)
                node = diagrams.node(letters.variable[step], low, high)
            elif letters.value[step] is None:
                node = IMPOSSIBLE
            else:
                node = diagrams.leaf((self._number(letters.value[step]), 0))
            self._known[step] = node
        return node

    def _number(self, value: Any) -> int:
        if value not in self._numbers:
            self._numbers[value] = len(self.values)
            self.values.append(value)
        return self._numbers[value]
