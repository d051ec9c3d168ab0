"""The meaning of formulas over a trace, straight from the definitions: loops over positions, no running state.

Formulas are syntax trees, and a sample maps the names of signals to numbers. Past operators, counts and
times look at all samples up to their own; future operators at all samples from their own to the end.
Nothing is taken from the compiler but the parser.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cache
from itertools import pairwise
from math import ceil, exp, inf, sqrt, tanh
from typing import Any, Final

from tests.memory.names import COUNTS, MEMORY, NOWHERE, TIMES, WITH_EVENT, Names, Scope
from tltlc.core.source import SourceFile
from tltlc.grammar import tree
from tltlc.grammar.module import Module
from tltlc.grammar.parser import parse_formula
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, GroupExpr, NameExpr, NumberExpr, Quantified, Unary

TINY: Final = 1e-30
"""The least robustness of a negation that is true."""

_UNITS: Final = {"s": "1", "ms": "0.001", "min": "60", "h": "3600", "m": "1", "cm": "0.01", "km": "1000", "%": "0.01"}
_COMPARISONS: Final = ("<", "<=", ">", ">=", "==", "!=")
_CONNECTIVES: Final = ("not", "and", "or", "implies", "iff")

Range = tuple[float, float]


@cache
def exact(number: NumberExpr) -> Fraction:
    """Return a number with its unit, in SI units."""
    return Fraction(repr(number.value)) * Fraction(_UNITS.get(number.unit or "", "1"))


def formula(text: str) -> Expr:
    """Return the syntax tree of a formula."""
    expr, diagnostics = parse_formula(SourceFile("<formula>", text))
    assert expr is not None and not diagnostics, text
    return expr


class Definition(Names):
    """The meaning of the formulas of a module on a finite trace.

    A sample has every signal by its full name, such as ``d(a)``. Positions count from 0. Results are kept
    by the identity of an expression, so expressions must live as long as the definition.
    """

    def __init__(self, module: Module, trace: Sequence[Mapping[str, float]], params: Mapping[str, float]) -> None:
        self.trace = trace
        super().__init__(module)
        self._period: Fraction | None = None
        self._params = params
        self._known: dict[Any, Any] = {}
        for declaration in module.declarations:
            if isinstance(declaration, tree.ClockDecl) and declaration.value is not None:
                unit, value = declaration.value.unit, declaration.value
                self._period = 1 / Fraction(repr(value.value)) if unit == "Hz" else exact(value)

    # --- truth --------------------------------------------------------------------------------------

    def holds(self, expr: Expr, i: int = 0, scope: Scope = NOWHERE, end: int | None = None) -> bool:
        """Whether a formula holds at a position of the trace, which ends before the position ``end``."""
        n = len(self.trace) if end is None else end
        key = ("holds", id(expr), i, id(scope), n)
        if key not in self._known:
            self._known[key] = self._holds(expr, i, scope, n)
        return bool(self._known[key])

    def _holds(self, expr: Expr, i: int, scope: Scope, n: int) -> bool:
        expr, scope = self.expanded(expr, scope, predicates=False)
        if isinstance(expr, Unary) and expr.op in "FGXN":
            return self._future_holds(expr, i, scope, n)
        if isinstance(expr, Unary) and expr.op == "not":
            return not self.holds(expr.operand, i, scope, n)
        if isinstance(expr, BinaryExpr) and expr.op in _CONNECTIVES:
            a, b = self.holds(expr.left, i, scope, n), self.holds(expr.right, i, scope, n)
            return {"and": a and b, "or": a or b, "implies": not a or b, "iff": a == b}[expr.op]
        if isinstance(expr, BinaryExpr) and expr.op in ("U", "W", "R", "M"):
            a_at, b_at = (
                [self.holds(side, j, scope, n) if j >= i else False for j in range(n)]
                for side in (expr.left, expr.right)
            )
            rest = range(i, n)
            if expr.op == "U":
                return any(b_at[j] and all(a_at[i:j]) for j in rest)
            if expr.op == "W":
                return any(b_at[j] and all(a_at[i:j]) for j in rest) or all(a_at[i:])
            if expr.op == "M":
                return any(a_at[j] and all(b_at[i : j + 1]) for j in rest)
            return any(a_at[j] and all(b_at[i : j + 1]) for j in rest) or all(b_at[i:])
        if isinstance(expr, Quantified):
            return (all if expr.all else any)(self.holds(expr.body, i, inside, n) for inside in self.each(expr, scope))
        return self.robustness(expr, i, scope) > 0

    def _future_holds(self, expr: Unary, i: int, scope: Scope, n: int) -> bool:
        first, last = i, n - 1
        if expr.op in ("X", "N"):
            return self.holds(expr.operand, i + 1, scope, n) if i + 1 < n else expr.op == "N"
        if expr.bound is not None:
            low, high = expr.bound.low, self._steps(expr.bound.high)
            if low is None:
                last = min(last, i + (high if expr.op == "F" else high - 1))
            else:
                first, last = i + self._steps(low), min(last, i + high)
        # Past the end of the trace, nothing is met and nothing is broken.
        values = (self.holds(expr.operand, j, scope, n) for j in range(first, last + 1))
        return any(values) if expr.op == "F" else all(values)

    # --- robustness ---------------------------------------------------------------------------------

    def robustness(self, expr: Expr, i: int, scope: Scope = NOWHERE, positive: bool = True) -> float:
        """Return the robustness of a formula about the trace up to a position, or of its negation."""
        key = ("robustness", id(expr), i, id(scope), positive)
        if key not in self._known:
            self._known[key] = self._robustness(expr, i, scope, positive)
        return float(self._known[key])

    def _robustness(self, expr: Expr, i: int, scope: Scope, positive: bool) -> float:
        expr, scope = self.expanded(expr, scope, predicates=False)

        def value(part: Expr, sign: bool, inside: Scope = scope) -> float:
            return self.robustness(part, i, inside, sign == positive)

        most, least = (max, min) if positive else (min, max)
        if isinstance(expr, tree.Constant):
            return 1.0 if expr.value == positive else -1.0
        if isinstance(expr, Unary) and expr.op == "not":
            return value(expr.operand, False)
        if isinstance(expr, BinaryExpr) and expr.op in _CONNECTIVES:
            left, right = expr.left, expr.right
            if expr.op == "and":
                return least(value(left, True), value(right, True))
            if expr.op == "or":
                return most(value(left, True), value(right, True))
            forth = most(value(left, False), value(right, True))
            if expr.op == "implies":
                return forth
            return least(forth, most(value(left, True), value(right, False)))
        if isinstance(expr, Quantified):
            return (least if expr.all else most)(value(expr.body, True, inside) for inside in self.each(expr, scope))
        if isinstance(expr, Unary) and expr.op in ("begins", "ends"):
            before = self._before(expr.operand, i, scope)
            if expr.op == "begins":
                return least(value(expr.operand, True), _signed(before, not positive))
            return least(value(expr.operand, False), _signed(before, positive))
        if isinstance(expr, BinaryExpr) and expr.op in ("<=", ">=", "!="):
            return _signed(self._comparison(expr, i, scope), not positive)
        return _signed(self._atom(expr, i, scope), positive)

    def _before(self, expr: Expr, i: int, scope: Scope) -> float:
        return self.robustness(expr, i - 1, scope) if i > 0 else -1.0

    def _atom(self, expr: Expr, i: int, scope: Scope) -> float:
        """Return the value of what the compiler makes an atom of: its robustness, in [-1, 1]."""
        so_far = range(i + 1)
        if isinstance(expr, Unary) and expr.bound is not None:
            return self._window(expr, i, scope)
        if isinstance(expr, Unary) and expr.op == "once":
            return max(self.robustness(expr.operand, j, scope) for j in so_far)
        if isinstance(expr, Unary) and expr.op == "historically":
            return min(self.robustness(expr.operand, j, scope) for j in so_far)
        if isinstance(expr, Unary) and expr.op == "previously":
            return self._before(expr.operand, i, scope)
        if isinstance(expr, BinaryExpr) and expr.op == "since":
            return max(
                min(
                    self.robustness(expr.right, k, scope),
                    *(self.robustness(expr.left, j, scope) for j in range(k + 1, i + 1)),
                    1.0,
                )
                for k in so_far
            )
        if isinstance(expr, BinaryExpr) and expr.op in _COMPARISONS:
            return self._comparison(expr, i, scope)
        if isinstance(expr, CallExpr) and expr.name == "breach":
            # What the compiler makes of ``always p`` beside other such rules: the rule is broken where p is false.
            return self.robustness(expr.arguments[0].value, i, scope, positive=False)
        if self.is_bool(expr, scope):
            return 1.0 if self.number(expr, i, scope) else -1.0
        return min(max(self.number(expr, i, scope), -1.0), 1.0)

    def _window(self, expr: Unary, i: int, scope: Scope) -> float:
        """Return how far the last sample of interest lies from the border of the window, as a share of its length.

        The border lies between the oldest sample that counts and the one before it.
        """
        assert expr.bound is not None, "a window"
        steps = self._steps(expr.bound.high)
        is_once = expr.op == "once"
        border = steps + 0.5 if is_once else steps - 0.5
        decisive = [j for j in range(i + 1) if self.holds(expr.operand, j, scope, len(self.trace)) == is_once]
        age = min(i - decisive[-1], 2 * border) if decisive else 2 * border
        return (border - age) / border if is_once else (age - border) / border

    def _comparison(self, expr: BinaryExpr, i: int, scope: Scope) -> float:
        """Return the robustness of ``x > y``, ``x < y`` or ``x == y``: its margin, as a share of the greatest one.

        The greatest margin is that in the direction of the margin. The margin of ``x == y`` is a half less
        the distance between x and y. For ``x <= y``, ``x >= y`` and ``x != y``, return the robustness of the
        opposite comparison.
        """
        sides = [(expr.left, self._range(expr.left, scope)), (expr.right, self._range(expr.right, scope))]
        # A count or time without a maximum gets twice the greatest value of the other side, and counts one more.
        for this, other in ((0, 1), (1, 0)):
            side, (low, high) = sides[this]
            if high == inf:
                most, kind = max(0.0, sides[other][1][1]), self._open(side, scope)
                sides[this] = side, (low, self._maximum(Fraction(repr(2 * most)) + (kind in COUNTS), kind))
        (left, (left_low, left_high)), (right, (right_low, right_high)) = sides
        a, b = min(self.number(left, i, scope), left_high), min(self.number(right, i, scope), right_high)
        if expr.op in ("==", "!="):
            margin, least = 0.5 - abs(a - b), 0.5 - max(left_high - right_low, right_high - left_low)
            return margin / 0.5 if margin > 0 else margin / -least
        if expr.op in ("<", ">="):
            a, b = b, a
            (left_low, left_high), (right_low, right_high) = (right_low, right_high), (left_low, left_high)
        # Now both stand for `a > b`.
        margin = a - b
        return margin / ((left_high - right_low) if margin > 0 else (right_high - left_low)) if margin else 0.0

    # --- numbers ------------------------------------------------------------------------------------

    def number(self, expr: Expr, i: int, scope: Scope = NOWHERE) -> float:
        """Return the value of arithmetic at a position; a count or time without a maximum may be infinite."""
        key = ("number", id(expr), i, id(scope))
        if key not in self._known:
            self._known[key] = self._number(expr, i, scope)
        return float(self._known[key])

    def _number(self, expr: Expr, i: int, scope: Scope) -> float:
        expr, scope = self.expanded(expr, scope)
        if isinstance(expr, NumberExpr):
            return float(exact(expr))
        if isinstance(expr, Unary):
            return -self.number(expr.operand, i, scope)
        if isinstance(expr, BinaryExpr):
            a, b = self.number(expr.left, i, scope), self.number(expr.right, i, scope)
            return a + b if expr.op == "+" else a - b if expr.op == "-" else a * b if expr.op == "*" else a / b
        if isinstance(expr, tree.WhenExpr):
            for case in expr.cases:
                if self._condition(case.condition, i, scope):
                    return self.number(case.value, i, scope)
            return self.number(expr.otherwise, i, scope)
        assert isinstance(expr, (NameExpr, CallExpr))
        declared = self.declared.get(expr.name)
        if isinstance(declared, tree.SignalDecl):
            low, high = self._range(expr, scope)
            return min(max(float(self.trace[i][self.signal(expr, scope)]), low), high)
        if isinstance(declared, tree.ParamDecl):
            return self._params.get(expr.name, float(self.number(declared.value, i)))
        assert isinstance(expr, CallExpr)
        parts = [argument.value for argument in expr.arguments]
        if expr.name in MEMORY:
            return self._recalled(expr.name, parts, i, scope)
        return float(_FUNCTIONS[expr.name](*(self.number(part, i, scope) for part in parts)))

    def _recalled(self, name: str, parts: list[Expr], i: int, scope: Scope) -> float:
        of, so_far = parts[0], range(i + 1)
        if name == "previous":
            assert not parts[1:] or isinstance(parts[1], NumberExpr)
            back = self._steps(parts[1]) if parts[1:] else 1  # type: ignore[arg-type]
            return self.number(of, max(0, i - back), scope)
        if name in ("highest_within", "lowest_within"):
            assert isinstance(parts[1], NumberExpr)
            near = [self.number(of, j, scope) for j in so_far if i - j <= self._steps(parts[1])]
            return max(near) if name == "highest_within" else min(near)
        if name == "initial":
            return self.number(of, 0, scope)
        if name in ("highest", "lowest"):
            return (max if name == "highest" else min)(self.number(of, j, scope) for j in so_far)
        last = 0
        if name in WITH_EVENT:
            last = max((j for j in so_far if self.holds(parts[1], j, scope, len(self.trace))), default=0)
        if name == "value_at":
            return self.number(of, last, scope)
        if name in ("highest_since", "lowest_since"):
            values = [self.number(of, j, scope) for j in range(last, i + 1)]
            return max(values) if name == "highest_since" else min(values)
        truth = [self.holds(of, j, scope, len(self.trace)) for j in so_far]
        begins = [truth[0], *(now and not before for before, now in pairwise(truth))]
        if name == "times_within":
            found: float = sum(begins[j] for j in so_far if self._is_inside(parts[1], j, i))
        elif name in COUNTS:
            found = sum(begins[last:])
        elif name == "total_time_within":
            assert isinstance(parts[1], NumberExpr)
            found = self._seconds(sum(truth[max(i - self._steps(parts[1]) + 1, 1) :]))
        elif name in ("total_time", "total_time_since"):
            found = self._seconds(sum(truth[max(last, 1) :]))
        elif name == "time_since":
            found = self._seconds(i - max(j for j in so_far if truth[j])) if any(truth) else inf
        else:
            found = self._seconds(max((k for k in so_far if all(truth[i - k :])), default=0))
        return min(found, self._written_maximum(name, parts, scope))

    def _is_inside(self, length: Expr, j: int, i: int) -> bool:
        """Whether position j is at most a time before position i."""
        assert isinstance(length, NumberExpr)
        return i - j <= self._steps(length)

    def _condition(self, expr: Expr, i: int, scope: Scope) -> bool:
        """Whether the condition of a ``when`` holds."""
        expr, scope = self.expanded(expr, scope)
        if isinstance(expr, Unary):
            return not self._condition(expr.operand, i, scope)
        if isinstance(expr, BinaryExpr) and expr.op in ("and", "or"):
            a, b = self._condition(expr.left, i, scope), self._condition(expr.right, i, scope)
            return (a and b) if expr.op == "and" else (a or b)
        if isinstance(expr, BinaryExpr):
            a_, b_ = self.number(expr.left, i, scope), self.number(expr.right, i, scope)
            order = {"<": a_ < b_, "<=": a_ <= b_, ">": a_ > b_, ">=": a_ >= b_}
            return order[expr.op] if expr.op in order else (abs(a_ - b_) < 0.5) == (expr.op == "==")
        return self.number(expr, i, scope) > 0.5

    # --- ranges -------------------------------------------------------------------------------------

    def _range(self, expr: Expr, scope: Scope) -> Range:
        """Return the range of a number; a count or time without a maximum has no upper end."""
        expr, scope = self.expanded(expr, scope, predicates=False)
        if isinstance(expr, NumberExpr):
            return float(exact(expr)), float(exact(expr))
        if isinstance(expr, Unary):
            low, high = self._range(expr.operand, scope)
            return -high, -low
        if isinstance(expr, BinaryExpr):
            (a, b), (c, d) = self._range(expr.left, scope), self._range(expr.right, scope)
            if expr.op in ("+", "-"):
                return (a + c, b + d) if expr.op == "+" else (a - d, b - c)
            ends = [x * y if expr.op == "*" else x / y for x in (a, b) for y in (c, d)]
            return min(ends), max(ends)
        if isinstance(expr, tree.WhenExpr):
            ranges = [self._range(part, scope) for part in (*(case.value for case in expr.cases), expr.otherwise)]
            return min(low for low, _ in ranges), max(high for _, high in ranges)
        assert isinstance(expr, (NameExpr, CallExpr))
        declared = self.declared.get(expr.name)
        if isinstance(declared, tree.SignalDecl) and declared.type == "bool":
            return 0.0, 1.0
        if isinstance(declared, tree.PredicateDecl) and declared.interval is None:
            return -1.0, 1.0
        if isinstance(declared, (tree.SignalDecl, tree.ParamDecl, tree.PredicateDecl)):
            assert declared.interval is not None, "a range"
            return self.number(declared.interval.low, 0), self.number(declared.interval.high, 0)
        assert isinstance(expr, CallExpr)
        parts = [argument.value for argument in expr.arguments]
        if expr.name in (*COUNTS, *TIMES):
            return 0.0, self._written_maximum(expr.name, parts, scope)
        if expr.name in MEMORY:
            return self._range(parts[0], scope)
        ranges = [self._range(part, scope) for part in parts]
        if expr.name == "abs":
            low, high = ranges[0]
            return 0.0 if low <= 0 <= high else min(abs(low), abs(high)), max(abs(low), abs(high))
        function = _FUNCTIONS[expr.name]
        return function(*(low for low, _ in ranges)), function(*(high for _, high in ranges))

    def _open(self, expr: Expr, scope: Scope) -> str:
        """Return the name of the count or time without a maximum that an expression is."""
        expr, _ = self.expanded(expr, scope)
        assert isinstance(expr, CallExpr)
        return expr.name

    def _written_maximum(self, name: str, parts: list[Expr], scope: Scope) -> float:
        if len(parts) == 1 + (name in (*WITH_EVENT, "times_within", "total_time_within")):
            return inf
        limit = parts[-1]
        while isinstance(limit, GroupExpr):
            limit = limit.inner
        assert isinstance(limit, NumberExpr)
        return self._maximum(exact(limit), name)

    def _maximum(self, value: Fraction, name: str) -> float:
        """Return a maximum, rounded up: to a whole count, or to a time of at least one step."""
        if name in COUNTS:
            return float(max(1, ceil(value)))
        assert self._period is not None, "a clock"
        return self._seconds(max(1, ceil(value / self._period)))

    def _seconds(self, steps: int) -> float:
        assert self._period is not None, "a clock"
        return float(steps * self._period)

    def _steps(self, bound: NumberExpr) -> int:
        if bound.unit in (None, "step", "steps"):
            return int(bound.value)
        assert self._period is not None, "a clock"
        return ceil(exact(bound) / self._period)


def _signed(value: float, positive: bool) -> float:
    """Return the robustness of an atom, or of its negation, which is above 0 wherever the atom is false."""
    if positive:
        return value
    return -value if value > 0 else max(-value, TINY)


_FUNCTIONS: Final[dict[str, Callable[..., float]]] = {
    "min": min,
    "max": max,
    "abs": abs,
    "clamp": lambda value, low, high: min(max(value, low), high),
    "sqrt": sqrt,
    "exp": exp,
    "tanh": tanh,
}
