"""Check that an expression does not jump where two cases of a ``when`` meet.

The expression is continuous in its signals if each ``when`` in it is. Two cases of a ``when`` meet
only at points that satisfy the constraints of both, with ``>=`` in place of ``>``. The ``when`` is
continuous if every two cases have equal values at these points. Params are fixed while a game runs,
so jumps between their values do not matter. Bool signals have only two values and are treated like
params.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from math import inf

from tltlc.core.record import record
from tltlc.expression.tree import Expression, Op, SignalValue
from tltlc.resolve.range_proof.cases import (
    MOST_MEETING_CASES,
    ConstrainedValue,
    Constraint,
    TooManyCasesError,
    variables,
)
from tltlc.resolve.range_proof.interval import UndefinedError
from tltlc.resolve.range_proof.proof import ProofGoal, holds_at_once, proves_defined, proves_within
from tltlc.resolve.range_proof.region import ConstrainedBox, Variable

_PARTS = 30


@record
class Meeting:
    """Two cases and a region that contains every point where they meet."""

    first: ConstrainedValue
    second: ConstrainedValue
    constraints: tuple[Constraint, ...]
    region: ConstrainedBox


def meetings(
    all_cases: Sequence[ConstrainedValue], whole: ConstrainedBox, stepped: frozenset[Variable]
) -> Iterator[Meeting]:
    """Yield each pair of cases that may meet, except pairs with the same expression as their value.

    ``whole`` has the ranges of all variables. Raises TooManyCasesError if there are more than
    MOST_MEETING_CASES cases.
    """
    if len(all_cases) > MOST_MEETING_CASES:
        raise TooManyCasesError
    for first, second in combinations(all_cases, 2):
        if first.value == second.value:
            continue
        constraints = tuple(
            _closed_constraint(constraint, stepped)
            for constraint in dict.fromkeys((*first.constraints, *second.constraints))
            if holds_at_once(
                constraint.difference, whole, -inf, inf
            )  # where a difference may be undefined, its zeros may not show where the case ends
        )
        region = whole.constrain(constraints)
        if region is not None:
            yield Meeting(first, second, constraints, region)


def proves_agreement(meeting: Meeting) -> bool:
    """Whether both values are provably defined and equal wherever the two cases meet."""
    difference = Op("-", (meeting.first.value, meeting.second.value))
    if holds_at_once(difference, meeting.region, 0.0, 0.0):
        return True
    if not proves_defined(difference, meeting.region, _PARTS):
        return False
    if _same_after_substitution(difference, meeting.region):
        return True
    return proves_within(difference, meeting.region, 0.0, 0.0, _PARTS)


def agreement_goal(meeting: Meeting) -> ProofGoal:
    """Return the goal of a proof that two cases have equal values where they meet."""
    difference = Op("-", (meeting.first.value, meeting.second.value))
    return ProofGoal(difference, meeting.constraints, 0.0, 0.0)


def _closed_constraint(constraint: Constraint, stepped: frozenset[Variable]) -> Constraint:
    """Return the constraint with ``>=`` in place of ``>`` if it reads a signal that is not a bool.

    Such a signal can come arbitrarily close to the border.
    """
    if any(isinstance(v, SignalValue) and v not in stepped for v in variables(constraint.difference)):
        return Constraint(constraint.difference, False)
    return constraint


def _same_after_substitution(difference: Expression, region: ConstrainedBox) -> bool:
    """Whether ``difference`` becomes zero after substituting the equations that hold on the region.

    Each equation is solved for a signal, param or other factor in it. The solution then replaces this
    factor in ``difference``: with ``x = 3``, ``x - 3`` becomes 0.
    """
    from tltlc.resolve.range_proof import normal_form as nf

    try:
        form = nf.quotient(difference)
        numerator, denominator = form.numerator, form.denominator
        equations = [nf.quotient(e).numerator for e, known in region.known.items() if known == (0.0, 0.0)]
        equations += [
            nf.add(nf.quotient(variable).numerator, nf.constant(nf.exact_decimal(side[0])), -1)
            for variable, side in region.box.items()
            if side[0] == side[1]
        ]
        while equations:
            solved = nf.solve_for_factor(equations.pop())
            if solved is not None:
                factor, by = solved
                numerator, denominator, *equations = (
                    nf.substitute(polynomial, factor, by) for polynomial in (numerator, denominator, *equations)
                )
        return not numerator and bool(denominator)
    except (nf.TooLargeError, UndefinedError):
        return False
