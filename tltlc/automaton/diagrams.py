"""Hash-consed decision diagrams: the data structure of the whole construction.

There are two kinds of nodes.  Each node is an int and canonical, so ``==`` decides equality.

*Obligations* are Boolean functions over temporal subformulas and atoms: binary decision diagrams
whose variables are formulas.  Formulas that are equal as such functions are one obligation, so the
construction treats them as one state.

*Transitions* are functions from a letter (the atoms that hold at a sample) to a leaf.  A leaf is a
pair: the obligation that remains, and whether the trace is accepted if this sample is its last.
Inner nodes test an atom, by index, in order.

No operation enumerates letters; all are memoised.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

FALSE: Final = 0
"""The obligation ``false``: no trace satisfies it."""
TRUE: Final = 1
"""The obligation ``true``: every trace satisfies it."""

REJECT: Final = 0
"""The transition of ``false`` on every letter: (FALSE, not accepted)."""
ACCEPT: Final = 1
"""The transition of ``true`` on every letter: (TRUE, accepted)."""
IMPOSSIBLE: Final = 2
"""The leaf of letters that ``exclusive`` declarations rule out."""

LEAF: Final = 1 << 40
"""The ``atom`` of a leaf, greater than every atom's index."""


class OutOfSteps(Exception):
    """Raised when an operation takes more steps than its limit: the formula blows up."""


