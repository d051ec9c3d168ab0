"""Obligations and transitions: the decision diagrams of a construction.

*Obligations* are Boolean functions over temporal subformulas and atoms.  Formulas that are equal as
such functions are one obligation, so a construction treats them as one state.

*Transitions* are functions from a letter (the atoms that hold at a sample) to a pair: the obligation
that remains, and whether the trace is accepted if this sample is its last (1) or not (0).  A guard
is a transition whose leaves are :data:`ACCEPT` and :data:`REJECT`.
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
"""The transition of ``false`` on every letter: (FALSE, 0)."""
ACCEPT: Final = 1
"""The transition of ``true`` on every letter: (TRUE, 1)."""
IMPOSSIBLE: Final = 2
"""The leaf of letters that ``exclusive`` declarations rule out."""

_NO_OBLIGATION: Final = -1


class ObligationDiagrams(Diagrams[bool]):
    """A table of obligations; the variables are numbers of atoms and temporal subformulas.

    ``both`` and ``either`` return the conjunction and the disjunction of two obligations.  They
    raise :class:`~tltlc.automaton.diagrams.OutOfSteps` after ``limit.steps`` steps each.
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
    """A table of transitions, with the table of their obligations; the variables are indices of atoms.

    ``conjoin`` and ``disjoin`` return the conjunction and the disjunction of two transitions.  They
    share the step limit of the obligations.
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
        """Return the letters with at most one atom of each group, as a guard."""
        return at_most_one(self, exclusive, (TRUE, 1), (FALSE, 0), self.conjoin)

    def constrain(self, transition: int, allowed: int) -> int:
        """Return the transition on letters where the guard ``allowed`` holds, ``IMPOSSIBLE`` on the others."""
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
