"""Find which clauses of a spec each edge into a trap breaks."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from typing import Any, Final

from tltlc.automaton.diagrams import LEAF, Diagrams, OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.finite.build import distances, minimal_machine
from tltlc.automaton.finite.machine import OutOfStates
from tltlc.automaton.fspa import BrokenClause, Edge, Fspa, Implicant
from tltlc.automaton.guards import Guards, TooManyPrimes
from tltlc.automaton.transitions import ACCEPT, IMPOSSIBLE, REJECT, TransitionDiagrams
from tltlc.automaton.work import STEPS_PER_STATE, OutOfWork, Work
from tltlc.core.record import record, replace
from tltlc.resolve.spec import Spec

_LEAST_STEPS: Final = 50_000
_STEPS_PER_EDGE: Final = 10
"""The search for the states of the clauses may take this many steps for each edge, and at least ``_LEAST_STEPS``."""
_LEAST_STATES: Final = 200
_STATES_PER_STATE: Final = 4
"""A clause may have this many states for each state of the spec, and at least ``_LEAST_STATES``.

Clauses alone can be much larger than the spec, as where another clause rules most of their traces out.
"""

_Place = tuple[int, ...]
"""A state of each clause's automaton."""


def with_broken_clauses(fspa: Fspa, spec: Spec, state_budget: int) -> Fspa:
    """Return the automaton of ``spec`` with the texts of its clauses, and with the clauses that its edges break.

    For this, each clause gets an automaton; a clause that needs more than ``state_budget`` states, or many
    more than the spec, is never named. Several traces may lead to the same state although a clause has come
    further in some of them than in others. Then an edge breaks the clause only under the conditions that
    break it after each of these traces. If finding all of them takes too many steps, no clause is named.
    """
    clauses = tuple(part.text for part in spec.parts)
    broken: dict[int, tuple[BrokenClause, ...]]
    if len(clauses) == 1:
        broken = {index: (BrokenClause(0, edge.guard.primes),) for index, edge in _breaking_edges(fspa)}
    else:
        with recursion_room():
            most_states = max(_LEAST_STATES, _STATES_PER_STATE * len(fspa.states))
            broken = _Search(fspa, spec, min(state_budget, most_states)).broken_clauses()
    edges = tuple(
        replace(edge, broken=broken[index]) if index in broken else edge for index, edge in enumerate(fspa.edges)
    )
    return replace(fspa, clauses=clauses, edges=edges)


def _breaking_edges(fspa: Fspa) -> Iterator[tuple[int, Edge]]:
    """Yield the edges that lead into a trap from another state, each with its index."""
    violated = [state.verdict == "violated" for state in fspa.states]
    for index, edge in enumerate(fspa.edges):
        if violated[edge.target] and not violated[edge.source]:
            yield index, edge


@record
class _ClauseAutomaton:
    """An automaton of the clause with the index ``clause``.

    ``transitions`` maps each state to a node of ``diagrams``. ``target`` maps the value of a leaf to the
    next state, or to None for letters that cannot occur. ``is_broken`` says of a leaf whether no
    continuation meets the clause after it.
    """

    clause: int
    initial: int
    transitions: Mapping[int, int]
    diagrams: Diagrams[Any]
    target: Callable[[Any], int | None]
    is_broken: Callable[[int], bool]


def _finite(clause: int, spec: Spec, state_budget: int, diagrams: TransitionDiagrams) -> _ClauseAutomaton:
    names = [atom.name for atom in spec.atoms]
    _, machine, _ = minimal_machine(spec.parts[clause].formula, names, state_budget, spec.exclusive, diagrams)
    value, accepted = diagrams.value, -1
    # Each letter that a trace may end with leads to the state `accepted`, too.
    targets = {
        state: [
            target
            for leaf in diagrams.leaves(transition)
            if leaf != IMPOSSIBLE
            for target in ((value[leaf][0], accepted) if value[leaf][1] else (value[leaf][0],))
        ]
        for state, transition in machine.transitions.items()
    }
    distance = distances({**targets, accepted: []}, lambda state: state == accepted)

    def target(leaf: tuple[int, int]) -> int | None:
        return None if leaf == value[IMPOSSIBLE] else leaf[0]

    def is_broken(leaf: int) -> bool:
        return leaf != IMPOSSIBLE and not value[leaf][1] and distance[value[leaf][0]] is None

    return _ClauseAutomaton(clause, machine.initial, machine.transitions, diagrams, target, is_broken)


def _infinite(clause: int, spec: Spec, state_budget: int) -> _ClauseAutomaton:
    from tltlc.automaton.infinite.analysis import analysis_of_rabin
    from tltlc.automaton.infinite.construct import rabin

    work, formula = STEPS_PER_STATE * state_budget, spec.parts[clause].formula
    automaton = rabin(formula, [atom.name for atom in spec.atoms], spec.exclusive, work)
    analysis = analysis_of_rabin(automaton, Work(work))
    value = automaton.letters.value

    def is_broken(leaf: int) -> bool:
        return value[leaf] is not None and analysis.verdict(value[leaf][0]) == "violated"

    def target(leaf: Any) -> int | None:
        return None if leaf is None else leaf[0]

    return _ClauseAutomaton(clause, 0, dict(enumerate(automaton.steps)), automaton.letters, target, is_broken)


