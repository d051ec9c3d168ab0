"""Tell early that a large conjunction or disjunction needs more states than its budget.

Two states differ where some word is accepted from one of them alone. So the states of the minimal machine are at
least as many as there are different answers of the reached states to a list of words. Each part answers for itself:
a conjunction accepts what all of its parts accept, a disjunction what one of them accepts.

Letters here have one atom or none. Others could only add states, so a count that is over the budget is right.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import reduce
from math import prod
from operator import and_, or_
from typing import Final

from tltlc.automaton.diagrams import IMPOSSIBLE, LEAF, Diagrams
from tltlc.automaton.finite.machine import Machine

_NONE: Final = -1
"""The letter without an atom; others are the indices of their atoms."""
_FEW: Final = 500
"""After so many states at least half of them must have answers of their own, or else the words are too few."""

Word = list[int]
_Table = dict[int, dict[int, tuple[int, int]]]
"""By letter and state: the state that the letter leads to, and 1 where the trace may end with it, else 0."""


class _OutOfSteps(Exception):
    """Raised when the count has taken all of its steps."""


class Estimate:
    """Counts states of products; ``steps`` bounds the look-ups of all counts together."""

    def __init__(self, diagrams: Diagrams, steps: int) -> None:
        self._diagrams = diagrams
        self._left = steps
        self._known: dict[int, int] = {}

    def exceeds(self, machines: Sequence[Machine], conjunction: bool, budget: int) -> bool:
        """Whether the conjunction, or disjunction, of the machines certainly has more than ``budget`` states.

        False where that is unknown: after the steps, or where the words do not tell enough states apart.
        """
        if prod(len(made.transitions) for made in machines) <= budget:
            return False
        try:
            return self._exceeds(machines, conjunction, budget)
        except _OutOfSteps:
            return False

    def _exceeds(self, machines: Sequence[Machine], conjunction: bool, budget: int) -> bool:
        tables = [self._table(made) for made in machines]
        if any(_NONE not in table for table in tables):
            return False
        words = _words([_settling(made, table, conjunction) for made, table in zip(machines, tables, strict=True)])
        self._take(sum(map(len, words)) * sum(len(made.transitions) for made in machines))
        answers = [_answers(table, words) for table in tables]
        found = set()
        reached = self._reached([made.initial for made in machines], tables)
        for count, states in enumerate(reached, 1):
            own = [of_state[state] for of_state, state in zip(answers, states, strict=True)]
            found.add(reduce(and_ if conjunction else or_, own))
            if len(found) > budget:
                return True
            if count > _FEW and 2 * len(found) < count:
                return False
        return False

    def _take(self, steps: int) -> None:
        self._left -= steps
        if self._left < 0:
            raise _OutOfSteps

    def _table(self, made: Machine) -> _Table:
        """The moves of a machine, for the letters that ``exclusive`` allows."""
        low, high = self._diagrams.low, self._diagrams.high
        leaves = {state: self._leaves(transition) for state, transition in made.transitions.items()}
        letters = sorted(set().union(*leaves.values()))
        self._take(len(letters) * len(leaves))
        table: _Table = {}
        for letter in letters:
            reached = {state: of_state.get(letter, of_state[_NONE]) for state, of_state in leaves.items()}
            # The same letters are impossible for all machines.
            if IMPOSSIBLE not in reached.values():
                table[letter] = {state: (low[leaf], high[leaf]) for state, leaf in reached.items()}
        return table

    def _leaves(self, node: int) -> dict[int, int]:
        """The leaf that each letter leads to from a transition; letters that are left out lead where ``_NONE`` does."""
        atom, low, high = self._diagrams.atom, self._diagrams.low, self._diagrams.high
        found = {}
        while atom[node] != LEAF:
            self._take(1)
            found[atom[node]] = self._without_atoms(high[node])
            node = low[node]
        return {_NONE: node, **found}

    def _without_atoms(self, node: int) -> int:
        """The leaf that no further atom leads to; remembered for all nodes on the way."""
        atom, low, known = self._diagrams.atom, self._diagrams.low, self._known
        way = []
        while node not in known and atom[node] != LEAF:
            way.append(node)
            node = low[node]
        self._take(len(way))
        leaf = known.get(node, node)
        known.update(dict.fromkeys(way, leaf))
        return leaf

    def _reached(self, initial: Sequence[int], tables: Sequence[_Table]) -> Iterator[tuple[int, ...]]:
        """The states of the product that words reach, breadth first, each with a state of every machine."""
        letters = sorted({letter for table in tables for letter in table} - {_NONE})
        # Only these machines see the letter: for the others it is like that without an atom.
        seeing = {
            letter: [
                (place, moves)
                for place, table in enumerate(tables)
                if (moves := table.get(letter)) is not None and moves != table[_NONE]
            ]
            for letter in letters
        }
        queue = [tuple(initial)]
        seen = set(queue)
        yield queue[0]
        for states in queue:
            base = tuple(table[_NONE][state][0] for table, state in zip(tables, states, strict=True))
            for letter in (_NONE, *letters):
                changed = list(base)
                for place, moves in seeing.get(letter, ()):
                    changed[place] = moves[states[place]][0]
                if (following := tuple(changed)) not in seen:
                    seen.add(following)
                    queue.append(following)
                    self._take(len(base))
                    yield following
            self._take(len(base) + sum(map(len, seeing.values())) + len(letters))


def _settling(made: Machine, table: _Table, accepting: bool) -> Word | None:
    """A shortest word that a machine accepts, or one that it rejects; None where there is none of such letters."""
    queue: list[tuple[int, Word]] = [(made.initial, [])]
    seen = {made.initial}
    for state, word in queue:
        for letter, moves in table.items():
            following, accepted = moves[state]
            if accepted == accepting:
                return [*word, letter]
            if following not in seen:
                seen.add(following)
                queue.append((following, [*word, letter]))
    return None


def _words(settling: Sequence[Word | None]) -> list[Word]:
    """Words that settle all machines but one, each with all ends of the word that settles that one."""
    if None in settling:
        return []
    own = [word for word in settling if word is not None]
    found = []
    for place, last in enumerate(own):
        others = [letter for word in (*own[:place], *own[place + 1 :]) for letter in word]
        found += [others + last[start:] for start in range(1, len(last) + 1)]
    return found


def _answers(table: _Table, words: Sequence[Word]) -> dict[int, int]:
    """For each state of a machine which of the words it accepts, as bits."""
    found = {}
    for start in table[_NONE]:
        bits = 0
        for number, word in enumerate(words):
            state, accepted = start, 0
            for letter in word:
                state, accepted = table.get(letter, table[_NONE])[state]
            bits |= accepted << number
        found[start] = bits
    return found
