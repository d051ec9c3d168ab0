"""Compute the robustness of a comparison ``left > right``: its margin, scaled to [-1, 1].

The margin is ``left - right``. Scaling divides a margin above 0 by the greatest possible margin, and
a margin below 0 by the size of the least. The robustness must have the right sign: it is above 0
exactly where the left side is greater. Subtraction of doubles keeps the sign, but division can lose
it: a small margin over a large width rounds to 0, and the width of a large range overflows. Two
measures prevent this. Where the quotient might round to 0, the robustness of a margin above 0 is at
least the smaller of the margin and :data:`tltlc.expression.tree.LEAST`. If the width overflows, both
sides are halved before they are subtracted.
"""

from __future__ import annotations

from math import isinf, ulp
from typing import Final

from tltlc.core.record import record
from tltlc.expression.tree import LEAST, Const, Expression, Op
from tltlc.resolve.values import Quantity

_NEVER_LOST: Final = 2.0**-126
"""The smallest normal 32-bit float. A quotient of at least this size does not round to 0."""


def robustness(left: Quantity, right: Quantity) -> Expression:
    """Return an expression for the robustness of ``left > right``, scaled separately above and below 0.

    Its value is 1 at the greatest possible margin ``left - right``, and -1 at the least. The sides
    must have finite ranges, and some of their values must make the comparison true.
    """
    holding, failing = _MarginRange(left.high, right.low), _MarginRange(right.high, left.low)
    share = _share(left, right, holding)
    is_lost = _gap(left, right) / holding.width < _NEVER_LOST
    floor = (Op("min", (_margin(left, right), Const(LEAST))),) if is_lost and holding.width > 1 else ()
    if failing.width == 0 or failing.order == holding.order:
        return _max_of(share, *floor)
    # Above 0, the quotient with the smaller divisor is the greater one. Below 0, it is the smaller one.
    failing_share = _share(left, right, failing)
    if holding.order < failing.order:
        return _max_of(share, *floor, failing_share)
    if failing.width > 1:
        return _max_of(Op("min", (share, failing_share)), *floor)
    return Op("min", (_max_of(share, *floor), failing_share))


@record
class _MarginRange:
    """The sizes that a margin can have on one side of 0: from 0 to ``width``, which is ``most - least``.

    ``most`` is the greatest value of one side of the comparison, and ``least`` the least value of
    the other side.
    """

    most: float
    least: float

    @property
    def width(self) -> float:
        """The largest size of a margin; infinite if the subtraction overflows."""
        return self.most - self.least

    @property
    def half_width(self) -> float:
        """Half the width; finite even if the width overflows."""
        return self.most / 2 - self.least / 2

    @property
    def order(self) -> tuple[float, float]:
        """The sort key of ranges by width; it also works for widths that overflow."""
        return self.width, self.half_width


def _share(left: Quantity, right: Quantity, margin_range: _MarginRange) -> Expression:
    """Return an expression for the margin ``left - right``, divided by the width of ``margin_range``."""
    if isinf(margin_range.width):
        halves = Op("-", (_half(left.expression), _half(right.expression)))
        return Op("/", (halves, Const(margin_range.half_width)))
    margin = _margin(left, right)
    return margin if margin_range.width == 1 else Op("/", (margin, Const(margin_range.width)))


def _half(side: Expression) -> Expression:
    return Const(side.value / 2) if isinstance(side, Const) else Op("/", (side, Const(2.0)))


def _margin(left: Quantity, right: Quantity) -> Expression:
    if right.expression == Const(0.0):
        return left.expression
    if left.expression == Const(0.0):
        return Op("neg", (right.expression,))
    return Op("-", (left.expression, right.expression))


def _gap(left: Quantity, right: Quantity) -> float:
    """Return a lower bound for the size of every margin other than 0. The bound may be 0."""
    return max(_spacing(left), _spacing(right))


def _spacing(side: Quantity) -> float:
    """Return a lower bound for the distance from any value of a side to the next float; 0 if it may be 0."""
    if side.low <= 0 <= side.high:
        return 0.0
    return ulp(min(abs(side.low), abs(side.high))) / 2


def _max_of(*args: Expression) -> Expression:
    return args[0] if len(args) == 1 else Op("max", args)
