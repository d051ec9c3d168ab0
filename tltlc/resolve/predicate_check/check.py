"""Checks a predicate: is its value within the declared range, and is it continuous between ``when`` cases?

Every answer is one of three: proved (no finding), wrong at a concrete point, or unproved.  The
means, cheapest first: interval arithmetic, a search for a wrong point, exact signs and subdivision,
remembered answers, sympy.  Only the last imports it.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from math import inf
from typing import Literal

from tltlc.expression import Expression, Signal, When
from tltlc.record import record
from tltlc.resolve import spec
from tltlc.resolve.predicate_check.cases import TooManyCasesError, cases, condition_operands, size, variables, whens
from tltlc.resolve.predicate_check.proof import Task, unproved
from tltlc.resolve.predicate_check.region import Box, Region, Variable

FindingKind = Literal["range_wrong", "range_unproved", "discontinuous", "continuity_unproved"]


_NO_POINT: Mapping[str, float] = {}


@record
class Finding:
    """What is wrong with a predicate, or could not be shown.

    ``witness`` gives the value of each signal and param at the point that ``message`` speaks of; it is
    empty where the kind ends in ``unproved``.
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
    that is None is open.  At most one finding on the range and one on continuity.  Never raises.
    """
    if size(expression, _LARGEST_SIZE) > _LARGEST_SIZE:
        return (_TOO_LARGE,)
    box, bools = box_of(expression, signals, params)
    predicate = Predicate(expression, box, bools, low, high)
    try:
        found = (_check_range(predicate), _check_continuity(predicate))
    except (TooManyCasesError, RecursionError):
        return (_TOO_LARGE,)
    return tuple(finding for finding in found if finding is not None)


_LARGEST_SIZE = 2000
_TOO_LARGE = Finding("range_unproved", "the expression is too large to check")


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
    from tltlc.resolve.predicate_check.witness import find_outside

    witness = find_outside(predicate.expression, predicate.box, predicate.bools, low, high)
    if witness is not None:
        values = _by_name(witness.point)
        what = witness.reason if witness.value is None else f"is {_number(witness.value)}"
        return Finding("range_wrong", f"{_where(values)}the value {what}", values)
    if _proves_exactly("range", predicate, doubtful, whole):
        return None
    return Finding("range_unproved", f"could not prove that the value stays in [{_number(low)}, {_number(high)}]")


def _check_continuity(predicate: Predicate) -> Finding | None:
    unproved_finding = Finding(
        "continuity_unproved", "could not prove that the value is continuous between its `when` cases"
    )
    doubtful: list[Task] = []
    for when in whens(predicate.expression):
        try:
            tasks = _doubtful_borders(when, predicate)
        except TooManyCasesError:
            return unproved_finding
        if not tasks:
            continue
        doubtful += tasks
        from tltlc.resolve.predicate_check.jumps import find_jump

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
    from tltlc.resolve.predicate_check.continuity import agreement, meetings, proves_agreement

    found = meetings(all_cases, Region(predicate.box, {}), predicate.bools)
    return [agreement(meeting) for meeting in found if not proves_agreement(meeting)]


def _proves_exactly(kind: str, predicate: Predicate, tasks: Sequence[Task], whole: Region) -> bool:
    """True if sympy proves the tasks that are left of a question, or once did."""
    from tltlc.resolve.predicate_check import memory

    def compute() -> bool:
        if sys.platform == "emscripten":
            # A browser has no sympy: what it alone could prove stays unproved.
            return False
        from tltlc.resolve.predicate_check.exact import proves_all

        return proves_all(tasks, whole)

    text = memory.question(kind, predicate.expression, predicate.box, predicate.bools, predicate.low, predicate.high)
    return memory.answer(text, compute)


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
