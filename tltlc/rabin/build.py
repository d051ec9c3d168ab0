"""From a resolved specification over infinite traces to its automaton (semantics, section 5)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tltlc.automaton.blowup import blow_up, recursion_room
from tltlc.automaton.build import DEFAULT_STATE_BUDGET, allowed_letters, breadth_first, distances, text_of
from tltlc.automaton.diagrams import IMPOSSIBLE, Diagrams, OutOfSteps
from tltlc.automaton.fspa import Edge, Fspa, Guard, Pair, State
from tltlc.automaton.guards import Guards, TooManyPrimes
from tltlc.rabin.analysis import analysis_of_rabin
from tltlc.rabin.automaton import Rabin
from tltlc.rabin.construct import DEFAULT_WORK, rabin
from tltlc.rabin.letters import LEAF
from tltlc.rabin.work import OutOfWork, Work
from tltlc.rabin.written import Writer
from tltlc.resolve.spec import Spec


def build_infinite(spec: Spec) -> Fspa:
    """The deterministic, complete Rabin automaton of a specification over infinite traces.

    A state accepts (``accepting``) that lies on an accepted cycle; a trap is one from which none is reached.  Raises
    :class:`~tltlc.diagnostics.diagnostic.TltlError`: TLT0501 where the construction does not end in time, TLT0502
    where a guard has too many prime implicants.
    """
    with recursion_room():
        try:
            return _Build(spec).fspa()
        except OutOfWork:
            raise blow_up(spec, OutOfSteps(), DEFAULT_STATE_BUDGET) from None
        except (OutOfSteps, TooManyPrimes, RecursionError) as reason:
            raise blow_up(spec, reason, DEFAULT_STATE_BUDGET) from None


class _Build:
    def __init__(self, spec: Spec) -> None:
        self._spec = spec
        self._names = [atom.name for atom in spec.atoms]
        self._automaton = rabin(spec.formula, self._names, spec.exclusive)
        self._analysis = analysis_of_rabin(self._automaton, Work(DEFAULT_WORK))
        self._writer = Writer(spec.formula)

    def fspa(self) -> Fspa:
        spec, analysis = self._spec, self._analysis
        distance = distances(analysis.targets, accepting=analysis.goals.__contains__)
        order = breadth_first(0, analysis.targets, distance)
        number = {state: place for place, state in enumerate(order)}
        edges, pairs = self._edges(order, number)
        return Fspa(
            name=spec.name,
            doc=spec.doc,
            formula=text_of(spec.formula),
            level=spec.level,
            limit_steps=spec.limit_steps,
            judge=spec.judge or analysis.default_judge(),
            semantics=spec.semantics,
            tags=spec.tags,
            clock_s=spec.clock_s,
            signals=spec.signals,
            params=spec.params,
            atoms=spec.atoms,
            exclusive=spec.exclusive,
            states=tuple(self._state(number[state], state, distance[state]) for state in order),
            edges=edges,
            spec_size=max((d for d in distance.values() if d is not None), default=0),
            acceptance=pairs,
        )

    def _state(self, number: int, state: int, distance: int | None) -> State:
        label = text_of(self._writer.formula(self._automaton.labels[state]) if state else self._spec.formula)
        return State(number, label, state in self._analysis.goals, self._analysis.verdict(state), distance)

    def _edges(self, order: Sequence[int], number: Mapping[int, int]) -> tuple[tuple[Edge, ...], tuple[Pair, ...]]:
        """The edges, each with one set of marks, by source, target and marks; and the pairs, by the places of edges."""
        diagrams, leaves = Diagrams(), _Leaves()
        guards = Guards(diagrams, self._names, allowed_letters(diagrams, self._spec.exclusive))
        made: dict[int, Guard] = {}
        found: list[tuple[int, int, list[Any], Guard]] = []
        for state in order:
            transition = leaves.transition(self._automaton, self._automaton.steps[state], diagrams)
            for leaf, guard in guards.by_leaf(transition).items():
                if guard not in made:
                    made[guard] = Guard(guards.text(guard), guards.primes(guard))
                target, marks = leaves.values[diagrams.low[leaf]]
                found.append((number[state], number[target], sorted(marks), made[guard]))
        found.sort(key=lambda each: each[:3])

        def marked(pair: int, kind: str) -> tuple[int, ...]:
            return tuple(place for place, (_, _, marks, _) in enumerate(found) if (pair, kind) in marks)

        pairs = tuple(Pair(marked(pair, "fin"), marked(pair, "inf")) for pair in range(self._automaton.pairs))
        return tuple(Edge(source, target, guard) for source, target, _, guard in found), pairs


class _Leaves:
    """Steps as transitions of diagrams, whose leaves count targets and marks from 0 on."""

    def __init__(self) -> None:
        self.values: list[Any] = []
        self._numbers: dict[Any, int] = {}
        self._known: dict[int, int] = {}

    def transition(self, automaton: Rabin, step: int, diagrams: Diagrams) -> int:
        """A step as a transition."""
        found = self._known.get(step)
        if found is None:
            letters = automaton.letters
            if letters.atom[step] != LEAF:
                low = self.transition(automaton, letters.low[step], diagrams)
                high = self.transition(automaton, letters.high[step], diagrams)
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
