"""The robustness of a comparison: its margin, scaled to [-1, 1], with the sign that its truth gives.

The margin is ``left - right``. Doubles subtract without losing the sign: the margin is above 0 exactly where the left
side is greater. Scaling may lose it: a small margin over a large width rounds to 0, and the width of a large range is
too large for a number. So a margin above 0 that might round to 0 gives at least the smaller of itself and
:data:`tltlc.expression.tree.LEAST`, and halves of both sides are subtracted where the width is too large.
"""

from __future__ import annotations

from math import isinf, ulp
from typing import Final

from tltlc.core.record import record
from tltlc.expression.tree import LEAST, Const, Expression, Op
from tltlc.resolve.values import Quantity

_NEVER_LOST: Final = 2.0**-126
"""The smallest normal number of 32 bits: a quotient at least this large does not round to 0."""


def robustness(left: Quantity, right: Quantity) -> Expression:
    """The robustness of ``left > right``: 1 and -1 where the margin is greatest and least, each side scaled on its own.

    The sides have finite ranges, and some of their values make the comparison true.
    """
    holding, failing = _Width(left.high, right.low), _Width(right.high, left.low)
    share = _share(left, right, holding)
    is_lost = _gap(left, right) / holding.full < _NEVER_LOST
    kept = (Op("min", (_margin(left, right), Const(LEAST))),) if is_lost and holding.full > 1 else ()
    if failing.full == 0 or failing.order == holding.order:
        return _greatest(share, *kept)
    # Of the two quotients, the one over the smaller divisor is the greater above 0 and the smaller below.
    other = _share(left, right, failing)
    if holding.order < failing.order:
        return _greatest(share, *kept, other)
    if failing.full > 1:
        return _greatest(Op("min", (share, other)), *kept)
    return Op("min", (_greatest(share, *kept), other))


@record
class _Width:
    """The greatest margin on one side: from ``least`` to ``most``."""

    most: float
    least: float

    @property
    def full(self) -> float:
        """Infinite where it is too large for a number."""
        return self.most - self.least

    @property
    def half(self) -> float:
        return self.most / 2 - self.least / 2

    @property
    def order(self) -> tuple[float, float]:
        """What widths are compared by."""
        return self.full, self.half


def _share(left: Quantity, right: Quantity, width: _Width) -> Expression:
    """The margin over its greatest value."""
    if isinf(width.full):
        halves = Op("-", (_half(left.expression), _half(right.expression)))
        return Op("/", (halves, Const(width.half)))
    margin = _margin(left, right)
    return margin if width.full == 1 else Op("/", (margin, Const(width.full)))


def _half(side: Expression) -> Expression:
    return Const(side.value / 2) if isinstance(side, Const) else Op("/", (side, Const(2.0)))


def _margin(left: Quantity, right: Quantity) -> Expression:
    if right.expression == Const(0.0):
        return left.expression
    if left.expression == Const(0.0):
        return Op("neg", (right.expression,))
    return Op("-", (left.expression, right.expression))


def _gap(left: Quantity, right: Quantity) -> float:
    """What two different values of the sides differ by at least, if only by 0."""
    return max(_spacing(left), _spacing(right))


def _spacing(side: Quantity) -> float:
    """How near the next number may be to a value of a side."""
    if side.low <= 0 <= side.high:
        return 0.0
    return ulp(min(abs(side.low), abs(side.high))) / 2


def _greatest(*args: Expression) -> Expression:
    return args[0] if len(args) == 1 else Op("max", args)
