"""The meaning of formulas over a trace on a clock that varies, straight from the definitions.

As in :mod:`tests.memory.definition`, there is no running state: every bound looks at the times of all samples.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cache
from itertools import accumulate
from math import inf

from tests.memory.definition import TINY, Definition, exact
from tests.memory.names import COUNTS, NOWHERE, TIMES, Scope
from tltlc.grammar import tree
from tltlc.grammar.module import Module
from tltlc.grammar.tree import BinaryExpr, Expr, TemporalInterval, Unary


class TimedDefinition(Definition):
    """The meaning of the formulas of a module with ``clock varies``, on a finite trace.

    ``lengths_s`` has the length of each sample in seconds.
    """

    def __init__(
        self,
        module: Module,
        trace: Sequence[Mapping[str, float]],
        lengths_s: Sequence[float],
        params: Mapping[str, float],
    ) -> None:
        super().__init__(module, trace, params)
        self._times_s = [[*accumulate(lengths_s[i + 1 :], initial=0.0)] for i in range(len(trace))]

    def clause_holds(self, clause: tree.Clause, end: int) -> bool:
        """Whether the trace, cut off before the position ``end``, meets a clause that asks for something."""
        assert not isinstance(clause.value, tuple), "a clause with a formula"
        at = (self.holds(clause.value, j, end=end) for j in range(end))
        if clause.kind == "require":
            return next(at)
        return any(at) if clause.kind == "reach" else all(at) if clause.kind == "keep" else not any(at)

    def _time_s(self, i: int, j: int) -> float:
        """Return the time from sample i to sample j, which is not earlier."""
        return self._times_s[i][j - i]

    def _holds(self, expr: Expr, i: int, scope: Scope, n: int) -> bool:
        expr, scope = self.expanded(expr, scope, predicates=False)
        if isinstance(expr, BinaryExpr) and expr.op == "then":
            return any(self._begins(expr, j, scope, n) for j in range(i, n))
        if isinstance(expr, BinaryExpr) and expr.op == "within":
            if not self.holds(expr.left, i, scope, n):
                return True
            within_s = _seconds(expr.bound)
            return any(self.holds(expr.right, j, scope, n) and self._time_s(i, j) <= within_s for j in range(i, n))
        return super()._holds(expr, i, scope, n)

    def _begins(self, expr: Expr, i: int, scope: Scope, n: int) -> bool:
        """Whether a sequence ``a then within T b then c`` begins at a position, with its a."""
        if not isinstance(expr, BinaryExpr) or expr.op != "then":
            return self.holds(expr, i, scope, n)
        within_s = inf if expr.bound is None else _seconds(expr.bound)
        return self.holds(expr.left, i, scope, n) and any(
            self._time_s(i, j) <= within_s and self._begins(expr.right, j, scope, n) for j in range(i + 1, n)
        )

    def _future_holds(self, expr: Unary, i: int, scope: Scope, n: int) -> bool:
        if expr.bound is None:
            return super()._future_holds(expr, i, scope, n)
        bound_s, rest = _seconds(expr.bound), range(i, n)
        if expr.op == "F":
            return any(self.holds(expr.operand, j, scope, n) for j in rest if self._time_s(i, j) <= bound_s)
        return all(self.holds(expr.operand, j, scope, n) for j in rest if self._time_s(i, j) < bound_s)

    def _window(self, expr: Unary, i: int, scope: Scope) -> float:
        bound_s, so_far = _seconds(expr.bound), range(i + 1)
        operand = [self.robustness(expr.operand, j, scope) > 0 for j in so_far]
        if expr.op == "once":
            holds = any(operand[j] for j in so_far if self._time_s(j, i) <= bound_s)
        else:
            holds = all(operand[j] for j in so_far if self._time_s(j, i) < bound_s)
        decisive = [j for j in so_far if operand[j] == (expr.op == "once")]
        time_s = min(self._time_s(decisive[-1], i), 2 * bound_s) if decisive else 2 * bound_s
        margin = (bound_s - time_s) / bound_s if expr.op == "once" else (time_s - bound_s) / bound_s
        return TINY if holds and margin == 0 else margin

    def _recalled(self, name: str, parts: list[Expr], i: int, scope: Scope) -> float:
        if name not in TIMES:
            return super()._recalled(name, parts, i, scope)
        truth = [self.robustness(parts[0], j, scope) > 0 for j in range(i + 1)]
        if name == "time_since":
            j = max((j for j in range(i + 1) if truth[j]), default=None)
            time_s = inf if j is None else self._time_s(j, i)
        elif name in ("total_time", "total_time_since"):
            events = [j for j in range(i + 1) if name == "total_time_since" and self.robustness(parts[1], j, scope) > 0]
            time_s = sum(self._time_s(j - 1, j) for j in range(max([1, *events]), i + 1) if truth[j])
        else:
            time_s = self._time_s(min((j for j in range(i + 1) if all(truth[j:])), default=i), i)
        return min(time_s, self._written_maximum(name, parts, scope))

    def _is_inside(self, length: Expr, j: int, i: int) -> bool:
        assert isinstance(length, tree.NumberExpr)
        return self._time_s(j, i) <= float(exact(length))

    def _maximum(self, value: Fraction, name: str) -> float:
        return super()._maximum(value, name) if name in COUNTS else float(value)


class EndlessDefinition(TimedDefinition):
    """The meaning of formulas on an infinite trace whose last sample repeats for ever, with its length.

    The sample is in ``trace`` often enough that the past no longer changes at the last two positions.
    """

    def holds(self, expr: Expr, i: int = 0, scope: Scope = NOWHERE, end: int | None = None) -> bool:
        """Whether a formula holds at a position: the last one is like the one before it, which has a next one."""
        return super().holds(expr, min(i, len(self.trace) - 2), scope, end)


@cache
def _seconds(bound: TemporalInterval | None) -> float:
    assert bound is not None, "a bound"
    return float(exact(bound.high))
