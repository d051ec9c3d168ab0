"""Functions of a letter as hash-consed decision diagrams, whose leaves are any values that can be compared.

A node is an int; inner nodes test an atom by its index, in order.  No operation enumerates letters.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from typing import Any, Final, Generic, TypeVar

from tltlc.automaton.infinite.work import Work

Leaf = TypeVar("Leaf", bound=Hashable)

LEAF: Final = 1 << 40
"""The ``atom`` of a leaf: greater than every index of an atom."""


class Letters(Generic[Leaf]):
    """A table of nodes: ``atom[n]``, ``low[n]`` and ``high[n]`` describe node ``n``, ``value[n]`` a leaf's value.

    New nodes are counted as work; operations raise :class:`~tltlc.automaton.infinite.work.OutOfWork` where none is
    left.
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
        """The function that has one value on every letter."""
        found = self._leaves.get(value)
        if found is None:
            found = self._leaves[value] = self._add(LEAF, -1, -1, value)
        return found

    def node(self, atom: int, low: int, high: int) -> int:
        """The function ``high`` on letters with the atom, ``low`` on the others."""
        if low == high:
            return low
        key = (atom, low, high)
        found = self._nodes.get(key)
        if found is None:
            self.work.spend()
            found = self._nodes[key] = self._add(atom, low, high, None)
        return found

    def _add(self, atom: int, low: int, high: int, value: Leaf | None) -> int:
        self.atom.append(atom)
        self.low.append(low)
        self.high.append(high)
        self.value.append(value)
        return len(self.atom) - 1

    def combined(self, combine: Callable[[Any, Any], Leaf], x: int, y: int, memo: dict[tuple[int, int], int]) -> int:
        """The function of both values on each letter; ``memo`` may be shared by calls with the same ``combine``."""
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
        """The function with every value changed; ``memo`` may be shared by calls with the same ``change``."""
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
        """The distinct values of a function, left to right."""
        found = []
        stack, seen = [x], {x}
        while stack:
            n = stack.pop()
            if self.atom[n] == LEAF:
                found.append(self.value[n])
                continue
            for child in (self.high[n], self.low[n]):
                if child not in seen:
                    seen.add(child)
                    stack.append(child)
        return found

    def letter_with(self, x: int, value: Leaf) -> frozenset[int]:
        """The atoms that hold in some letter on which a function has a value; ValueError where it never has it."""
        stack: list[tuple[int, tuple[int, ...]]] = [(x, ())]
        seen = {x}
        while stack:
            n, holding = stack.pop()
            if self.atom[n] == LEAF:
                if self.value[n] == value:
                    return frozenset(holding)
                continue
            for child, there in ((self.high[n], (*holding, self.atom[n])), (self.low[n], holding)):
                if child not in seen:
                    seen.add(child)
                    stack.append((child, there))
        raise ValueError(f"no letter has the value {value!r}")

    def at(self, x: int, letter: Callable[[int], bool]) -> Any:
        """The value on a letter, which says of an atom's index whether it holds."""
        while self.atom[x] != LEAF:
            x = self.high[x] if letter(self.atom[x]) else self.low[x]
        return self.value[x]


def at_most_one(letters: Letters[Any], groups: Iterable[Sequence[int]], yes: Hashable, no: Hashable) -> int:
    """``yes`` on letters in which at most one atom of each group holds, ``no`` on the others."""
    always, never = letters.leaf(yes), letters.leaf(no)
    allowed = always
    for group in groups:
        none, one = always, always
        for atom in sorted(set(group), reverse=True):
            one = letters.node(atom, one, none)
            none = letters.node(atom, none, never)
        allowed = letters.combined(lambda x, y: y if x == yes else no, allowed, one, {})
    return allowed
