"""Prove early that a large conjunction or disjunction needs more states than its budget.

The machines of the parts are known; their product is the machine of the whole. Take a fixed list
of words. The *answer* of a state is the set of these words that are accepted from it. States with
different answers have different languages, so the minimal machine has at least as many states as
there are answers. The answer of a state of the product follows from the answers of its parts:
their intersection for a conjunction, their union for a disjunction.

The words use only letters in which at most one atom holds. Other letters could only add states, so
a count over the budget is a proof.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import reduce
from math import prod
from operator import and_, or_
from typing import Final

from tltlc.automaton.diagrams import LEAF
from tltlc.automaton.finite.machine import Machine
from tltlc.automaton.transitions import IMPOSSIBLE, TransitionDiagrams

_NONE: Final = -1
"""The letter in which no atom holds. Any other letter is an int: the index of the only atom that holds."""
_FEW: Final = 500
"""The number of states that a count visits before it may give up.

After that, a count gives up when it has found less than half as many different answers as states.
"""

Word = list[int]
_Table = dict[int, dict[int, tuple[int, int]]]
"""For each letter and state: the next state, and 1 if a trace that ends with the letter is accepted, 0 otherwise."""


class _EstimateStopped(Exception):
    """Raised when all counts together have used up their steps."""


class Estimate:
    """Decides whether products of machines certainly have too many states.

    All decisions together take at most ``steps`` steps; after that, the answer is always False.
    """

    def __init__(self, diagrams: TransitionDiagrams, steps: int) -> None:
        self._diagrams = diagrams
        self._remaining = steps
        self._leaf_without_atoms: dict[int, int] = {}

    def exceeds(self, machines: Sequence[Machine], conjunction: bool, budget: int) -> bool:
        """Whether the conjunction or disjunction of the machines certainly needs more than ``budget`` states.

        ``conjunction`` is True for the conjunction of the machines, False for their disjunction.
        The result False may also mean "unknown": no steps are left, or the search found too few
        states with different languages.
        """
        if prod(len(machine.transitions) for machine in machines) <= budget:
            return False
        try:
            return self._exceeds(machines, conjunction, budget)
        except _EstimateStopped:
            return False

    def _exceeds(self, machines: Sequence[Machine], conjunction: bool, budget: int) -> bool:
        tables = [self._table(machine) for machine in machines]
        if any(_NONE not in table for table in tables):
            return False
        words = _words(
            [_settling_word(machine, table, conjunction) for machine, table in zip(machines, tables, strict=True)]
        )
        self._spend(sum(map(len, words)) * sum(len(machine.transitions) for machine in machines))
        answers = [_answers(table, words) for table in tables]
        distinct = set()
        reached = self._reachable_states([machine.initial for machine in machines], tables)
        for count, states in enumerate(reached, 1):
            part_answers = [of_state[state] for of_state, state in zip(answers, states, strict=True)]
            distinct.add(reduce(and_ if conjunction else or_, part_answers))
            if len(distinct) > budget:
                return True
            if count > _FEW and 2 * len(distinct) < count:
                return False
        return False

    def _spend(self, steps: int) -> None:
        self._remaining -= steps
        if self._remaining < 0:
            raise _EstimateStopped

    def _table(self, machine: Machine) -> _Table:
        """Return the transitions of a machine as a table (see :data:`_Table`).

        The table has the letter without atoms, and a letter for each atom that some transition
        tests, in which only this atom holds. Letters that cannot occur are left out.
        """
        value = self._diagrams.value
        leaves = {state: self._leaves(transition) for state, transition in machine.transitions.items()}
        letters = sorted(set().union(*leaves.values()))
        self._spend(len(letters) * len(leaves))
        table: _Table = {}
        for letter in letters:
            reached = {state: of_state.get(letter, of_state[_NONE]) for state, of_state in leaves.items()}
            # Leave out letters that `exclusive` rules out. They are the same for all machines.
            if IMPOSSIBLE not in reached.values():
                table[letter] = {state: value[leaf] for state, leaf in reached.items()}
        return table

    def _leaves(self, node: int) -> dict[int, int]:
        """Map each letter with at most one atom to the leaf that it reaches from ``node``, a transition of a state.

        If a letter is missing, it reaches the same leaf as ``_NONE``, the letter without atoms.
        """
        atom, low, high = self._diagrams.variable, self._diagrams.low, self._diagrams.high
        leaves = {}
        while atom[node] != LEAF:
            self._spend(1)
            leaves[atom[node]] = self._without_atoms(high[node])
            node = low[node]
        return {_NONE: node, **leaves}

    def _without_atoms(self, node: int) -> int:
        """Return the leaf that is reached from ``node`` if no atom that is tested from there on holds."""
        atom, low, known = self._diagrams.variable, self._diagrams.low, self._leaf_without_atoms
        path = []
        while node not in known and atom[node] != LEAF:
            path.append(node)
            node = low[node]
        self._spend(len(path))
        leaf = known.get(node, node)
        known.update(dict.fromkeys(path, leaf))
        return leaf

    def _reachable_states(self, initial: Sequence[int], tables: Sequence[_Table]) -> Iterator[tuple[int, ...]]:
        """Yield the reachable states of the product, breadth-first: tuples with one state of each machine."""
        letters = sorted({letter for table in tables for letter in table} - {_NONE})
        # For each letter: the machines for which it differs from the letter without atoms, with their next states.
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
                    self._spend(len(base))
                    yield following
            self._spend(len(base) + sum(map(len, seeing.values())) + len(letters))


def _settling_word(machine: Machine, table: _Table, accepting: bool) -> Word | None:
    """Return a shortest word that a machine accepts; if ``accepting`` is False, a shortest word that it rejects.

    Returns None if there is no such word over the letters of ``table``.
    """
    queue: list[tuple[int, Word]] = [(machine.initial, [])]
    seen = {machine.initial}
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
    """Return words that distinguish the states of one machine at a time.

    ``settling`` has one word for each machine: for a conjunction, a word that the machine accepts;
    for a disjunction, a word that it rejects. Each word of the result is made for one machine: the
    words of all other machines, followed by a proper suffix of this machine's word. For the words
    ``ab`` and ``cd``, the result is ``cdb``, ``cd``, ``abd`` and ``ab``. If a machine has no word
    (None), the result is empty.
    """
    if None in settling:
        return []
    settled = [word for word in settling if word is not None]
    words = []
    for place, last in enumerate(settled):
        prefix = [letter for word in (*settled[:place], *settled[place + 1 :]) for letter in word]
        words += [prefix + last[start:] for start in range(1, len(last) + 1)]
    return words


def _answers(table: _Table, words: Sequence[Word]) -> dict[int, int]:
    """Return, for each state of a machine, which words it accepts: bit ``i`` is set if it accepts ``words[i]``."""
    answers = {}
    for start in table[_NONE]:
        bits = 0
        for number, word in enumerate(words):
            state, accepted = start, 0
            for letter in word:
                state, accepted = table.get(letter, table[_NONE])[state]
            bits |= accepted << number
        answers[start] = bits
    return answers
