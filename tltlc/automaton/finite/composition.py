"""Build the machines of large conjunctions and disjunctions part by part.

Each operand gets its own minimal machine. Then the two smallest machines are replaced by the
minimal machine of their product, again and again, until one machine is left.

The alternative is to explore the formula as a whole. That visits every combination of obligations
of the operands, even combinations that are merged in the end. It is faster for small formulas, as
most rules of games are, but too slow for conjunctions of dozens of clauses.
"""

from __future__ import annotations

from heapq import heapify, heappop, heappush

from tltlc.automaton.diagrams import LEAF, OutOfSteps
from tltlc.automaton.finite.estimate import Estimate
from tltlc.automaton.finite.machine import Machine, OutOfStates, machine
from tltlc.automaton.finite.successors import Successors
from tltlc.automaton.transitions import ACCEPT, FALSE, IMPOSSIBLE, TRUE, TransitionDiagrams
from tltlc.io.limits import WORK
from tltlc.logic.formula import Formula

WHOLE_STEPS = 5_000
"""The most steps for exploring a formula as a whole; they take a few milliseconds.

A formula that takes more steps is built part by part.
"""


def minimal_machine(successors: Successors, formula: Formula, state_budget: int, allowed: int = ACCEPT) -> Machine:
    """Return the minimal machine of a formula in negation normal form.

    A machine is an automaton whose transitions, not states, decide acceptance. If the formula is an
    ``and`` or ``or`` that takes many steps to explore as a whole, its operands get machines of
    their own, which are then combined. ``allowed`` is a guard: only letters on which the guard is
    true can occur.

    Raises:
        OutOfStates: the machine, or the machine of a part, has more than ``state_budget``
            obligations before it is minimised; or all these machines together have too many (the
            limit is ``WORK["states of parts"]`` or three times ``state_budget``, whichever is
            larger).
        OutOfSteps: the transitions take too many steps.
    """
    return _Composition(successors, state_budget, allowed).minimal(formula)


class _Composition:
    """Builds the machine of one formula, and counts the states of all machines that are built for its parts."""

    def __init__(self, successors: Successors, state_budget: int, allowed: int) -> None:
        self._successors = successors
        self._state_budget = state_budget
        self._allowed = allowed
        self._remaining = max(WORK["states of parts"], 3 * state_budget)
        self._estimate = Estimate(successors.diagrams, WORK["estimate of states"])

    def minimal(self, formula: Formula) -> Machine:
        whole = self._successors.obligation(formula)
        if formula.op not in ("and", "or"):
            return self._machine(whole)
        try:
            with self._successors.diagrams.limit.at_most(WHOLE_STEPS):
                return self._machine(whole)
        except (OutOfStates, OutOfSteps, RecursionError):
            return self._by_parts(formula)

    def _machine(self, obligation: int) -> Machine:
        if self._remaining < 0:
            raise OutOfStates
        minimal = machine(self._successors, obligation, self._state_budget, self._allowed)
        self._remaining -= len(minimal.representative)
        return minimal

    def _by_parts(self, formula: Formula) -> Machine:
        diagrams = self._successors.diagrams
        join = diagrams.obligations.both if formula.op == "and" else diagrams.obligations.either
        machines = [self.minimal(part) for part in formula.args]
        if self._estimate.exceeds(machines, formula.op == "and", self._state_budget):
            raise OutOfStates
        # Machines of equal size are ordered by their number, so that the result is always the same.
        heap = [(len(minimal.transitions), number, minimal) for number, minimal in enumerate(machines)]
        heapify(heap)
        number = len(heap)
        while len(heap) > 1:
            (_, _, left), (_, _, right) = heappop(heap), heappop(heap)
            minimal = self._machine(join(_embed(self._successors, left), _embed(self._successors, right)))
            heappush(heap, (len(minimal.transitions), number, minimal))
            number += 1
        return heap[0][2]


def _embed(successors: Successors, minimal: Machine) -> int:
    """Return an obligation that is satisfied by exactly the traces that a machine accepts.

    A state that accepts whatever follows becomes TRUE, and a state that rejects whatever follows
    becomes FALSE. Each other state becomes a new obligation, a variable of its own, which gets the
    transition of the state.
    """
    diagrams = successors.diagrams
    obligations: dict[int, int] = {}
    for state, transition in minimal.transitions.items():
        settled = _constant_obligation(diagrams, state, transition)
        obligations[state] = successors.new_state(state) if settled is None else settled
    memo = {IMPOSSIBLE: IMPOSSIBLE}
    for state, transition in minimal.transitions.items():
        if obligations[state] not in (FALSE, TRUE):
            successors.define_state(
                obligations[state],
                diagrams.map_leaves(lambda leaf: (obligations[leaf[0]], leaf[1]), transition, memo),
            )
    return obligations[minimal.initial]


def _constant_obligation(diagrams: TransitionDiagrams, state: int, transition: int) -> int | None:
    """Return TRUE if a state accepts whatever follows, FALSE if it rejects whatever follows, None otherwise.

    In the first two cases, every letter that can occur leads from the state back to itself.
    """
    # The letter in which no atom holds can always occur. If it leads to another state, the result is None.
    leaf = transition
    while diagrams.variable[leaf] != LEAF:
        leaf = diagrams.low[leaf]
    following, accepted = diagrams.value[leaf]
    if following != state or any(other not in (leaf, IMPOSSIBLE) for other in diagrams.leaves(transition)):
        return None
    return TRUE if accepted else FALSE
