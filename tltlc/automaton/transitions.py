"""Obligations and transitions: the decision diagrams that an automaton is built from.

An *obligation* is what remains to be done, as a Boolean function over temporal subformulas and
atoms. Two formulas with the same function are one obligation, and so one state of the automaton.

A *transition* is a function from a letter (the atoms that hold at a sample) to two values: the
obligation that remains, and 1 if a trace that ends with this sample is accepted, 0 otherwise. A
guard is a transition whose leaves are :data:`ACCEPT` and :data:`REJECT`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Final

from tltlc.automaton.diagrams import Diagrams, StepLimit, at_most_one

FALSE: Final = 0
"""The obligation ``false``: no trace satisfies it."""
TRUE: Final = 1
"""The obligation ``true``: every trace satisfies it."""

REJECT: Final = 0
"""The leaf (FALSE, 0): the transition of the formula ``false``, and a guard that is never true."""
ACCEPT: Final = 1
"""The leaf (TRUE, 1): the transition of the formula ``true``, and a guard that is always true."""
IMPOSSIBLE: Final = 2
"""The leaf for letters that ``exclusive`` declarations rule out."""

_NO_OBLIGATION: Final = -1


class ObligationDiagrams(Diagrams[bool]):
    """A table of obligations: Boolean functions that say what remains to be done.

    Each variable is the number of an atom or of a temporal subformula. ``both`` returns the
    conjunction of two obligations, ``either`` the disjunction. Each of these two operations raises
    :class:`~tltlc.automaton.diagrams.OutOfSteps` after ``limit.steps`` steps in total.
    """

    __slots__ = ("both", "either", "limit")

    def __init__(self, limit: StepLimit | None = None) -> None:
        super().__init__()
        self.leaf(False)
        self.leaf(True)
        self.limit = StepLimit() if limit is None else limit
        self.both: Callable[[int, int], int] = self.lattice_operation(
            bool.__and__, self.limit, absorbing=FALSE, neutral=TRUE
        )
        self.either: Callable[[int, int], int] = self.lattice_operation(
            bool.__or__, self.limit, absorbing=TRUE, neutral=FALSE
        )


class TransitionDiagrams(Diagrams[tuple[int, int]]):
    """A table of transitions, and a table of the obligations in their leaves.

    A transition maps each letter (the set of the atoms that hold at a sample) to the obligation
    that remains, and to 1 if a trace that ends with this letter is accepted, 0 otherwise. Each
    variable is an atom's index. ``conjoin`` returns the conjunction of two transitions, ``disjoin``
    the disjunction. Both have the same step limit as the operations on obligations.
    """

    __slots__ = ("conjoin", "disjoin", "limit", "obligations")

    def __init__(self, steps: int | None = None) -> None:
        super().__init__()
        self.limit = StepLimit() if steps is None else StepLimit(steps)
        self.obligations = ObligationDiagrams(self.limit)
        self.leaf((FALSE, 0))
        self.leaf((TRUE, 1))
        self.leaf((_NO_OBLIGATION, 0))
        both, either = self.obligations.both, self.obligations.either
        self.conjoin: Callable[[int, int], int] = self.lattice_operation(
            lambda x, y: (both(x[0], y[0]), x[1] & y[1]),
            self.limit,
            absorbing=REJECT,
            neutral=ACCEPT,
            undefined=IMPOSSIBLE,
        )
        self.disjoin: Callable[[int, int], int] = self.lattice_operation(
            lambda x, y: (either(x[0], y[0]), x[1] | y[1]),
            self.limit,
            absorbing=ACCEPT,
            neutral=REJECT,
            undefined=IMPOSSIBLE,
        )

    def allowed_letters(self, exclusive: Iterable[Sequence[int]]) -> int:
        """Return a guard that is true where at most one atom of each group of ``exclusive`` holds.

        A group lists indices of atoms.
        """
        return at_most_one(self, exclusive, (TRUE, 1), (FALSE, 0), self.conjoin)

    def constrain(self, transition: int, allowed: int) -> int:
        """Return the transition, but with the leaf ``IMPOSSIBLE`` wherever the guard ``allowed`` is false."""
        variable, low, high, node = self.variable, self.low, self.high, self.node
        memo: dict[tuple[int, int], int] = {}

        def operate(x: int, d: int) -> int:
            if d == ACCEPT:
                return x
            if d == REJECT:
                return IMPOSSIBLE
            key = (x, d)
            result = memo.get(key)
            if result is None:
                vx, vd = variable[x], variable[d]
                if vx == vd:
                    result = node(vx, operate(low[x], low[d]), operate(high[x], high[d]))
                elif vx < vd:
                    result = node(vx, operate(low[x], d), operate(high[x], d))
                else:
                    result = node(vd, operate(x, low[d]), operate(x, high[d]))
                memo[key] = result
            return result

        return operate(transition, allowed)
