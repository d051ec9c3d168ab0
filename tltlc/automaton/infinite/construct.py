"""Build the deterministic Rabin automaton of a formula.

The construction starts from the after-automaton. Its states, called labels, are what remains of
the formula; it has no acceptance yet. Each of its strongly connected components is converted to an
automaton with acceptance (:mod:`tltlc.automaton.infinite.component`): the simplest formula in the
component is normalised, a small automaton observes each part of the formula, and their acceptance
conditions become Rabin pairs. Then the components are joined. If some states have the same
language, the whole construction runs again with their labels merged.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations, product
from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams, OutOfSteps, at_most_one
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.infinite.after_automaton import ObligationAutomaton
from tltlc.automaton.infinite.assembled_components import ComponentPlace, join_components
from tltlc.automaton.infinite.automaton import NO_MARKS, Rabin
from tltlc.automaton.infinite.component import (
    IMPOSSIBLE,
    ComponentState,
    bottom_component,
    has_turns,
    merge_equal_states,
    parts_of,
)
from tltlc.automaton.infinite.delta2 import delta_2, delta_2_dually
from tltlc.automaton.infinite.factor_automata import factor
from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.languages import equal_states
from tltlc.automaton.infinite.normal_form import infinite_form
from tltlc.automaton.infinite.pairs import RabinComponent, with_pairs
from tltlc.automaton.infinite.state_merging import shrink
from tltlc.automaton.work import DEFAULT_WORK, OutOfWork, Work
from tltlc.core.record import replace
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula

_FOR_AN_ATTEMPT: Final = 400_000
"""Steps of work for one attempt to convert a component; an attempt that takes more is dropped."""
_FOR_LANGUAGES: Final = 1_000_000
"""Steps of work for finding states of equal language and the second construction.

If they take more, the automaton of the first construction is the result.
"""
_FOR_SHRINKING: Final = 400_000
"""Steps of work for removing states of a component.

When they are used up, the remaining states stay.
"""

LabelMap = dict[int, int]
"""A map from labels to labels, states or positions.

