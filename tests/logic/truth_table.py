"""The truth of formulas on all short traces at once: as slow definitions allow, but a bit for each trace.

:mod:`tests.logic.test_oracle` compares it with the oracle.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.logic.formula import Formula
from tltlc.logic.oracle import all_traces

Column = list[int]
"""For each position of the traces of one length an integer; bit k is the truth on the k-th trace."""


class TruthTable:
    """Truth on every trace over ``atoms`` of 1 to ``max_length`` samples: equal tables, equal meaning there."""

    def __init__(self, atoms: Sequence[str], max_length: int) -> None:
        traces = list(all_traces(atoms, max_length))
        self._lengths = [[t for t in traces if len(t) == n] for n in range(1, max_length + 1)]
        self._atoms = {
            name: [
                [sum(1 << k for k, trace in enumerate(group) if name in trace[i]) for i in range(len(group[0]))]
                for group in self._lengths
            ]
            for name in atoms
        }
        self._known: dict[Formula, list[Column]] = {}

    def of(self, formula: Formula) -> tuple[int, ...]:
        """The truth at the first position, an integer for each length."""
        return tuple(column[0] for column in self._columns(formula))

    def all_positions(self, formula: Formula) -> tuple[tuple[int, ...], ...]:
        """The truth at every position of every trace."""
        return tuple(tuple(column) for column in self._columns(formula))

    def implies(self, premise: Formula, conclusion: Formula) -> bool:
        """Whether each trace in the table that has the one has the other."""
        return not any(p & ~q for p, q in zip(self.of(premise), self.of(conclusion), strict=True))

    def _columns(self, formula: Formula) -> list[Column]:
        known = self._known
        for node in formula.bottom_up():
            if node not in known:
                known[node] = [
                    self._column(node, [known[argument][k] for argument in node.args], k)
                    for k in range(len(self._lengths))
                ]
        return known[formula]

    def _column(self, node: Formula, operands: list[Column], k: int) -> Column:
        n, every = k + 1, (1 << len(self._lengths[k])) - 1
        if node.op == "atom":
            return self._atoms[node.name][k]
        column = [0] * n
        for i in reversed(range(n)):
            now = [operand[i] for operand in operands]
            following = [operand[i + 1] if i + 1 < n else None for operand in operands]
            rest = column[i + 1] if i + 1 < n else None
            column[i] = _bits(node.op, now, following, rest, every)
        return column


def _bits(op: str, now: list[int], following: list[int | None], rest: int | None, every: int) -> int:
    """Truth at a position from the operands' truth there and at the next one, and the formula's own at the next one."""
    match op:
        case "true":
            return every
        case "false":
            return 0
        case "not":
            return every & ~now[0]
        case "and":
            result = every
            for bits in now:
                result &= bits
            return result
        case "or":
            result = 0
            for bits in now:
                result |= bits
            return result
        case "implies":
            return every & ~now[0] | now[1]
        case "iff":
            return every & ~(now[0] ^ now[1])
        case "X":
            return 0 if following[0] is None else following[0]
        case "N":
            return every if following[0] is None else following[0]
        case "F":
            return now[0] | (rest or 0)
        case "G":
            return now[0] & (every if rest is None else rest)
        case "U":
            return now[1] | now[0] & (rest or 0)
        case "W":
            return now[1] | now[0] & (every if rest is None else rest)
        case "R":
            return now[1] & (now[0] | (every if rest is None else rest))
        case "M":
            return now[1] & (now[0] | (rest or 0))
    raise AssertionError(op)
