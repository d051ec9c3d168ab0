"""Split an expression with ``when`` into cases: expressions without ``when``, with constraints.

``when x > 3: 1  otherwise: x`` has the case ``1`` where ``x - 3 > 0``, and the case ``x`` where
``3 - x >= 0``.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from tltlc.core.record import record
from tltlc.expression.tree import Condition, Const, Expression, Op, ParamValue, SignalValue, When, nodes
from tltlc.resolve.range_proof.work_budget import spend

LARGEST_NUMBER_OF_CASES = 64
MOST_MEETING_CASES = 24
"""The most cases of a `when` whose continuity is checked. The work grows with the number of pairs."""


class TooManyCasesError(Exception):
    """Raised when an expression splits into more cases than are worth checking."""


@record
class Constraint:
    """The constraint ``difference >= 0``, or ``difference > 0`` if ``strict``."""

    difference: Expression
    strict: bool


Constraints = tuple[Constraint, ...]


@record
class ConstrainedValue:
    """A case of an expression: the expression equals ``value`` where all constraints hold."""

    constraints: Constraints
    value: Expression


def cases(expression: Expression, *, split_extremes: bool = False) -> tuple[ConstrainedValue, ...]:
    """Return the cases of an expression, in the order of the text; at every point, some case applies.

    ``split_extremes`` also splits min, max, abs and clamp: ``abs(x)`` has the cases ``x`` and ``-x``.
    Raises TooManyCasesError if there are more than LARGEST_NUMBER_OF_CASES.
    """
    result: list[ConstrainedValue] = []
    for case in _expand(expression, (), split_extremes):
        result.append(case)
        if len(result) > LARGEST_NUMBER_OF_CASES:
            raise TooManyCasesError
    return tuple(result)


def condition_operands(expression: Expression) -> tuple[ConstrainedValue, ...]:
    """Return the arithmetic expressions that the conditions of a ``when`` compare.

    Each comes with the constraints under which it is evaluated. They are needed to prove that a
    condition is always defined, so single signals, params and numbers are left out. Raises
    TooManyCasesError.
    """
    result: list[ConstrainedValue] = []
    _collect_operands(expression, (), result)
    return tuple(result)


def whens(expression: Expression) -> Iterator[When]:
    """Yield the ``when`` expressions that are not inside another ``when``."""
    if isinstance(expression, When):
        yield expression
    elif isinstance(expression, Op):
        for arg in expression.args:
            yield from whens(arg)


def size(expression: Expression, most: int) -> int:
    """Return the number of nodes of an expression; stop counting at ``most + 1``."""
    return sum(1 for _ in islice(nodes(expression), most + 1))


def variables(expression: Expression | Condition) -> dict[SignalValue | ParamValue, None]:
    """Return the signals and params that an expression reads, in order of appearance."""
    all_nodes = list(nodes(expression))
    spend(1 + len(all_nodes) // 10)
    return dict.fromkeys(node for node in all_nodes if isinstance(node, (SignalValue, ParamValue)))


def _expand(expression: Expression, before: Constraints, extremes: bool) -> Iterator[ConstrainedValue]:
    spend()
    if isinstance(expression, When):
        remaining: list[Constraints] = [before]
        for condition, value in expression.cases:
            for path in remaining:
                for then_path in _paths_where(condition, True, path, extremes):
                    yield from _expand(value, then_path, extremes)
            remaining = [
                else_path for path in remaining for else_path in _paths_where(condition, False, path, extremes)
            ]
            if len(remaining) > LARGEST_NUMBER_OF_CASES:
                raise TooManyCasesError
        for path in remaining:
            yield from _expand(expression.otherwise, path, extremes)
    elif isinstance(expression, Op):
        for constraints, args in _expand_all(expression.args, before, extremes):
            if extremes and expression.op in ("min", "max", "abs", "clamp"):
                yield from _split_extreme(expression.op, args, constraints)
            else:
                yield ConstrainedValue(constraints, expression if args == expression.args else Op(expression.op, args))
    else:
        yield ConstrainedValue(before, expression)


def _expand_all(
    args: tuple[Expression, ...], before: Constraints, extremes: bool
) -> Iterator[tuple[Constraints, tuple[Expression, ...]]]:
    if not args:
        yield before, ()
        return
    for first in _expand(args[0], before, extremes):
        for constraints, rest in _expand_all(args[1:], first.constraints, extremes):
            yield constraints, (first.value, *rest)


def _split_extreme(op: str, args: tuple[Expression, ...], before: Constraints) -> Iterator[ConstrainedValue]:
    if op == "abs":
        yield ConstrainedValue((*before, Constraint(args[0], False)), args[0])
        yield ConstrainedValue((*before, Constraint(Op("neg", args), True)), Op("neg", args))
    elif op == "clamp":
        value, low, high = args
        for inner in _split_extreme("max", (value, low), before):
            yield from _split_extreme("min", (inner.value, high), inner.constraints)
    else:
        for extreme in args:
            rest = [arg for arg in args if arg != extreme]
            pairs = [(arg, extreme) if op == "min" else (extreme, arg) for arg in rest]
            yield ConstrainedValue((*before, *(Constraint(Op("-", pair), False) for pair in pairs)), extreme)


def _paths_where(condition: Condition, truth: bool, before: Constraints, extremes: bool) -> Iterator[Constraints]:
    """Yield the sets of constraints under which a condition has the value ``truth``.

    Each set begins with the constraints ``before``.
    """
    spend()
    if condition.op == "not":
        yield from _paths_where(_condition(condition.args[0]), not truth, before, extremes)
    elif condition.op in ("and", "or"):
        if (condition.op == "and") == truth:
            paths = [before]
            for arg in condition.args:
                paths = [
                    extended for path in paths for extended in _paths_where(_condition(arg), truth, path, extremes)
                ]
                if len(paths) > LARGEST_NUMBER_OF_CASES:
                    raise TooManyCasesError
            yield from paths
        else:
            for arg in condition.args:
                yield from _paths_where(_condition(arg), truth, before, extremes)
    else:
        left, right = (_expression(arg) for arg in condition.args)
        for constraints, (a, b) in _expand_all((left, right), before, extremes):
            below = (condition.op in ("<", "<=")) == truth
            strict = (condition.op in ("<", ">")) == truth
            yield (*constraints, Constraint(_difference(b, a) if below else _difference(a, b), strict))


def _difference(a: Expression, b: Expression) -> Expression:
    return a if b == Const(0.0) else Op("-", (a, b))


def _collect_operands(node: Expression, before: Constraints, result: list[ConstrainedValue]) -> None:
    spend()
    if isinstance(node, Op):
        for arg in node.args:
            _collect_operands(arg, before, result)
    elif isinstance(node, When):
        remaining: list[Constraints] = [before]
        for condition, value in node.cases:
            for path in remaining:
                _collect_condition(condition, path, result)
                for then_path in _paths_where(condition, True, path, False):
                    _collect_operands(value, then_path, result)
            remaining = [else_path for path in remaining for else_path in _paths_where(condition, False, path, False)]
            if len(result) + len(remaining) > LARGEST_NUMBER_OF_CASES:
                raise TooManyCasesError
        for path in remaining:
            _collect_operands(node.otherwise, path, result)


def _collect_condition(condition: Condition, before: Constraints, result: list[ConstrainedValue]) -> None:
    paths = [before]
    for arg in condition.args:
        for path in paths:
            if isinstance(arg, Condition):
                _collect_condition(arg, path, result)
            elif not isinstance(arg, (Const, SignalValue, ParamValue)):
                _collect_operands(arg, path, result)
                result.extend(_expand(arg, path, False))
        if (
            isinstance(arg, Condition) and condition.op != "not"
        ):  # the next operand is only evaluated if this one does not decide
            paths = [extended for path in paths for extended in _paths_where(arg, condition.op == "and", path, False)]


def _condition(arg: Expression | Condition) -> Condition:
    assert isinstance(arg, Condition)
    return arg


def _expression(arg: Expression | Condition) -> Expression:
    assert not isinstance(arg, Condition)
    return arg