A label is an obligation of an
:class:`~tltlc.automaton.infinite.after_automaton.ObligationAutomaton`.
"""


def rabin(
    formula: Formula,
    atoms: Sequence[str] | None = None,
    exclusive: Sequence[Sequence[int]] = (),
    work: int = DEFAULT_WORK,
) -> Rabin:
    """Return the deterministic Rabin automaton of a formula over infinite traces.

    ``atoms`` are the names of the atoms, in the order of their indices; by default the atoms of the
    formula. ``exclusive`` has groups of indices of atoms; at most one atom of a group holds at a
    sample. Raises :class:`OutOfWork` after ``work`` steps,
    :class:`~tltlc.automaton.diagrams.OutOfSteps` if an obligation becomes too large, and
    :class:`~tltlc.automaton.guards.TooManyPrimes` if there are too many edges.
    """
    normal = infinite_form(formula)
    return _Construction(normal, formula.atoms() if atoms is None else atoms, exclusive, work).automaton()


class _Construction:
    def __init__(self, formula: Formula, atoms: Sequence[str], exclusive: Sequence[Sequence[int]], work: int) -> None:
        self.work = Work(work)
        # Users raise the budget if some component needs more work, so attempts at a component get more, too.
        self._for_an_attempt = _FOR_AN_ATTEMPT * max(1, work // DEFAULT_WORK)
        self.letters: Diagrams[Any] = Diagrams(self.work)
        self.after = ObligationAutomaton(atoms, self.letters)
        self.initial = self.after.obligation(formula)
        self._exclusive = exclusive
        self._allowed = at_most_one(self.letters, exclusive, True, False)
        self._constrained: dict[tuple[int, int], int] = {}

    def automaton(self) -> Rabin:
        """Return the Rabin automaton, with states of equal language merged if that makes the automaton smaller."""
        first, state_of, depth = self._construct({})
        try:
            with self.work.at_most(_FOR_LANGUAGES):
                representatives = self._equal_labels(first, state_of, depth)
                if any(label != other for label, other in representatives.items()):
                    second, _, _ = self._construct(representatives)
                    if (len(second.steps), second.pairs) < (len(first.steps), first.pairs):
                        return second
        except (OutOfWork, OutOfSteps, TooManyPrimes):
            pass
        return first

    def _equal_labels(self, automaton: Rabin, state_of: LabelMap, depth: LabelMap) -> LabelMap:
        """Map each label (obligation) to a representative of all labels with the same language.

        The representative is the label with the lowest ``depth``, and of these the shortest.
        ``depth`` maps labels to the positions of their components; ``state_of`` maps labels to
        states of ``automaton``.
        """
        same = equal_states(automaton, len(self.after.atoms), self._exclusive, self.work)
        representatives: LabelMap = {}
        best: LabelMap = {}
        for label in sorted(state_of, key=lambda label: (depth[label], self._size(label))):
            representatives[label] = best.setdefault(same[state_of[label]], label)
        return representatives

    def _construct(self, representatives: LabelMap) -> tuple[Rabin, LabelMap, LabelMap]:
        """Build the automaton, with each label (obligation) in ``representatives`` replaced by its representative.

        Returns the automaton, a dict from labels to states, and a dict from labels to the positions
        of their components. A component has a higher position than all components that can be
        reached from it. Raises :class:`TooManyPrimes` if there are more edges between labels than
        ``WORK["edges"]``.
        """
        memo: dict[int, int] = {}

        def step_of(label: int) -> int:
            step = self._step(label)
            return (
                self.letters.map_leaves(lambda label: representatives.get(label, label), step, memo)
                if representatives
                else step
            )

        edges = 0

        def targets(label: int) -> list[int]:
            nonlocal edges
            successors = self._targets(step_of(label))
            edges += len(successors)
            if edges > WORK["edges"]:
                raise TooManyPrimes("the automaton", WORK["edges"], "edges")
            return successors

        initial = representatives.get(self.initial, self.initial)
        rabin_components: list[RabinComponent] = []
        entry: dict[int, ComponentPlace] = {}
        depth: LabelMap = {}
        for number, group in enumerate(components([initial], targets)):
            component = self._rabin_component(step_of, group)
            rabin_components.append(component)
            depth.update(dict.fromkeys(group, number))
            for state, label in component.labels.items():
                entry.setdefault(label, (number, state))
        whole, states = join_components(self.letters, rabin_components, entry, entry[initial])
        labelled = replace(whole, labels=tuple(map(self.after.formula, whole.labels)))
        return labelled, {label: states[place] for label, place in entry.items() if place in states}, depth

    # --- letters ----------------------------------------------------------------------------------

    def _step(self, label: int) -> int:
        """Return a decision diagram that maps each letter to the label that follows ``label``.

        The value is ``IMPOSSIBLE`` on letters that ``exclusive`` rules out.
        """
        step = self.after.after(label)
        if not self._exclusive:
            return step
        return self.letters.apply(
            lambda label, allowed: label if allowed else IMPOSSIBLE, step, self._allowed, self._constrained
        )

    def _targets(self, step: int) -> list[int]:
        return [label for label in self.letters.values(step) if label != IMPOSSIBLE]

    # --- components -------------------------------------------------------------------------------

    def _rabin_component(self, step_of: Callable[[int], int], group: Sequence[int]) -> RabinComponent:
        """Return the smallest automaton with Rabin pairs that was found for ``group``, the labels of a component.

        ``step_of(label)`` is a function from the letter to the next label. Raises OutOfWork if no
        automaton was found.
        """
        inside = frozenset(group)
        if not any(target in inside for label in group for target in self._targets(step_of(label))):
            (label,) = group
            step = self.letters.map_leaves(lambda target: (("exit", target), NO_MARKS), step_of(label), {})
            return RabinComponent({(label,): label}, {(label,): step}, 0)
        best: RabinComponent | None = None
        first = min(group, key=lambda label: (self._size(label), group.index(label)))
        for attempt in self._attempts(step_of, inside, first):
            if best is None or (len(attempt.steps), attempt.pairs) < (len(best.steps), best.pairs):
                best = attempt
            if len(best.steps) == len(group) and best.pairs <= 1:
                break
        if best is None:
            raise OutOfWork
        return shrink(self.letters, best, self.work, _FOR_SHRINKING) if len(best.steps) > len(group) else best

    def _attempts(self, step_of: Callable[[int], int], inside: frozenset[int], first: int) -> Iterator[RabinComponent]:
        """Yield automata for the component with the labels ``inside``, each built in another way.

        Each automaton is made for the formula of the label ``first``. An attempt that takes too
        much work yields no automaton.
        """
        formula = self.after.formula(first)
        forms = []
        for normalise in (delta_2, delta_2_dually):
            try:
                forms.append(normalise(formula))
            except OutOfWork:
                continue
        for normal, keep, in_turn in product(dict.fromkeys(forms), (False, True), (False, True)):
            if in_turn and not has_turns(normal):
                continue
            try:
                with self.work.at_most(self._for_an_attempt):
                    skeleton, parts = parts_of(self.after, normal, keep=keep, in_turn=in_turn)
                    whole = bottom_component(self.letters, step_of, inside, first, skeleton, parts)
                    if component := factor(self.letters, whole, lambda state: state[:1], self.work):
                        yield component
                        continue
                    yield with_pairs(self.letters, merge_equal_states(self.letters, whole), self.work)
                    for count in (1, 2):
                        for chosen in combinations(range(1, len(parts) + 1), count):
                            if component := factor(self.letters, whole, _key_function(chosen), self.work):
                                yield component
            except (OutOfWork, OutOfSteps):
                continue

    def _size(self, label: int) -> int:
        return sum(1 for _ in self.after.formula(label).walk())


def _key_function(chosen: Sequence[int]) -> Callable[[ComponentState], ComponentState]:
    """Return a function that reduces a state, which is a tuple, to its label and its entries at ``chosen`` indices.

    The label is the first entry.
    """
    return lambda state: (state[0], *(state[index] for index in chosen))
