"""Check that a predicate stays in its declared range, and that it does not jump between ``when`` cases.

There are four results: proved (no finding), wrong at a concrete point, unproved, and unchecked (the
check would exceed its step limit). These methods are tried in turn:

- proofs by interval arithmetic and by exact signs of polynomials;
- a search for a wrong point;
- an answer in the cache;
- a proof by sympy. Only this method imports sympy.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from math import inf
from typing import Literal

from tltlc.core.record import record
from tltlc.expression.tree import Expression, SignalValue, When
from tltlc.io.limits import WORK
from tltlc.resolve import spec
from tltlc.resolve.range_proof.cases import (
    LARGEST_NUMBER_OF_CASES,
    MOST_MEETING_CASES,
    TooManyCasesError,
    cases,
    condition_operands,
    size,
    variables,
    whens,
)
from tltlc.resolve.range_proof.proof import ProofGoal, unproved_goals
from tltlc.resolve.range_proof.region import Box, ConstrainedBox, Variable
from tltlc.resolve.range_proof.work_budget import OutOfWorkError, spend, step_limit

FindingKind = Literal[
    "range_wrong",
    "range_unproved",
    "range_unchecked",
    "discontinuous",
    "continuity_unproved",
    "continuity_unchecked",
]


_NO_POINT: Mapping[str, float] = {}


@record
class RangeProblem:
    """A finding: a predicate leaves its range or jumps, or this could not be ruled out.

    ``witness`` is the point where the predicate does so: it maps names of signals and params to
    values. It is empty if ``kind`` ends in ``unproved`` or ``unchecked``. ``is_undefined`` is true if
    the predicate has no value at this point.
    """

    kind: FindingKind
    message: str
    witness: Mapping[str, float] = _NO_POINT
    is_undefined: bool = False


def check_predicate(
    expression: Expression,
    signals: Mapping[str, spec.Signal],
    params: Mapping[str, spec.Param],
    low: float,
    high: float,
) -> tuple[RangeProblem, ...]:
    """Return the findings on a predicate with the declared range ``[low, high]``.

    The checks cover all values of the signals and params in their ranges. ``signals`` and ``params``
    must contain at least those that the expression reads, by name. There is at most one finding on
    the range and one on jumps between cases; there is none if both are proved. Takes a bounded number
    of steps, and reports a check that needs more as a finding.
    """
    with step_limit(_MOST_STEPS):
        if size(expression, LARGEST_SIZE) > LARGEST_SIZE:
            return (_unchecked_problem("range", f"it has more than {LARGEST_SIZE:,} operands and operators"),)
        try:
            box, bools = box_of(expression, signals, params)
            stepped = bools | _ints(expression, signals, params)
            return _findings(Predicate(expression, box, bools, stepped, low, high))
        except (RecursionError, OutOfWorkError):
            return (_unchecked_problem("range", _TOO_LONG),)


LARGEST_SIZE = 2000
_MOST_STEPS = WORK["check of a predicate"]
_STEPS_FOR_A_WITNESS = _MOST_STEPS // 3
"""The steps reserved for the search for a wrong point after a proof is abandoned."""
_STEPS_OF_A_QUESTION = _MOST_STEPS // 3
"""The steps that a proof with sympy may take."""
_TOO_LONG = f"the check takes too many steps: {_MOST_STEPS:,} are allowed"


def _unchecked_problem(aspect: Literal["range", "continuity"], why: str) -> RangeProblem:
    return RangeProblem("range_unchecked" if aspect == "range" else "continuity_unchecked", why)


def _findings(predicate: Predicate) -> tuple[RangeProblem, ...]:
    """Return the findings on the range of a predicate, and then on its continuity.

    If the check of the range needs too many steps or cases, continuity is not checked.
    """
    try:
        with step_limit(_MOST_STEPS - _STEPS_FOR_A_WITNESS):
            range_finding = _check_range(predicate)
    except TooManyCasesError:
        return (_find_wrong_range(predicate) or _unchecked_problem("range", _TOO_MANY_CASES),)
    except OutOfWorkError:
        return (_find_wrong_range(predicate) or _unchecked_problem("range", _TOO_LONG),)
    return tuple(
        finding for finding in (range_finding, _check_continuity_within_limits(predicate)) if finding is not None
    )


def _check_continuity_within_limits(predicate: Predicate) -> RangeProblem | None:
    try:
        return _check_continuity(predicate)
    except TooManyCasesError:
        return _unchecked_problem("continuity", _TOO_MANY_MEETINGS)
    except OutOfWorkError:
        return _unchecked_problem("continuity", _TOO_LONG)


_TOO_MANY_CASES = f"its `when` splits it into more than {LARGEST_NUMBER_OF_CASES} cases"
_TOO_MANY_MEETINGS = f"more than {MOST_MEETING_CASES} cases of its `when` may meet"


@record
class Predicate:
    """The predicate to check: its expression, the ranges of its variables, and its declared range.

    A variable is a signal or a param. ``box`` maps each to its range. ``bools`` are the variables that
    are bools, and ``stepped`` those that are bools or ints: their values change in steps, so a jump of the
    predicate there is no mistake.
    """

    expression: Expression
    box: Box
    bools: frozenset[Variable]
    stepped: frozenset[Variable]
    low: float
    high: float


def _check_range(predicate: Predicate) -> RangeProblem | None:
    whole = ConstrainedBox(predicate.box, {})
    low, high = predicate.low, predicate.high
    goals = [ProofGoal(case.value, case.constraints, low, high) for case in cases(predicate.expression)]
    goals += [
        ProofGoal(operand.value, operand.constraints, -inf, inf) for operand in condition_operands(predicate.expression)
    ]
    doubtful = unproved_goals(goals, whole)
    if not doubtful:
        return None
    wrong = _find_wrong_range(predicate)
    if wrong is not None:
        return wrong
    if _proves_exactly("range", predicate, doubtful, whole):
        return None
    return RangeProblem(
        "range_unproved", f"could not prove that the value stays in [{_number_text(low)}, {_number_text(high)}]"
    )


def _find_wrong_range(predicate: Predicate) -> RangeProblem | None:
    """Search for a point where the value leaves its range or is undefined, and return the finding.

    Returns None if the search finds no such point within its steps.
    """
    from tltlc.resolve.range_proof.witness import find_wrong_point

    try:
        witness = find_wrong_point(predicate.expression, predicate.box, predicate.bools, predicate.low, predicate.high)
    except OutOfWorkError:
        return None
    if witness is None:
        return None
    values = _by_name(witness.point)
    problem = witness.reason if witness.value is None else f"is {_number_text(witness.value)}"
    return RangeProblem("range_wrong", f"{_point_text(values)}the value {problem}", values, witness.is_undefined)


def _check_continuity(predicate: Predicate) -> RangeProblem | None:
    unproved_finding = RangeProblem(
        "continuity_unproved", "could not prove that the value is continuous between its `when` cases"
    )
    doubtful: list[ProofGoal] = []
    for when in whens(predicate.expression):
        goals = _doubtful_borders(when, predicate)
        if not goals:
            continue
        doubtful += goals
        from tltlc.resolve.range_proof.jumps import find_jump

        jump = find_jump(cases(when), predicate.expression, predicate.box, predicate.bools, predicate.stepped)
        if jump is not None:
            values = _by_name(jump.point)
            message = (
                f"{_point_text(values)}the value jumps from {_number_text(jump.before)} to {_number_text(jump.after)}"
            )
            return RangeProblem("discontinuous", message, values)
    if not doubtful or _proves_exactly("continuity", predicate, doubtful, ConstrainedBox(predicate.box, {})):
        return None
    return unproved_finding


def _doubtful_borders(when: When, predicate: Predicate) -> list[ProofGoal]:
    """Return a proof goal for each two cases of a ``when`` that may have different values where they meet.

    Pairs whose values are proved to be equal there without sympy are left out.
    """
    all_cases = cases(when)
    if len(all_cases) < 2:
        return []
    from tltlc.resolve.range_proof.continuity import agreement_goal, meetings, proves_agreement

    pairs = meetings(all_cases, ConstrainedBox(predicate.box, {}), predicate.stepped)
    return [agreement_goal(meeting) for meeting in pairs if not proves_agreement(meeting)]


def _proves_exactly(kind: str, predicate: Predicate, goals: Sequence[ProofGoal], whole: ConstrainedBox) -> bool:
    """Whether sympy can prove all ``goals``; uses the cached answer if the question is not new.

    ``kind`` is ``range`` or ``continuity``.
    """
    from tltlc.resolve.range_proof import proof_cache

    def compute() -> proof_cache.Answer:
        if sys.platform == "emscripten":
            # A browser has no sympy. Goals that only sympy can prove stay unproved.
            return proof_cache.Answer(False, 0)
        from tltlc.resolve.range_proof.exact import proves_all

        # Count these steps separately, so that the answer depends on the question alone and can be cached.
        with step_limit(_STEPS_OF_A_QUESTION, counts_outside=False) as work:
            try:
                proved = proves_all(goals, whole)
            except OutOfWorkError:
                proved = False
            return proof_cache.Answer(proved, _STEPS_OF_A_QUESTION - max(0, work.left))

    text = proof_cache.question(
        kind, predicate.expression, predicate.box, predicate.stepped, predicate.low, predicate.high
    )
    answer = proof_cache.answer(text, compute)
    spend(answer.steps)
    return answer.proved


def box_of(
    expression: Expression, signals: Mapping[str, spec.Signal], params: Mapping[str, spec.Param]
) -> tuple[Box, frozenset[Variable]]:
    """Return the ranges of the variables that the expression reads, and the variables that are bools."""
    box: dict[Variable, tuple[float, float]] = {}
    bools = set()
    for variable in variables(expression):
        declared = signals[variable.name] if isinstance(variable, SignalValue) else params[variable.name]
        if declared.type == "bool":
            bools.add(variable)
            box[variable] = (0.0, 1.0)
        else:
            least = -inf if declared.low is None else float(declared.low)
            most = inf if declared.high is None else float(declared.high)
            box[variable] = (least, most)
    return box, frozenset(bools)


def _ints(
    expression: Expression, signals: Mapping[str, spec.Signal], params: Mapping[str, spec.Param]
) -> frozenset[Variable]:
    """Return the variables of the expression that are ints."""
    return frozenset(
        variable
        for variable in variables(expression)
        if (signals[variable.name] if isinstance(variable, SignalValue) else params[variable.name]).type == "int"
    )


def _by_name(point: Mapping[Variable, float]) -> dict[str, float]:
    return {variable.name: value for variable, value in point.items()}


def _point_text(values: Mapping[str, float]) -> str:
    """Return the values of variables as the beginning of a message: ``with distance = 3, far = 2 ``.

    Returns an empty text if there are no variables.
    """
    if not values:
        return ""
    return "with " + ", ".join(f"{name} = {_number_text(value)}" for name, value in values.items()) + " "


def _number_text(value: float) -> str:
    return f"{round(value, 12) + 0.0:.6g}"  # adding 0 turns -0 into 0
