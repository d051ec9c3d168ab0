"""Numbers that must be known at once: the ends of ranges, the values of params, periods and limits."""

from __future__ import annotations

import re
from math import ceil, inf, isinf

from tltlc.core.record import replace
from tltlc.expression.tree import Const
from tltlc.grammar import tree
from tltlc.grammar.tree import Expr, Group, Interval, Number
from tltlc.resolve import units
from tltlc.resolve.dimensions import mismatch
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.quantities import quantity
from tltlc.resolve.units import Dimension
from tltlc.resolve.values import Env

MOST_SAMPLES = 10**9
"""The greatest number of samples that a bound or a limit may name."""


def number(expr: Expr, dimension: Dimension, env: Env, what: str) -> float:
    """The value of a constant expression in SI units; raises ResolutionError where it depends on anything."""
    found = quantity(expr, replace(env, constant=True, local={}))
    if found.dimension not in (None, dimension):
        raise mismatch(dimension, found.dimension, expr, env, f"{what} is {units.described(dimension)}")
    assert isinstance(found.expression, Const), "constants fold"
    return found.expression.value


def interval(written: Interval, dimension: Dimension, env: Env) -> tuple[float | None, float | None]:
    """The ends of a range in SI units, None where open (``inf``); raises ResolutionError where it is empty."""
    low = _end(written.low, dimension, env)
    high = _end(written.high, dimension, env)
    if low == inf or high == -inf or low > high:
        raise problem(
            "TLT0303",
            "this range is empty",
            env.scope.source,
            written.span,
            advice="write the smaller end first, e.g. `in [0, 1]`",
        )
    return (None if low == -inf else low), (None if high == inf else high)


def samples(value: Number, env: Env) -> int:
    """A number of samples, written in steps or as a time (rounded up); raises ResolutionError.

    Without a unit it counts samples.  A time needs a clock (TLT0313).
    """
    source = env.scope.source
    if value.unit in (None, "step", "steps"):
        if value.value != value.value // 1 and value.value <= MOST_SAMPLES:
            whole = f"{value.value // 1 + 1:.0f}" + (f" {value.unit}" if value.unit else "")
            advice = f"write e.g. `{whole}`"
            raise problem("TLT0312", "expected a whole number of steps", source, value.span, advice=advice)
        return _counted(value.value, value, env)
    found = units.in_si(value.value, value.unit)
    if found is None or found[1] != units.TYPES["time"]:
        described = units.described(found[1]) if found else f"`{value.unit}`"
        title = f"expected a number of steps or a time, found {described}"
        raise problem("TLT0312", title, source, value.span, advice="write e.g. `20 steps` or `2 s`")
    period = env.context.clock_s
    if period is None and env.context.clock_failed:
        raise ResolutionError(None)
    if period is None:
        raise problem(
            "TLT0313",
            "a bound in seconds needs a clock",
            source,
            value.span,
            advice="declare how often the game is sampled, e.g. `clock 20 Hz` (`clock 0.15 s` for levels of tltlc), "
            "or write the bound in steps",
        )
    # The tolerance keeps 0.15 s at 20 Hz at 3 samples.
    return _counted(found[0] / period - 1e-9, value, env)


def _counted(steps: float, value: Number, env: Env) -> int:
    """The number rounded up; raises ResolutionError where it is past all use."""
    if steps > MOST_SAMPLES:
        title = f"this is more than {MOST_SAMPLES:,} steps"
        raise problem("TLT0312", title, env.scope.source, value.span, advice="write a smaller number")
    return ceil(steps)


_OVERRIDE = re.compile(r"([-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*([A-Za-z%/]*)")


def override(text: str) -> tuple[float, Dimension | None] | None:
    """The value of ``--param NAME=25 m`` in SI units, dimension None without a unit; None where it is none."""
    found = _OVERRIDE.fullmatch(text.strip())
    if found is None:
        return None
    value, unit = float(found[1]), found[2]
    if not unit:
        return None if isinf(value) else (value, None)
    over, _, under = unit.partition("/")
    top = units.in_si(value, over)
    bottom = units.in_si(1.0, under) if under else (1.0, units.PLAIN)
    if top is None or bottom is None:
        return None
    if isinf(top[0] / bottom[0]):
        return None
    return top[0] / bottom[0], units.product(top[1], bottom[1], -1.0)


def _end(expr: Expr, dimension: Dimension, env: Env) -> float:
    sign, inner = 1.0, expr
    while isinstance(inner, Group) or (isinstance(inner, tree.Unary) and inner.op == "-"):
        if isinstance(inner, tree.Unary):
            sign, inner = -sign, inner.operand
        else:
            inner = inner.inner
    if isinstance(inner, Number) and inner.value == inf:
        return sign * inf
    return number(expr, dimension, env, "the range")