class Diagrams:
    """A table of nodes and the operations on them.

    ``atom[n]``, ``low[n]`` and ``high[n]`` describe transition ``n``.  For a leaf, ``low`` is the
    obligation, and ``high`` is 1 if the trace may end here, else 0.  ``variable[n]``, ``absent[n]``
    and ``present[n]`` describe obligation ``n``.  Each of the four operations (``both``,
    ``either``, ``conjoin``, ``disjoin``) may take ``step_limit`` steps in total, then it raises
    :class:`OutOfSteps`.  Each step is cached, so the limit bounds memory too.
    """

    __slots__ = (
        "_memos",
        "_nodes",
        "_obligations",
        "absent",
        "atom",
        "both",
        "conjoin",
        "disjoin",
        "either",
        "high",
        "low",
        "node",
        "present",
        "step_limit",
        "variable",
    )

    def __init__(self, step_limit: int = 2_000_000) -> None:
        self.step_limit = step_limit
        self._memos: list[dict[tuple[int, int], int]] = []
        self.variable: list[int] = [LEAF, LEAF]
        self.absent: list[int] = [FALSE, TRUE]
        self.present: list[int] = [FALSE, TRUE]
        self._obligations: dict[tuple[int, int, int], int] = {}
        self.atom: list[int] = [LEAF, LEAF, LEAF]
        self.low: list[int] = [FALSE, TRUE, -1]
        self.high: list[int] = [0, 1, 0]
        self._nodes: dict[tuple[int, int, int], int] = {(LEAF, FALSE, 0): REJECT, (LEAF, TRUE, 1): ACCEPT}
        self.node: Callable[[int, int, int], int] = self._node_maker()
        self.both: Callable[[int, int], int] = self._obligation_operation(absorbing=FALSE, neutral=TRUE)
        self.either: Callable[[int, int], int] = self._obligation_operation(absorbing=TRUE, neutral=FALSE)
        self.conjoin: Callable[[int, int], int] = self._transition_operation(
            REJECT, ACCEPT, self.both, conjunction=True
        )
        self.disjoin: Callable[[int, int], int] = self._transition_operation(
            ACCEPT, REJECT, self.either, conjunction=False
        )

    @contextmanager
    def at_most(self, steps: int) -> Iterator[None]:
        """Allow each operation at most ``steps`` further steps inside the ``with`` block."""
        before = self.step_limit
        self.step_limit = min(before, max(map(len, self._memos)) + steps)
        try:
            yield
        finally:
            self.step_limit = before

    # --- making nodes -------------------------------------------------------------------------

    def obligation(self, variable: int, absent: int, present: int) -> int:
        """Return the obligation that is ``present`` where the variable holds and ``absent`` elsewhere."""
        if absent == present:
            return absent
        key = (variable, absent, present)
        number = self._obligations.get(key)
        if number is None:
            number = self._obligations[key] = len(self.variable)
            self.variable.append(variable)
            self.absent.append(absent)
            self.present.append(present)
        return number

    def leaf(self, obligation: int, accepted: int) -> int:
        """Return the transition to one obligation on every letter."""
        key = (LEAF, obligation, accepted)
        number = self._nodes.get(key)
        return self._add(key) if number is None else number

    def _add(self, key: tuple[int, int, int]) -> int:
        number = len(self.atom)
        self._nodes[key] = number
        self.atom.append(key[0])
        self.low.append(key[1])
        self.high.append(key[2])
        return number

    # --- operations ---------------------------------------------------------------------------
    # Each is a closure over the tables: attribute look-ups would cost a third of the run time.

    def _node_maker(self) -> Callable[[int, int, int], int]:
        nodes, add = self._nodes, self._add

        def node(atom: int, low: int, high: int) -> int:
            """Return the transition ``high`` on letters with the atom, ``low`` on the others."""
            if low == high:
                return low
            key = (atom, low, high)
            number = nodes.get(key)
            return add(key) if number is None else number

        return node

    def _obligation_operation(self, absorbing: int, neutral: int) -> Callable[[int, int], int]:
        variable, absent, present, make = self.variable, self.absent, self.present, self.obligation
        memo: dict[tuple[int, int], int] = {}
        self._memos.append(memo)

        def operate(x: int, y: int) -> int:
            if x == y or y == neutral:
                return x
            if x == neutral:
                return y
            if x == absorbing or y == absorbing:
                return absorbing
            key = (x, y) if x < y else (y, x)
            result = memo.get(key)
            if result is None:
                if len(memo) >= self.step_limit:
                    raise OutOfSteps
                vx, vy = variable[x], variable[y]
                if vx == vy:
                    result = make(vx, operate(absent[x], absent[y]), operate(present[x], present[y]))
                elif vx < vy:
                    result = make(vx, operate(absent[x], y), operate(present[x], y))
                else:
                    result = make(vy, operate(x, absent[y]), operate(x, present[y]))
                memo[key] = result
            return result

        return operate

    def _transition_operation(
        self, absorbing: int, neutral: int, combine: Callable[[int, int], int], *, conjunction: bool
    ) -> Callable[[int, int], int]:
        atom, low, high, nodes, add = self.atom, self.low, self.high, self._nodes, self._add
        memo: dict[tuple[int, int], int] = {}
        self._memos.append(memo)

        def operate(x: int, y: int) -> int:
            if x == y or y == neutral:
                return x
            if x == neutral:
                return y
            if x == absorbing or y == absorbing:
                return absorbing
            key = (x, y) if x < y else (y, x)
            result = memo.get(key)
            if result is not None:
                return result
            if x == IMPOSSIBLE or y == IMPOSSIBLE:
                return IMPOSSIBLE
            if len(memo) >= self.step_limit:
                raise OutOfSteps
            ax, ay = atom[x], atom[y]
            if ax == ay:
                if ax == LEAF:
                    accepted = high[x] & high[y] if conjunction else high[x] | high[y]
                    triple = (LEAF, combine(low[x], low[y]), accepted)
                    result = nodes.get(triple)
                    memo[key] = result = add(triple) if result is None else result
                    return result
                below, above = operate(low[x], low[y]), operate(high[x], high[y])
            elif ax < ay:
                below, above = operate(low[x], y), operate(high[x], y)
            else:
                ax = ay
                below, above = operate(x, low[y]), operate(x, high[y])
            if below == above:
                result = below
            else:
                triple = (ax, below, above)
                result = nodes.get(triple)
                if result is None:
                    result = add(triple)
            memo[key] = result
            return result

        return operate

    def constrain(self, transition: int, allowed: int) -> int:
        """Return the transition on letters where ``allowed`` is ``ACCEPT``, ``IMPOSSIBLE`` on the others.

        ``allowed`` is a Boolean function of the letter: a transition whose leaves are ``ACCEPT``
        and ``REJECT``.
        """
        atom, low, high, node = self.atom, self.low, self.high, self.node
        memo: dict[tuple[int, int], int] = {}

        def operate(x: int, d: int) -> int:
            if d == ACCEPT:
                return x
            if d == REJECT:
                return IMPOSSIBLE
            key = (x, d)
            result = memo.get(key)
            if result is None:
                ax, ad = atom[x], atom[d]
                if ax == ad:
                    result = node(ax, operate(low[x], low[d]), operate(high[x], high[d]))
                elif ax < ad:
                    result = node(ax, operate(low[x], d), operate(high[x], d))
                else:
                    result = node(ad, operate(x, low[d]), operate(x, high[d]))
                memo[key] = result
            return result

        return operate(transition, allowed)

    def relabel(self, transition: int, leaf_map: Callable[[int], int], memo: dict[int, int]) -> int:
        """Return the transition with ``leaf_map`` applied to each leaf; calls with the same map may share ``memo``."""
        atom, low, high, node = self.atom, self.low, self.high, self.node

        def rebuild(n: int) -> int:
            result = memo.get(n)
            if result is None:
                a = atom[n]
                result = leaf_map(n) if a == LEAF else node(a, rebuild(low[n]), rebuild(high[n]))
                memo[n] = result
            return result

        return rebuild(transition)

    def leaves(self, *transitions: int) -> list[int]:
        """Return the distinct leaves of transitions, left to right."""
        atom, low, high = self.atom, self.low, self.high
        leaves: list[int] = []
        stack = list(dict.fromkeys(reversed(transitions)))
        seen = set(stack)
        while stack:
            n = stack.pop()
            if atom[n] == LEAF:
                leaves.append(n)
                continue
            for child in (high[n], low[n]):
                if child not in seen:
                    seen.add(child)
                    stack.append(child)
        return leaves
