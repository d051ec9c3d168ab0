"""Evaluate constant numbers: the ends of ranges, the values of params, periods and limits."""

from __future__ import annotations

import re
from math import ceil, inf, isinf

from tltlc.core.record import replace
from tltlc.expression.tree import Const
from tltlc.grammar import tree
from tltlc.grammar.tree import Expr, GroupExpr, Interval, NumberExpr
from tltlc.resolve import units
from tltlc.resolve.clock import LONGEST_S
from tltlc.resolve.dimensions import mismatch
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.quantities import quantity
from tltlc.resolve.units import Dimension
from tltlc.resolve.values import Env

MOST_SAMPLES = 10**9
"""The largest number of samples that a bound or a limit may name."""


def number(expr: Expr, dimension: Dimension, env: Env, subject: str) -> float:
    """Return the value of a constant expression in SI units.

    Raises ResolutionError if the expression is not constant or does not have this dimension.
    ``subject`` names the value in the message of the error.
    """
    value = quantity(expr, replace(env, constant=True, local={}))
    if value.dimension not in (None, dimension):
        raise mismatch(dimension, value.dimension, expr, env, f"{subject} is {units.dimension_text(dimension)}")
    assert isinstance(value.expression, Const), "constants fold"
    return value.expression.value


def interval(declared: Interval, dimension: Dimension, env: Env) -> tuple[float | None, float | None]:
    """Return the lower and the upper end of a range, in SI units.

    An infinite end is None: ``[0 m, inf]`` gives ``(0.0, None)``. Raises ResolutionError if the range
    is empty (TLT0303), or if an end is not constant or does not have this dimension.
    """
    low = _range_end(declared.low, dimension, env)
    high = _range_end(declared.high, dimension, env)
    if low == inf or high == -inf or low > high:
        raise problem(
            "TLT0303",
            "this range is empty",
            env.scope.source,
            declared.span,
            advice="write the smaller end first, e.g. `in [0, 1]`",
        )
    return (None if low == -inf else low), (None if high == inf else high)


def samples(value: NumberExpr, env: Env) -> int:
    """Convert the number in a bound or a limit, such as ``20 steps`` or ``2 s``, to a number of samples.

    A time is divided by the clock's period and rounded up. A number without a unit counts samples.
    Raises ResolutionError: TLT0313 for a time if there is no clock, TLT0312 for any other value that
    cannot be converted.
    """
    source = env.scope.source
    if value.unit in (None, "step", "steps"):
        if value.value != value.value // 1 and value.value <= MOST_SAMPLES:
            title, advice = "expected a whole number of steps", _fraction_help(value, env)
            raise problem("TLT0312", title, source, value.span, advice=advice)
        return _sample_count(value.value, value, env)
    in_si = units.in_si(value.value, value.unit)
    if in_si is None or in_si[1] != units.TYPES["time"]:
        described = units.dimension_text(in_si[1]) if in_si else f"`{value.unit}`"
        title = f"expected a number of steps or a time, found {described}"
        raise problem("TLT0312", title, source, value.span, advice="write e.g. `20 steps` or `2 s`")
    period = env.context.clock_s
    if period is None and env.context.clock_failed:
        raise ResolutionError(None)
    if env.context.clock_varies:
        advice = "write the limit in steps, e.g. `limit 1000 steps`"
        raise problem("TLT0323", "a limit in seconds needs a fixed clock", source, value.span, advice=advice)
    if period is None:
        raise problem(
            "TLT0313",
            "a bound in seconds needs a clock",
            source,
            value.span,
            advice="declare how often the game takes a sample, e.g. `clock 20 Hz` (`clock 0.15 s` for levels of tltlc)"
            ", or write the bound in steps",
        )
    # Subtract a tolerance, so that a rounding error of the division does not add a sample.
    return _sample_count(in_si[0] / period - 1e-9, value, env)


