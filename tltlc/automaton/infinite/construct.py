"""From a formula to its deterministic Rabin automaton.

The after-automaton has what remains of the formula as its states.  Each of its strongly connected components is made
an automaton of its own (:mod:`tltlc.automaton.infinite.component`): the simplest formula in it is normalised, its
parts are followed
beside the labels, and their marks become Rabin pairs.  The components are put together, states of equal language are
found, and where there are any the whole is done once more with these as one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations, product
from typing import Any, Final

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.guards import TooManyPrimes
from tltlc.automaton.infinite.after_automaton import After
from tltlc.automaton.infinite.assembled_components import Place, joined
from tltlc.automaton.infinite.automaton import NO_MARKS, Rabin
from tltlc.automaton.infinite.component import IMPOSSIBLE, State, has_turns, local, merged, parts_of
from tltlc.automaton.infinite.delta2 import delta_2, delta_2_dually
from tltlc.automaton.infinite.factors import factor
from tltlc.automaton.infinite.graphs import components
from tltlc.automaton.infinite.infinite import infinite_form
from tltlc.automaton.infinite.languages import equal_states
from tltlc.automaton.infinite.letters import Letters, at_most_one
from tltlc.automaton.infinite.pairs import Piece, with_pairs
from tltlc.automaton.infinite.state_merging import shrunk
from tltlc.automaton.infinite.work import DEFAULT_WORK, OutOfWork, Work
from tltlc.core.record import replace
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula

_FOR_AN_ATTEMPT: Final = 400_000
_FOR_LANGUAGES: Final = 1_000_000
_FOR_SHRINKING: Final = 400_000
"""Steps for one way to make a component, for finding states of equal language, and for doing without states; what takes
more is left out.
"""

Labels = dict[int, int]
"""By labels, which are obligations of :class:`~tltlc.automaton.infinite.after_automaton.After`."""


def rabin(
    formula: Formula,
    atoms: Sequence[str] | None = None,
    exclusive: Sequence[Sequence[int]] = (),
    work: int = DEFAULT_WORK,
) -> Rabin:
    """The automaton of a formula over infinite traces.

    ``atoms`` are the names by whose place letters are read, by default those of the formula in order; of the atoms of
    a group of ``exclusive``, by their places, at most one holds in a letter.  Raises :class:`OutOfWork` after ``work``
    steps, :class:`~tltlc.automaton.diagrams.OutOfSteps` where what remains of the formula becomes too large, and
    :class:`~tltlc.automaton.guards.TooManyPrimes` where it has too many edges.
    """
    normal = infinite_form(formula)
    return _Construction(normal, formula.atoms() if atoms is None else atoms, exclusive, work).automaton()


class _Construction:
    def __init__(self, formula: Formula, atoms: Sequence[str], exclusive: Sequence[Sequence[int]], work: int) -> None:
        self.work = Work(work)
        # Where more is allowed in all, it is because the default is too little for a component.
        self._for_an_attempt = _FOR_AN_ATTEMPT * max(1, work // DEFAULT_WORK)
        self.letters: Letters[Any] = Letters(self.work)
        self.after = After(atoms, self.letters)
        self.initial = self.after.obligation(formula)
        self._exclusive = exclusive
        self._allowed = at_most_one(self.letters, exclusive, True, False)
        self._constrained: dict[tuple[int, int], int] = {}

    def automaton(self) -> Rabin:
        """The automaton, and another one with labels of equal language as one where that is smaller."""
        first, state_of, depth = self._made({})
        try:
            with self.work.at_most(_FOR_LANGUAGES):
                stands = self._equal_labels(first, state_of, depth)
                if any(label != other for label, other in stands.items()):
                    second, _, _ = self._made(stands)
                    if (len(second.steps), second.pairs) < (len(first.steps), first.pairs):
                        return second
        except (OutOfWork, OutOfSteps, TooManyPrimes):
            pass
        return first

    def _equal_labels(self, automaton: Rabin, state_of: Labels, depth: Labels) -> Labels:
        """Of each label the one that stands for all of its language: the nearest to the end, then the shortest."""
        same = equal_states(automaton, len(self.after.atoms), self._exclusive, self.work)
        stands: Labels = {}
        best: Labels = {}
        for label in sorted(state_of, key=lambda each: (depth[each], self._size(each))):
            stands[label] = best.setdefault(same[state_of[label]], label)
        return stands

    def _made(self, stands: Labels) -> tuple[Rabin, Labels, Labels]:
        """The automaton, where some labels stand for others; of each label its state, and the place of its component,
        of which those that end the others come first.

        Raises :class:`TooManyPrimes` where labels lead to others by more edges than a spec may have.
        """
        memo: dict[int, int] = {}

        def step_of(label: int) -> int:
            found = self._step(label)
            return self.letters.mapped(lambda each: stands.get(each, each), found, memo) if stands else found

        edges = 0

        def targets(label: int) -> list[int]:
            nonlocal edges
            found = self._targets(step_of(label))
            edges += len(found)
            if edges > WORK["edges"]:
                raise TooManyPrimes("the automaton", WORK["edges"], "edges")
            return found

        initial = stands.get(self.initial, self.initial)
        pieces: list[Piece] = []
        entry: dict[int, Place] = {}
        depth: Labels = {}
        for number, group in enumerate(components([initial], targets)):
            piece = self._piece(step_of, group)
            pieces.append(piece)
            depth.update(dict.fromkeys(group, number))
            for state, label in piece.labels.items():
                entry.setdefault(label, (number, state))
        whole, states = joined(self.letters, pieces, entry, entry[initial])
        made = replace(whole, labels=tuple(map(self.after.formula, whole.labels)))
        return made, {label: states[place] for label, place in entry.items() if place in states}, depth

    # --- letters ----------------------------------------------------------------------------------

    def _step(self, label: int) -> int:
        """The label after each letter, ``IMPOSSIBLE`` after those that are not allowed."""
        found = self.after.after(label)
        if not self._exclusive:
            return found
        return self.letters.combined(
            lambda label, allowed: label if allowed else IMPOSSIBLE, found, self._allowed, self._constrained
        )

    def _targets(self, step: int) -> list[int]:
        return [label for label in self.letters.values(step) if label != IMPOSSIBLE]

    # --- components -------------------------------------------------------------------------------

    def _piece(self, step_of: Callable[[int], int], group: Sequence[int]) -> Piece:
        """A component of the after-automaton as an automaton with pairs, the smallest that was found."""
        inside = frozenset(group)
        if not any(target in inside for label in group for target in self._targets(step_of(label))):
            (label,) = group
            step = self.letters.mapped(lambda each: (("exit", each), NO_MARKS), step_of(label), {})
            return Piece({(label,): label}, {(label,): step}, 0)
        best: Piece | None = None
        first = min(group, key=lambda each: (self._size(each), group.index(each)))
        for attempt in self._attempts(step_of, inside, first):
            if best is None or (len(attempt.steps), attempt.pairs) < (len(best.steps), best.pairs):
                best = attempt
            if len(best.steps) == len(group) and best.pairs <= 1:
                break
        if best is None:
            raise OutOfWork
        return shrunk(self.letters, best, self.work, _FOR_SHRINKING) if len(best.steps) > len(group) else best

    def _attempts(self, step_of: Callable[[int], int], inside: frozenset[int], first: int) -> Iterator[Piece]:
        """The ways to make a component, which begins with the label ``first``, as far as the work allows."""
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
                    whole = local(self.letters, step_of, inside, first, skeleton, parts)
                    if found := factor(self.letters, whole, lambda state: state[:1], self.work):
                        yield found
                        continue
                    yield with_pairs(self.letters, merged(self.letters, whole), self.work)
                    for count in (1, 2):
                        for chosen in combinations(range(1, len(parts) + 1), count):
                            if found := factor(self.letters, whole, _picked(chosen), self.work):
                                yield found
            except (OutOfWork, OutOfSteps):
                continue

    def _size(self, label: int) -> int:
        return sum(1 for _ in self.after.formula(label).walk())


def _picked(chosen: Sequence[int]) -> Callable[[State], State]:
    """The label of a state and some of its memories."""
    return lambda state: (state[0], *(state[each] for each in chosen))
