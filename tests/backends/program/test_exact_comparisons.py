"""The program of a monitor decides comparisons exactly, and the ranges that it proves are correct."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from hypothesis import given

from tests.backends.program.interpreter import Scope
from tests.fuzzing import times
from tests.resolve.test_comparison_signs import FINITE, THREE, nearby_numbers, signal_quantity
from tltlc.program.arithmetic import ExpressionTranslator, with_declaration
from tltlc.program.bounds import prove_ranges, range_between
from tltlc.resolve import units
from tltlc.resolve.margins import robustness
from tltlc.resolve.values import constant


@times(250)
@given(THREE, FINITE)
def test_a_threshold_agrees_with_the_exact_comparison(ends: Sequence[float], x: float) -> None:
    low, threshold, high = ends
    side, fixed = signal_quantity("x", low, high), constant(threshold, units.PLAIN)
    for is_above, possible in ((True, threshold < high), (False, low < threshold)):
        if not possible:
            continue
        expression = robustness(side, fixed) if is_above else robustness(fixed, side)
        assigned = ExpressionTranslator({"x": "x"}, {}, "t").assign("value", expression)
        statements, range_ = prove_ranges("value", assigned, {"x": range_between(low, high)})
        for number in [*nearby_numbers(threshold, low, high), min(max(x, low), high)]:
            scope = Scope({"x": number})
            scope.run(with_declaration("value", statements))
            value = scope.values["value"]
            exact = Fraction(number) > Fraction(threshold) if is_above else Fraction(number) < Fraction(threshold)
            assert (value > 0.0) == exact
            assert range_ is None or range_.low <= value <= range_.high
