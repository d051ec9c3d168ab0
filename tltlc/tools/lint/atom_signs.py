"""Find out which signs the value of an atom can have.

The signals, params and registers of the atom may have any values within their ranges.
"""

from __future__ import annotations

from itertools import islice
from math import inf
from typing import Final, Literal, Protocol

from tltlc.io.limits import WORK
from tltlc.resolve.range_proof.cases import TooManyCasesError, cases
from tltlc.resolve.range_proof.check import box_of
from tltlc.resolve.range_proof.proof import TOLERANCE, ProofGoal, unproved_goals
from tltlc.resolve.range_proof.region import ConstrainedBox
from tltlc.resolve.range_proof.witness import points, value_at
from tltlc.resolve.range_proof.work_budget import OutOfWorkError, step_limit
from tltlc.resolve.spec import Atom, Param, Register, Signal

Sign = Literal["positive", "not positive", "negative", "not negative"]


class DeclaredNames(Protocol):
    """Anything that declares signals, params and registers, for example an automaton."""

    @property
    def signals(self) -> tuple[Signal, ...]:
        """The signals that atoms may read."""

    @property
    def params(self) -> tuple[Param, ...]:
        """The params that atoms may read."""

    @property
    def registers(self) -> tuple[Register, ...]:
        """The registers that atoms may read."""


_MOST_POINTS: Final = 600
_ABOVE_ZERO: Final = 1e3 * TOLERANCE
"""Proofs tolerate rounding errors. A value that is proved to be at least this is above 0."""

_RANGES: Final[dict[Sign, tuple[float, float]]] = {
    "positive": (_ABOVE_ZERO, inf),
    "not positive": (-inf, 0.0),
    "negative": (-inf, -_ABOVE_ZERO),
    "not negative": (0.0, inf),
}


def can_be(sign: Sign, atom: Atom, declarations: DeclaredNames, tries: int = _MOST_POINTS) -> bool:
    """Whether a search finds values of signals and params that give an atom a value of this sign.

    The search tries at most ``tries`` combinations of values. It does at most as much work as the
    compiler does to check a predicate. False means only that the search found no such values.
    """
    try:
        with step_limit(WORK["check of a predicate"]):
            box, bools = box_of(atom.expression, *_by_name(declarations))
            for point in islice(points(atom.expression, box, bools), tries):
                value = value_at(atom.expression, point).value
                if value is not None and _has_sign(sign, value):
                    return True
    except OutOfWorkError:
        pass
    return False


def is_always(sign: Sign, atom: Atom, declarations: DeclaredNames) -> bool:
    """Whether the value of an atom provably has this sign, whatever its signals and params are.

    False if the proof fails or takes too much work.
    """
    low, high = _RANGES[sign]
    try:
        with step_limit(WORK["check of a predicate"]):
            box, _ = box_of(atom.expression, *_by_name(declarations))
            goals = [ProofGoal(case.value, case.constraints, low, high) for case in cases(atom.expression)]
            return not unproved_goals(goals, ConstrainedBox(box, {}))
    except (OutOfWorkError, TooManyCasesError, RecursionError):
        return False


def _by_name(declarations: DeclaredNames) -> tuple[dict[str, Signal], dict[str, Param]]:
    registers = (Signal(each.name, "number", each.low, each.high) for each in declarations.registers)
    return (
        {signal.name: signal for signal in (*declarations.signals, *registers)},
        {param.name: param for param in declarations.params},
    )


def _has_sign(sign: Sign, value: float) -> bool:
    if sign == "positive":
        return value > 0
    if sign == "not positive":
        return value <= 0
    return value < 0 if sign == "negative" else value >= 0
