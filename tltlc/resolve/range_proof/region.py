"""Regions of signal and param values, and bounds of expressions on them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import copysign, inf, log1p, sqrt

from tltlc.core.record import record, replace
from tltlc.expression.tree import Const, Expression, Op, ParamValue, SignalValue
from tltlc.resolve.range_proof import interval
from tltlc.resolve.range_proof.cases import Constraint
from tltlc.resolve.range_proof.interval import EVERYTHING, Interval, UndefinedError
from tltlc.resolve.range_proof.work_budget import spend

Variable = SignalValue | ParamValue
Box = Mapping[Variable, Interval]

_ROUNDS = 6
_FAR_AWAY = 1e6


@record
class ConstrainedBox:
    """A region: the points of a box at which certain expressions lie within known bounds.

    ``box`` maps each signal and param to its interval. ``known`` maps expressions to their bounds. The
    expressions in ``nonzero`` are 0 nowhere in the region. A region can be empty although nothing here
    shows it.
    """

    box: Box
    known: Mapping[Expression, Interval]
    nonzero: frozenset[Expression] = frozenset()

    def constrain(self, constraints: Iterable[Constraint]) -> ConstrainedBox | None:
        """Return the part of the region where the constraints hold, with a box as small as can be derived.

        Returns None if this part is provably empty.
        """
        known, nonzero = dict(self.known), set(self.nonzero)
        for constraint in _with_chains(constraints):
            difference = constraint.difference
            known[difference] = interval.intersection(known.get(difference, EVERYTHING), (0.0, inf)) or (0.0, 0.0)
            if isinstance(difference, Op) and difference.op == "-":
                mirrored = Op("-", difference.args[::-1])
                known[mirrored] = interval.negate(known[difference])
                if constraint.strict:
                    nonzero.add(mirrored)
            if constraint.strict:
                nonzero.add(difference)
        return ConstrainedBox(self.box, known, frozenset(nonzero)).narrow()

    def narrow(self) -> ConstrainedBox | None:
        """Return the same region with a smaller box: bounds on ``x - y`` may narrow the intervals of x and y.

        Returns None if no point of the box satisfies all known bounds.
        """
        box = dict(self.box)
        narrowing = _Narrowing(box)
        for _ in range(_ROUNDS if self.known else 0):
            before = dict(box)
            spend(len(box))
            try:
                for expression, bounds in self.known.items():
                    remaining = narrowing.narrow(expression, bounds)
                    if expression in self.nonzero and remaining == (0.0, 0.0):
                        return None
            except _EmptyError:
                return None
            if box == before:
                break
        return replace(self, box=box)

    def halves(self) -> tuple[ConstrainedBox, ConstrainedBox] | None:
        """Return the two halves of the region, or None if no side can be cut.

        The cut goes across the side that is longest on a logarithmic scale.
        """
        widest = max(self.box, key=lambda variable: _length(self.box[variable]), default=None)
        if widest is None or _length(self.box[widest]) < 1e-9:
            return None
        low, high = self.box[widest]
        middle = _middle(low, high)
        lower = replace(self, box={**self.box, widest: (low, middle)})
        return lower, replace(self, box={**self.box, widest: (middle, high)})


def _with_chains(constraints: Iterable[Constraint]) -> list[Constraint]:
    """Return the constraints, and also ``a - c >= 0`` for each two ``a - b >= 0`` and ``b - c >= 0``.

    Interval arithmetic does not derive the third constraint from the other two.
    """
    chained = list(constraints)
    differences = [c for c in chained if isinstance(c.difference, Op) and c.difference.op == "-"]
    spend(len(differences) * len(differences) // 4)
    for upper in differences:
        for lower in differences:
            (a, b), (also_b, c) = _two_operands(upper), _two_operands(lower)
            if b == also_b and a != c:
                chained.append(Constraint(Op("-", (a, c)), upper.strict or lower.strict))
    return chained


def _two_operands(constraint: Constraint) -> tuple[Expression, Expression]:
    assert isinstance(constraint.difference, Op)
    left, right = constraint.difference.args
    return left, right


def bound(expression: Expression, region: ConstrainedBox) -> Interval:
    """Return an interval that contains every value of an expression without ``when`` on a region.

    Raises UndefinedError if the expression may be undefined somewhere in the region.
    """
    value = _bound(expression, region)
    known = region.known.get(expression) if region.known else None
    return (interval.intersection(value, known) or known) if known else value


def _bound(expression: Expression, region: ConstrainedBox) -> Interval:
    spend()
    if isinstance(expression, Const):
        return expression.value, expression.value
    if isinstance(expression, (SignalValue, ParamValue)):
        return region.box[expression]
    assert isinstance(expression, Op), "cases have no `when`"
    nonzero = expression.op == "/" and bool(region.nonzero) and expression.args[1] in region.nonzero
    return _combine(expression, [bound(arg, region) for arg in expression.args], nonzero)


def _combine(expression: Op, args: list[Interval], nonzero: bool) -> Interval:
    """Return the bounds of an operation from the bounds of its arguments.

    ``nonzero`` states that the divisor of the operation is not 0. Raises UndefinedError if the
    operation may be undefined.
    """
    if expression.op == "/":
        quotient = interval.divide(args[0], args[1], nonzero=nonzero)
        return (1.0, 1.0) if expression.args[0] == expression.args[1] else quotient
    if expression.op == "-" and expression.args[0] == expression.args[1]:
        return 0.0, 0.0
    if expression.op == "*" and expression.args[0] == expression.args[1]:
        return interval.power(args[0], (2.0, 2.0))
    return _apply(expression.op, args)


def _apply(op: str, args: list[Interval]) -> Interval:
    first = args[0]
    if op in _UNARY:
        return _UNARY[op](first)
    if op == "clamp":
        return interval.minimum(interval.maximum(first, args[1]), args[2])
    function = _BINARY[op]
    for arg in args[1:]:
        first = function(first, arg)
    return first


_UNARY = {
    "neg": interval.negate,
    "abs": interval.absolute,
    "sqrt": interval.root,
    "exp": interval.exponential,
    "tanh": interval.hyperbolic_tangent,
}
_BINARY = {
    "+": interval.add,
    "-": interval.subtract,
    "*": interval.multiply,
    "/": interval.divide,
    "^": interval.power,
    "min": interval.minimum,
    "max": interval.maximum,
}


class _EmptyError(Exception):
    """Raised when no point of a box satisfies the constraints."""


class _Narrowing:
    """Shrinks a box to the points where expressions lie within bounds.

    The method is HC4: forward evaluation, then the inverse of each operator.
    """

    def __init__(self, box: dict[Variable, Interval]) -> None:
        self._box = box
        self._bounds: dict[Op, Interval | None] = {}

    def narrow(self, expression: Expression, target: Interval) -> Interval:
        """Shrink the box to the points where the expression can lie in ``target``.

        Returns the remaining part of ``target``. Raises _EmptyError if no part remains.
        """
        spend()
        remaining = interval.intersection(self._bound(expression), target)
        if remaining is None:
            raise _EmptyError
        if isinstance(expression, (SignalValue, ParamValue)):
            if self._box[expression] != remaining:
                self._box[expression] = remaining
                self._bounds.clear()
        elif isinstance(expression, Op):
            self._narrow_args(expression, remaining)
        return remaining

    def _narrow_args(self, expression: Op, value: Interval) -> None:
        op, args = expression.op, expression.args
        if op == "neg":
            self.narrow(args[0], interval.negate(value))
        elif op in ("+", "-") and len(args) == 2:
            self._narrow_sum(op, args, value)
        elif op == "*" and len(args) == 2:
            for factor, cofactor in ((args[0], args[1]), (args[1], args[0])):
                divisor = self._bound(cofactor)
                if divisor[0] > 0 or divisor[1] < 0:
                    self.narrow(factor, interval.divide(value, divisor))
        elif op == "/":
            self.narrow(args[0], interval.multiply(value, self._bound(args[1])))
        elif op in ("min", "max"):
            for arg in args:
                self.narrow(arg, (value[0], inf) if op == "min" else (-inf, value[1]))
        elif op == "abs":
            inner = self._bound(args[0])
            side = value if inner[0] >= 0 else interval.negate(value) if inner[1] <= 0 else (-value[1], value[1])
            self.narrow(args[0], side)
        elif op == "sqrt":
            self.narrow(args[0], interval.power((max(0.0, value[0]), max(0.0, value[1])), (2.0, 2.0)))
        elif op == "^" and args[1] == Const(2.0):
            high = interval.root((0.0, max(0.0, value[1])))[1]
            inner = self._bound(args[0])
            low = interval.root((max(0.0, value[0]),) * 2)[0] if inner[0] >= 0 else -high
            self.narrow(args[0], (low, high))

    def _narrow_sum(self, op: str, args: Sequence[Expression], value: Interval) -> None:
        b = self._bound(args[1])
        self.narrow(args[0], (interval.subtract if op == "+" else interval.add)(value, b))
        a = self._bound(args[0])
        self.narrow(args[1], interval.subtract(value, a) if op == "+" else interval.subtract(a, value))

    def _bound(self, expression: Expression) -> Interval:
        """Return the bounds of an expression in the current box, EVERYTHING if it may be undefined."""
        return self._bound_or_none(expression) or EVERYTHING

    def _bound_or_none(self, expression: Expression) -> Interval | None:
        if isinstance(expression, Const):
            return expression.value, expression.value
        if isinstance(expression, (SignalValue, ParamValue)):
            return self._box[expression]
        assert isinstance(expression, Op), "cases have no `when`"
        if expression not in self._bounds:
            spend()
            self._bounds[expression] = self._operation_bounds(expression)
        return self._bounds[expression]

    def _operation_bounds(self, expression: Op) -> Interval | None:
        args = [self._bound_or_none(arg) for arg in expression.args]
        try:
            return _combine(expression, [_require_defined(arg) for arg in args], nonzero=False)
        except UndefinedError:
            return None


def _require_defined(bounds: Interval | None) -> Interval:
    if bounds is None:
        raise UndefinedError
    return bounds


def _length(side: Interval) -> float:
    """Return the length of a side of a box on a logarithmic scale, to choose the side to cut.

    Unbounded sides have a finite length, too.
    """
    return sum(copysign(log1p(min(abs(end), _FAR_AWAY)), end) * sign for end, sign in zip(side, (-1, 1), strict=True))


def _middle(low: float, high: float) -> float:
    if low == -inf and high == inf:
        return 0.0
    if high == inf:
        return max(1.0, 4.0 * low) if low >= 0 else 0.0
    if low == -inf:
        return min(-1.0, 4.0 * high) if high <= 0 else 0.0
    if low > 0 and high > 4 * low:
        return sqrt(low) * sqrt(high)
    if high < 0 and low < 4 * high:
        return -sqrt(-low) * sqrt(-high)
    return interval.midpoint(low, high)
