"""Functions of a letter as hash-consed decision diagrams, whose leaves are hashable values.

A node is an int; inner nodes test an atom by its index, in order.  No operation enumerates letters.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from typing import Any, Final, Generic, TypeVar

from tltlc.automaton.work import Work

Leaf = TypeVar("Leaf", bound=Hashable)

LEAF: Final = 1 << 40
"""The ``atom`` of a leaf, greater than every atom's index."""


class Letters(Generic[Leaf]):
    """A table of nodes: ``atom[n]``, ``low[n]`` and ``high[n]`` describe node ``n``; ``value[n]`` is a leaf's value.

    New inner nodes count as work.  Operations raise
    :class:`~tltlc.automaton.work.OutOfWork` if no work is left.
    """

    __slots__ = ("_leaves", "_nodes", "atom", "high", "low", "value", "work")

    def __init__(self, work: Work) -> None:
        self.atom: list[int] = []
        self.low: list[int] = []
        self.high: list[int] = []
        self.value: list[Any] = []
        self._nodes: dict[tuple[int, int, int], int] = {}
        self._leaves: dict[Leaf, int] = {}
        self.work = work

    def leaf(self, value: Leaf) -> int:
        """Return the function that has one value on every letter."""
        node = self._leaves.get(value)
        if node is None:
            node = self._leaves[value] = self._add(LEAF, -1, -1, value)
        return node

    def node(self, atom: int, low: int, high: int) -> int:
        """Return the function ``high`` on letters with the atom, ``low`` on the others."""
        if low == high:
            return low
        key = (atom, low, high)
        number = self._nodes.get(key)
        if number is None:
            self.work.spend()
            number = self._nodes[key] = self._add(atom, low, high, None)
        return number

    def _add(self, atom: int, low: int, high: int, value: Leaf | None) -> int:
        self.atom.append(atom)
        self.low.append(low)
        self.high.append(high)
        self.value.append(value)
        return len(self.atom) - 1

    def combined(self, combine: Callable[[Any, Any], Leaf], x: int, y: int, memo: dict[tuple[int, int], int]) -> int:
        """Return the function that combines the values of x and y on each letter.

        Calls with the same ``combine`` may share ``memo``.
        """
        result = memo.get((x, y))
        if result is not None:
            return result
        atom = self.atom
        ax, ay = atom[x], atom[y]
        if ax == ay == LEAF:
            result = self.leaf(combine(self.value[x], self.value[y]))
        else:
            self.work.spend()
            first = min(ax, ay)
            low_x, high_x = (self.low[x], self.high[x]) if ax == first else (x, x)
            low_y, high_y = (self.low[y], self.high[y]) if ay == first else (y, y)
            low, high = self.combined(combine, low_x, low_y, memo), self.combined(combine, high_x, high_y, memo)
            result = self.node(first, low, high)
        memo[x, y] = result
        return result

    def mapped(self, change: Callable[[Any], Leaf], x: int, memo: dict[int, int]) -> int:
        """Return the function with ``change`` applied to every value; calls with the same
        ``change`` may share ``memo``.
        """
        result = memo.get(x)
        if result is None:
            if self.atom[x] == LEAF:
                result = self.leaf(change(self.value[x]))
            else:
                low, high = self.mapped(change, self.low[x], memo), self.mapped(change, self.high[x], memo)
                result = self.node(self.atom[x], low, high)
            memo[x] = result
        return result

    def values(self, x: int) -> list[Any]:
        """Return the distinct values of a function, left to right."""
        values = []
        stack, seen = [x], {x}
        while stack:
            n = stack.pop()
            if self.atom[n] == LEAF:
                values.append(self.value[n])
                continue
            for child in (self.high[n], self.low[n]):
                if child not in seen:
                    seen.add(child)
                    stack.append(child)
        return values

    def letter_with(self, x: int, value: Leaf) -> frozenset[int]:
        """Return the atoms of some letter on which a function has a value; raises ValueError if there is none."""
        stack: list[tuple[int, tuple[int, ...]]] = [(x, ())]
        seen = {x}
        while stack:
            n, holding = stack.pop()
            if self.atom[n] == LEAF:
                if self.value[n] == value:
                    return frozenset(holding)
                continue
            for child, extended in ((self.high[n], (*holding, self.atom[n])), (self.low[n], holding)):
                if child not in seen:
                    seen.add(child)
                    stack.append((child, extended))
        raise ValueError(f"no letter has the value {value!r}")

    def at(self, x: int, letter: Callable[[int], bool]) -> Any:
        """Return the value on a letter; ``letter`` returns for an atom's index whether the atom holds."""
        while self.atom[x] != LEAF:
            x = self.high[x] if letter(self.atom[x]) else self.low[x]
        return self.value[x]


def at_most_one(letters: Letters[Any], groups: Iterable[Sequence[int]], yes: Hashable, no: Hashable) -> int:
    """Return the function that is ``yes`` on letters with at most one atom of each group, ``no`` on the others."""
    always, never = letters.leaf(yes), letters.leaf(no)
    allowed = always
    for group in groups:
        none, one = always, always
        for atom in sorted(set(group), reverse=True):
            one = letters.node(atom, one, none)
            none = letters.node(atom, none, never)
        allowed = letters.combined(lambda x, y: y if x == yes else no, allowed, one, {})
    return allowed
