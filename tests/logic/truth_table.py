"""The truth of formulas on all short traces at once, by the definitions, with one bit for each trace.

:mod:`tests.logic.test_oracle` compares it with the oracle.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.logic.formula import Formula
from tltlc.logic.oracle import all_traces

Column = list[int]
"""One integer for each position in traces of one length; bit k is the truth on the k-th trace."""


class TruthTable:
    """The truth of formulas on every trace over ``atoms`` of 1 to ``max_length`` samples.

    Two formulas have equal rows if and only if they agree on these traces.
    """

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
        """Return the truth at the first position, as one integer for each length."""
        return tuple(column[0] for column in self._columns(formula))

    def all_positions(self, formula: Formula) -> tuple[tuple[int, ...], ...]:
        """Return the truth at every position of every trace."""
        return tuple(tuple(column) for column in self._columns(formula))

    def implies(self, premise: Formula, conclusion: Formula) -> bool:
        """Whether every trace of the table that satisfies the premise satisfies the conclusion."""
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
        n, mask = k + 1, (1 << len(self._lengths[k])) - 1
        if node.op == "atom":
            return self._atoms[node.name][k]
        column = [0] * n
        for i in reversed(range(n)):
            now = [operand[i] for operand in operands]
            following = [operand[i + 1] if i + 1 < n else None for operand in operands]
            rest = column[i + 1] if i + 1 < n else None
            column[i] = _bits(node.op, now, following, rest, mask)
        return column


def _bits(op: str, now: list[int], following: list[int | None], rest: int | None, mask: int) -> int:
    """Return the truth of a formula at a position.

    ``now`` and ``following`` are the operands' truth at this position and at the next one; ``rest`` is the formula's
    own truth at the next position.
    """
    match op:
        case "true":
            return mask
        case "false":
            return 0
        case "not":
            return mask & ~now[0]
        case "and":
            result = mask
            for bits in now:
                result &= bits
            return result
        case "or":
            result = 0
            for bits in now:
                result |= bits
            return result
        case "implies":
            return mask & ~now[0] | now[1]
        case "iff":
            return mask & ~(now[0] ^ now[1])
        case "X":
            return 0 if following[0] is None else following[0]
        case "N":
            return mask if following[0] is None else following[0]
        case "F":
            return now[0] | (rest or 0)
        case "G":
            return now[0] & (mask if rest is None else rest)
        case "U":
            return now[1] | now[0] & (rest or 0)
        case "W":
            return now[1] | now[0] & (mask if rest is None else rest)
        case "R":
            return now[1] & (now[0] | (mask if rest is None else rest))
        case "M":
            return now[1] & (now[0] | (rest or 0))
    raise AssertionError(op)