class _Search:
    """Runs the automata of the clauses beside the automaton of the spec."""

    def __init__(self, fspa: Fspa, spec: Spec, state_budget: int) -> None:
        self._fspa, self._diagrams = fspa, TransitionDiagrams()
        self._steps_left = max(_LEAST_STEPS, _STEPS_PER_EDGE * len(fspa.edges))
        names = [atom.name for atom in spec.atoms]
        self._guards = Guards(self._diagrams, names, self._diagrams.allowed_letters(spec.exclusive))
        self._automata: list[_ClauseAutomaton] = []
        for clause in range(len(spec.parts)):
            try:
                if spec.semantics == "infinite":
                    self._automata.append(_infinite(clause, spec, state_budget))
                else:
                    self._automata.append(_finite(clause, spec, state_budget, self._diagrams))
            except (OutOfStates, OutOfSteps, OutOfWork, TooManyPrimes, RecursionError):
                continue
        self._conditions: dict[tuple[int, int], int] = {}

    def broken_clauses(self) -> dict[int, tuple[BrokenClause, ...]]:
        """Return what the edges into traps break, by the index of the edge; nothing if the search is too long."""
        places = self._places()
        if places is None:
            return {}
        return {index: self._broken(edge, places[edge.source]) for index, edge in _breaking_edges(self._fspa)}

    def _broken(self, edge: Edge, places: Sequence[_Place]) -> tuple[BrokenClause, ...]:
        broken: list[BrokenClause] = []
        for number, automaton in enumerate(self._automata):
            condition = ACCEPT
            for state in dict.fromkeys(place[number] for place in places):
                condition = self._diagrams.conjoin(condition, self._condition(number, state))
            if condition != REJECT:
                try:
                    broken.append(BrokenClause(automaton.clause, self._guards.primes(condition)))
                except TooManyPrimes:
                    continue
        return tuple(broken)

    def _condition(self, number: int, state: int) -> int:
        """Return the guard that is true on the letters that break a clause in a state of its automaton."""
        key = (number, state)
        if key not in self._conditions:
            automaton, known = self._automata[number], dict[int, int]()
            self._conditions[key] = self._guard(automaton, automaton.transitions[state], known)
        return self._conditions[key]

    def _guard(self, automaton: _ClauseAutomaton, node: int, known: dict[int, int]) -> int:
        if node not in known:
            diagrams = automaton.diagrams
            if diagrams.variable[node] == LEAF:
                known[node] = ACCEPT if automaton.is_broken(node) else REJECT
            else:
                low = self._guard(automaton, diagrams.low[node], known)
                high = self._guard(automaton, diagrams.high[node], known)
                known[node] = self._diagrams.node(diagrams.variable[node], low, high)
        return known[node]

    def _places(self) -> dict[int, list[_Place]] | None:
        """Return the states of the clauses after all traces that lead to each state of the spec that is no trap.

        Return None if the search takes too many steps.
        """
        leaving: list[list[Edge]] = [[] for _ in self._fspa.states]
        for edge in self._fspa.edges:
            if self._fspa.states[edge.target].verdict != "violated":
                leaving[edge.source].append(edge)
        start = tuple(automaton.initial for automaton in self._automata)
        places = {0: [start]}
        queue: list[tuple[int, _Place]] = [(0, start)]
        for state, place in queue:
            for edge in leaving[state]:
                known = places.setdefault(edge.target, [])
                for after in self._after(place, edge.guard.primes):
                    if after not in known:
                        known.append(after)
                        queue.append((edge.target, after))
                if self._steps_left < 0:
                    return None
        return places

    def _after(self, place: _Place, primes: Sequence[Implicant]) -> Iterator[_Place]:
        """Yield the states of the clauses after the letters that satisfy one of ``primes``."""
        yielded: set[Hashable] = set()
        for prime in primes:
            polarity = dict(prime)
            nodes = tuple(automaton.transitions[state] for automaton, state in zip(self._automata, place, strict=True))
            stack, seen = [nodes], {nodes}
            while stack:
                nodes = stack.pop()
                self._steps_left -= 1
                if self._steps_left < 0:
                    return
                atoms = [
                    automaton.diagrams.variable[node] for automaton, node in zip(self._automata, nodes, strict=True)
                ]
                atom = min((atom for atom in atoms if atom != LEAF), default=LEAF)
                if atom == LEAF:
                    after = self._targets(nodes)
                    if after is not None and after not in yielded:
                        yielded.add(after)
                        yield after
                    continue
                for holds in (True, False):
                    if polarity.get(atom, holds) == holds:
                        children = tuple(
                            (automaton.diagrams.high if holds else automaton.diagrams.low)[node]
                            if tested == atom
                            else node
                            for automaton, node, tested in zip(self._automata, nodes, atoms, strict=True)
                        )
                        if children not in seen:
                            seen.add(children)
                            stack.append(children)

    def _targets(self, leaves: tuple[int, ...]) -> _Place | None:
        """Return the next states of the clauses; None for letters that cannot occur."""
        targets = [
            automaton.target(automaton.diagrams.value[leaf])
            for automaton, leaf in zip(self._automata, leaves, strict=True)
        ]
        return None if None in targets else tuple(target for target in targets if target is not None)
