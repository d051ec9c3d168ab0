"""What formulas say of all short traces at once, straight from the definitions: a number has a bit for each trace."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import cached_property
from itertools import chain, combinations
from typing import Final

from tltlc.logic.formula import Formula

LONGEST: Final = 5
Bits = tuple[int, ...]
"""For each length from 1 on, the traces of that length for which something is true."""


class Traces:
    """All traces of 1 to ``LONGEST`` samples; a letter is the set of the atoms that hold."""

    def __init__(self, letters: Sequence[Collection[str]]) -> None:
        self.letters = letters

    @cached_property
    def every(self) -> Bits:
        """All traces."""
        return tuple((1 << len(self.letters) ** length) - 1 for length in range(1, LONGEST + 1))

    def satisfying(self, formula: Formula) -> Bits:
        """Those that satisfy the formula."""
        return tuple(self._truths(formula, length)[0] for length in range(1, LONGEST + 1))

    def ever(self, formula: Formula, without: Collection[Formula] = ()) -> Bits:
        """Those at some step of which the formula holds, and none of the others does."""
        found = []
        for length in range(1, LONGEST + 1):
            steps = self._truths(formula, length)
            for other in without:
                steps = [here & ~there for here, there in zip(steps, self._truths(other, length), strict=True)]
            found.append(_any(steps))
        return tuple(found)

    def _truths(self, formula: Formula, length: int) -> list[int]:
        """For each step the traces of this length on which the formula holds from there on."""
        every = self.every[length - 1]
        truths: dict[Formula, list[int]] = {}
        for node in formula.bottom_up():
            args = [truths[each] for each in node.args]
            if node.op == "atom":
                truths[node] = [self._atom(node.name, step, length) for step in range(length)]
            elif node.is_temporal:
                truths[node] = _from_the_end(node.op, args, every)
            else:
                columns = zip(*args, strict=True) if args else [()] * length
                truths[node] = [_now(node.op, column, every) for column in columns]
        return truths[formula]

    def _atom(self, name: str, step: int, length: int) -> int:
        """The letter of a trace at a step is the digit there of its number, whose base is the number of letters."""
        count = len(self.letters)
        digits = "".join(("1" if name in letter else "0") * count**step for letter in self.letters)
        return int((digits * count ** (length - 1 - step))[::-1], 2)


def subsets(atoms: Sequence[str]) -> list[frozenset[str]]:
    """Every letter over some atoms."""
    return [frozenset(each) for each in chain(*(combinations(atoms, size) for size in range(len(atoms) + 1)))]


def includes(more: Bits, fewer: Bits) -> bool:
    """Whether the one has all traces of the other."""
    return all(not few & ~many for many, few in zip(more, fewer, strict=True))


def both(one: Bits, other: Bits) -> Bits:
    """The traces that are in the one and in the other."""
    return tuple(mine & yours for mine, yours in zip(one, other, strict=True))


def _any(steps: Sequence[int]) -> int:
    found = 0
    for step in steps:
        found |= step
    return found


def _now(op: str, args: Sequence[int], every: int) -> int:
    if op in ("true", "false"):
        return every if op == "true" else 0
    if op == "or":
        return _any(args)
    if op == "and":
        return every & ~_any([every & ~each for each in args])
    first, last = args[0], args[-1]
    if op == "not":
        return every & ~first
    return every & (~first | last) if op == "implies" else every & ~(first ^ last)


def _from_the_end(op: str, args: Sequence[Sequence[int]], every: int) -> list[int]:
    """The truths of a temporal operator, from those of the step behind; behind the last one weak ones hold."""
    behind = every if op in ("N", "G", "W", "R") else 0
    found: list[int] = []
    for step in reversed(range(len(args[0]))):
        first, last = args[0][step], args[-1][step]
        here = {
            "F": first | behind,
            "G": first & behind,
            "U": last | (first & behind),
            "W": last | (first & behind),
            "R": last & (first | behind),
            "M": last & (first | behind),
        }.get(op, behind)
        found.append(here)
        behind = first if op in ("X", "N") else here
    return found[::-1]
