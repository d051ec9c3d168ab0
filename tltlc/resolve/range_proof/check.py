"""Checks a predicate: is its value within the declared range, and is it continuous between ``when`` cases?

Every answer is one of four: proved (no finding), wrong at a concrete point, unproved, or unchecked, where the answer
would take more work than a check may do.  The means, cheapest first: interval arithmetic, a search for a wrong point,
exact signs and subdivision, remembered answers, sympy.  Only the last imports it.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from math import inf
from typing import Literal

from tltlc.core.record import record
from tltlc.expression.tree import Expression, Signal, When
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
from tltlc.resolve.range_proof.proof import Task, unproved
from tltlc.resolve.range_proof.region import Box, Region, Variable
from tltlc.resolve.range_proof.work import OutOfWorkError, limited, spend

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
class Finding:
    """What is wrong with a predicate, or could not be shown.

    ``witness`` gives the value of each signal and param at the point that ``message`` speaks of; it is
    empty where the kind ends in ``unproved`` or ``unchecked``.
    """

    kind: FindingKind
    message: str
    witness: Mapping[str, float] = _NO_POINT


def check_predicate(
    expression: Expression,
    signals: Mapping[str, spec.Signal],
    params: Mapping[str, spec.Param],
    low: float,
    high: float,
) -> tuple[Finding, ...]:
    """The findings on a predicate whose declared range is ``[low, high]``, for all signal and param values.

    ``signals`` and ``params`` hold at least those that the expression reads, by name; an end of a range
    that is None is open.  At most one finding on the range and one on continuity.  Takes a bounded number of steps
    and never raises.
    """
    with limited(_MOST_STEPS):
        if size(expression, LARGEST_SIZE) > LARGEST_SIZE:
            return (_unchecked("range", f"it has more than {LARGEST_SIZE:,} operands and operators"),)
        try:
            box, bools = box_of(expression, signals, params)
            return _findings(Predicate(expression, box, bools, low, high))
        except (RecursionError, OutOfWorkError):
            return (_unchecked("range", _TOO_LONG),)


LARGEST_SIZE = 2000
_MOST_STEPS = WORK["check of a predicate"]
_STEPS_FOR_A_WITNESS = _MOST_STEPS // 3
"""What is left for a search for a wrong point after a proof has been given up."""
_STEPS_OF_A_QUESTION = _MOST_STEPS // 3
"""What a proof with sympy may take."""
_TOO_LONG = f"the check takes too many steps: {_MOST_STEPS:,} are allowed"


def _unchecked(what: Literal["range", "continuity"], why: str) -> Finding:
    return Finding("range_unchecked" if what == "range" else "continuity_unchecked", why)


def _findings(predicate: Predicate) -> tuple[Finding, ...]:
    """On the range, then on continuity; only where the former can be checked is the latter."""
    try:
        with limited(_MOST_STEPS - _STEPS_FOR_A_WITNESS):
            found = _check_range(predicate)
    except TooManyCasesError:
        return (_wrong(predicate) or _unchecked("range", _TOO_MANY_CASES),)
    except OutOfWorkError:
        return (_wrong(predicate) or _unchecked("range", _TOO_LONG),)
    return tuple(finding for finding in (found, _bounded_continuity(predicate)) if finding is not None)


def _bounded_continuity(predicate: Predicate) -> Finding | None:
    try:
        return _check_continuity(predicate)
    except TooManyCasesError:
        return _unchecked("continuity", _TOO_MANY_MEETINGS)
    except OutOfWorkError:
        return _unchecked("continuity", _TOO_LONG)


_TOO_MANY_CASES = f"its `when` splits it into more than {LARGEST_NUMBER_OF_CASES} cases"
_TOO_MANY_MEETINGS = f"more than {MOST_MEETING_CASES} cases of its `when` may meet"


@record
class Predicate:
    """What is checked: the value, where its variables range, which of them are bools, the declared range."""

    expression: Expression
    box: Box
    bools: frozenset[Variable]
    low: float
    high: float


def _check_range(predicate: Predicate) -> Finding | None:
    whole = Region(predicate.box, {})
    low, high = predicate.low, predicate.high
    tasks = [Task(case.value, case.constraints, low, high) for case in cases(predicate.expression)]
    tasks += [Task(o.value, o.constraints, -inf, inf) for o in condition_operands(predicate.expression)]
    doubtful = unproved(tasks, whole)
    if not doubtful:
        return None
    wrong = _wrong(predicate)
    if wrong is not None:
        return wrong
    if _proves_exactly("range", predicate, doubtful, whole):
        return None
    return Finding("range_unproved", f"could not prove that the value stays in [{_number(low)}, {_number(high)}]")


def _wrong(predicate: Predicate) -> Finding | None:
    """A point at which the value leaves its range, or has none, as far as the search gets."""
    from tltlc.resolve.range_proof.witness import find_outside

    try:
        witness = find_outside(predicate.expression, predicate.box, predicate.bools, predicate.low, predicate.high)
    except OutOfWorkError:
        return None
    if witness is None:
        return None
    values = _by_name(witness.point)
    what = witness.reason if witness.value is None else f"is {_number(witness.value)}"
    return Finding("range_wrong", f"{_where(values)}the value {what}", values)


def _check_continuity(predicate: Predicate) -> Finding | None:
    unproved_finding = Finding(
        "continuity_unproved", "could not prove that the value is continuous between its `when` cases"
    )
    doubtful: list[Task] = []
    for when in whens(predicate.expression):
        tasks = _doubtful_borders(when, predicate)
        if not tasks:
            continue
        doubtful += tasks
        from tltlc.resolve.range_proof.jumps import find_jump

        jump = find_jump(cases(when), predicate.expression, predicate.box, predicate.bools)
        if jump is not None:
            values = _by_name(jump.point)
            message = f"{_where(values)}the value jumps from {_number(jump.before)} to {_number(jump.after)}"
            return Finding("discontinuous", message, values)
    if not doubtful or _proves_exactly("continuity", predicate, doubtful, Region(predicate.box, {})):
        return None
    return unproved_finding


def _doubtful_borders(when: When, predicate: Predicate) -> list[Task]:
    """What is left to prove where the cases of a ``when`` meet."""
    all_cases = cases(when)
    if len(all_cases) < 2:
        return []
    from tltlc.resolve.range_proof.continuity import agreement, meetings, proves_agreement

    found = meetings(all_cases, Region(predicate.box, {}), predicate.bools)
    return [agreement(meeting) for meeting in found if not proves_agreement(meeting)]


def _proves_exactly(kind: str, predicate: Predicate, tasks: Sequence[Task], whole: Region) -> bool:
    """True if sympy proves the tasks that are left of a question, or once did."""
    from tltlc.resolve.range_proof import memory

    def compute() -> memory.Answer:
        if sys.platform == "emscripten":
            # A browser has no sympy: what it alone could prove stays unproved.
            return memory.Answer(False, 0)
        from tltlc.resolve.range_proof.exact import proves_all

        # Apart from all other work, so that the answer depends on the question alone and can be remembered.
        with limited(_STEPS_OF_A_QUESTION, counts_outside=False) as work:
            try:
                proved = proves_all(tasks, whole)
            except OutOfWorkError:
                proved = False
            return memory.Answer(proved, _STEPS_OF_A_QUESTION - max(0, work.left))

    text = memory.question(kind, predicate.expression, predicate.box, predicate.bools, predicate.low, predicate.high)
    found = memory.answer(text, compute)
    spend(found.steps)
    return found.proved


def box_of(
    expression: Expression, signals: Mapping[str, spec.Signal], params: Mapping[str, spec.Param]
) -> tuple[Box, frozenset[Variable]]:
    """The ranges of the variables that the expression reads, and those variables that are bools."""
    box: dict[Variable, tuple[float, float]] = {}
    bools = set()
    for variable in variables(expression):
        declared = signals[variable.name] if isinstance(variable, Signal) else params[variable.name]
        if declared.type == "bool":
            bools.add(variable)
            box[variable] = (0.0, 1.0)
        else:
            least = -inf if declared.low is None else float(declared.low)
            most = inf if declared.high is None else float(declared.high)
            box[variable] = (least, most)
    return box, frozenset(bools)


def _by_name(point: Mapping[Variable, float]) -> dict[str, float]:
    return {variable.name: value for variable, value in point.items()}


def _where(values: Mapping[str, float]) -> str:
    """``with distance = 3, far = 2 ``, or nothing where there are no variables."""
    if not values:
        return ""
    return "with " + ", ".join(f"{name} = {_number(value)}" for name, value in values.items()) + " "


def _number(value: float) -> str:
    return f"{round(value, 12) + 0.0:.6g}"  # adding 0 turns -0 into 0
