"""Evaluate formulas on all short traces at once, straight from the definitions.

A set of traces is a number with one bit for each trace."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import cached_property
from itertools import chain, combinations
from typing import Final

from tltlc.logic.formula import Formula

LONGEST: Final = 5
Bits = tuple[int, ...]
"""A set of traces: for each length from 1 to ``LONGEST``, the bits of the traces of that length."""


class Traces:
    """All traces of 1 to ``LONGEST`` samples; a letter is the set of the atoms that hold."""

    def __init__(self, letters: Sequence[Collection[str]]) -> None:
        self.letters = letters

    @cached_property
    def all_traces(self) -> Bits:
        """The bits of all traces."""
        return tuple((1 << len(self.letters) ** length) - 1 for length in range(1, LONGEST + 1))

    def satisfying(self, formula: Formula) -> Bits:
        """Return the traces that satisfy the formula."""
        return tuple(self._truths(formula, length)[0] for length in range(1, LONGEST + 1))

    def holding_at_some_step(self, formula: Formula, without: Collection[Formula] = ()) -> Bits:
        """Return the traces with a step at which the formula holds and no formula of ``without`` does."""
        traces = []
        for length in range(1, LONGEST + 1):
            steps = self._truths(formula, length)
            for excluded in without:
                steps = [here & ~there for here, there in zip(steps, self._truths(excluded, length), strict=True)]
            traces.append(_union(steps))
        return tuple(traces)

    def _truths(self, formula: Formula, length: int) -> list[int]:
        """Return, for each step, the traces of this length whose suffix from that step satisfies the
        formula."""
        every = self.all_traces[length - 1]
        truths: dict[Formula, list[int]] = {}
        for node in formula.bottom_up():
            args = [truths[argument] for argument in node.args]
            if node.op == "atom":
                truths[node] = [self._atom(node.name, step, length) for step in range(length)]
            elif node.is_temporal:
                truths[node] = _temporal_operator(node.op, args, every)
            else:
                columns = zip(*args, strict=True) if args else [()] * length
                truths[node] = [_boolean_operator(node.op, column, every) for column in columns]
        return truths[formula]

    def _atom(self, name: str, step: int, length: int) -> int:
        """Return the traces of this length in which the atom holds at a step.

        The bit of a trace is a number whose digits are the letters of the trace, in base
        ``len(self.letters)``, the first step last.
        """
        count = len(self.letters)
        digits = "".join(("1" if name in letter else "0") * count**step for letter in self.letters)
        return int((digits * count ** (length - 1 - step))[::-1], 2)


def subsets(atoms: Sequence[str]) -> list[frozenset[str]]:
    """Return every letter over some atoms."""
    return [
        frozenset(combination) for combination in chain(*(combinations(atoms, size) for size in range(len(atoms) + 1)))
    ]


def includes(more: Bits, fewer: Bits) -> bool:
    """Whether ``more`` contains all traces of ``fewer``."""
    return all(not few & ~many for many, few in zip(more, fewer, strict=True))


def intersection(one: Bits, other: Bits) -> Bits:
    """Return the traces that are in both sets."""
    return tuple(first & second for first, second in zip(one, other, strict=True))


def _union(steps: Sequence[int]) -> int:
    union = 0
    for step in steps:
        union |= step
    return union


def _boolean_operator(op: str, args: Sequence[int], every: int) -> int:
    if op in ("true", "false"):
        return every if op == "true" else 0
    if op == "or":
        return _union(args)
    if op == "and":
        return every & ~_union([every & ~arg for arg in args])
    first, last = args[0], args[-1]
    if op == "not":
        return every & ~first
    return every & (~first | last) if op == "implies" else every & ~(first ^ last)


def _temporal_operator(op: str, args: Sequence[Sequence[int]], every: int) -> list[int]:
    """Return the traces that satisfy a temporal operator, for each step; computed from the last step.

    After the last step, the weak operators are true and the strong operators are false.
    """
    behind = every if op in ("N", "G", "W", "R") else 0
    truths: list[int] = []
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
        truths.append(here)
        behind = first if op in ("X", "N") else here
    return truths[::-1]