def _fraction_help(value: NumberExpr, env: Env) -> str:
    """Return a help text for a number of steps such as ``1.5``, which is no whole number.

    Without a unit, the author probably means seconds. No rounding is offered, since it changes the meaning.
    """
    if value.unit is not None:
        return "there are no parts of a step: write a whole number of them, or a time, e.g. `2 s`"
    time = f"{env.scope.source.slice(value.span)} s"
    advice = "a bound without a unit counts steps; for a time, "
    if env.context.clock_s is None:
        return f"{advice}declare how often the game takes a sample, e.g. `clock 20 Hz`, and write `{time}`"
    count = samples(replace(value, unit="s"), env)
    return f"{advice}write `{time}`, which is {count} step{'s' * (count != 1)} with this clock"


def seconds(value: NumberExpr, example: str, env: Env) -> float:
    """Return the time in a bound, such as ``2 s``, in seconds, for a clock that varies.

    ``example`` is a bound that is right, for the help. Raises ResolutionError: TLT0323 for a number of
    steps, TLT0312 for anything else that is no time.
    """
    source = env.scope.source
    if value.unit in (None, "step", "steps"):
        title = "a bound in steps needs a fixed clock"
        message = "with `clock varies`, steps differ in length"
        advice = f"write a time, e.g. `{example}`"
        raise problem("TLT0323", title, source, value.span, message, advice=advice)
    in_si = units.in_si(value.value, value.unit)
    if in_si is None or in_si[1] != units.TYPES["time"]:
        described = units.dimension_text(in_si[1]) if in_si else f"`{value.unit}`"
        title = f"expected a time, found {described}"
        raise problem("TLT0312", title, source, value.span, advice=f"write e.g. `{example}`")
    if in_si[0] > LONGEST_S:
        title = f"this is more than {LONGEST_S:,.0f} s"
        raise problem("TLT0312", title, source, value.span, advice="write a shorter time")
    return in_si[0]


def _sample_count(steps: float, value: NumberExpr, env: Env) -> int:
    """Return ``steps`` rounded up to a whole number of samples.

    Raises ResolutionError (TLT0312) at ``value`` if ``steps`` is above MOST_SAMPLES.
    """
    if steps > MOST_SAMPLES:
        title = f"this is more than {MOST_SAMPLES:,} steps"
        raise problem("TLT0312", title, env.scope.source, value.span, advice="write a smaller number")
    return ceil(steps)


_OVERRIDE = re.compile(r"([-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*([A-Za-z%/]*)")


def parse_override(text: str) -> tuple[float, Dimension | None] | None:
    """Return the number in a text such as ``25 m`` or ``3 km/h``, in SI units, and its dimension.

    The text is the value of a param that a user sets from outside, as in ``--param NAME=25 m``. The
    dimension is None if the text has no unit. Returns None if the text is no number, has an unknown
    unit, or is too large for a float in SI units.
    """
    matched = _OVERRIDE.fullmatch(text.strip())
    if matched is None:
        return None
    value, unit = float(matched[1]), matched[2]
    if not unit:
        return None if isinf(value) else (value, None)
    numerator_unit, _, denominator_unit = unit.partition("/")
    numerator = units.in_si(value, numerator_unit)
    denominator = units.in_si(1.0, denominator_unit) if denominator_unit else (1.0, units.PLAIN)
    if numerator is None or denominator is None:
        return None
    if isinf(numerator[0] / denominator[0]):
        return None
    return numerator[0] / denominator[0], units.product(numerator[1], denominator[1], -1.0)


def _range_end(expr: Expr, dimension: Dimension, env: Env) -> float:
    sign, inner = 1.0, expr
    while isinstance(inner, GroupExpr) or (isinstance(inner, tree.Unary) and inner.op == "-"):
        if isinstance(inner, tree.Unary):
            sign, inner = -sign, inner.operand
        else:
            inner = inner.inner
    if isinstance(inner, NumberExpr) and inner.value == inf:
        return sign * inf
    return number(expr, dimension, env, "the range")
