"""Search for a sample at which two expressions have different values."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import TYPE_CHECKING, Final

from tltlc.core.record import record
from tltlc.expression.tree import Const, Expression, Op, nodes
from tltlc.expression.tree import ParamValue as ParamNode
from tltlc.expression.tree import SignalValue as SignalNode

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.range_proof.region import Box, Variable
    from tltlc.resolve.spec import Param, Signal, Vocabulary

_ROUNDING: Final = 1e-9
"""Values that differ by no more than this count as equal."""


@record
class Meaning:
    """What the value of an atom is computed from.

    ``signals`` and ``params`` are those that the expression uses.
    """

    expression: Expression
    signals: tuple[Signal, ...]
    params: tuple[Param, ...]

    def at(self, sample: Mapping[str, float]) -> tuple[float | None, str]:
        """Return the value at a sample, as a monitor computes it, or None and the reason."""
        from tltlc.resolve.range_proof.witness import value_at

        point: dict[Variable, float] = {ParamNode(param.name): param.value for param in self.params}
        for signal in self.signals:
            low = -inf if signal.low is None else signal.low
            high = inf if signal.high is None else signal.high
            point[SignalNode(signal.name)] = min(max(sample[signal.name], low), high)
        witness = value_at(self.expression, point)
        return (None if witness.value is None else min(max(witness.value, -1.0), 1.0)), witness.reason


@record
class Apart:
    """A sample at which two atoms have different values.

    If one of the atoms has no value there, its reason says why.
    """

    sample: tuple[tuple[str, float], ...]
    values: tuple[float | None, float | None]
    reasons: tuple[str, str] = ("", "")

    @property
    def is_judged_otherwise(self) -> bool:
        """Whether one of the atoms holds at the sample and the other does not."""
        one, other = (None if value is None else value > 0.0 for value in self.values)
        return one != other


def meaning(of: Fspa | Vocabulary, atom: int) -> Meaning:
    """Return what the value of an atom of an automaton or vocabulary is computed from."""
    return meaning_of(of.atoms[atom].expression, of.signals, of.params)


def meaning_of(expression: Expression, signals: tuple[Signal, ...], params: tuple[Param, ...]) -> Meaning:
    """Return what the value of an expression is computed from.

    It has only those of the signals and params that the expression uses.
    """
    used = {(type(node), node.name) for node in nodes(expression) if isinstance(node, (SignalNode, ParamNode))}
    return Meaning(
        expression,
        tuple(signal for signal in signals if (SignalNode, signal.name) in used),
        tuple(param for param in params if (ParamNode, param.name) in used),
    )


def apart(one: Meaning, other: Meaning) -> Apart | None:
    """Return a sample at which the two have different values, or None if none was found.

    A sample at which only one of them holds is preferred. The search is deterministic and its work
    is bounded, so it may miss a sample.
    """
    if _is_computed_alike(one, other):
        return None
    from tltlc.resolve.range_proof.witness import points

    box, bools = _shared(one, other)
    values = [Const(param.value) for param in (*one.params, *other.params)]
    fallback: Apart | None = None
    for point in points(Op("+", (one.expression, other.expression, *values)), box, bools):
        difference = _at({variable.name: value for variable, value in point.items()}, one, other)
        if difference is not None and difference.is_judged_otherwise:
            return _shortened(difference, one, other, box)
        fallback = fallback or difference
    return fallback and _shortened(fallback, one, other, box)


def _shared(one: Meaning, other: Meaning) -> tuple[dict[Variable, tuple[float, float]], frozenset[Variable]]:
    """Return the signal values in the ranges of both, and which signals are bools.

    If two ranges do not overlap, the values between them are used: there, each of the two clamps a
    value to its own end.
    """
    ends: dict[SignalNode, list[tuple[float, float]]] = {}
    numbers: set[SignalNode] = set()
    for signal in (*one.signals, *other.signals):
        node = SignalNode(signal.name)
        ends.setdefault(node, []).append(
            (-inf if signal.low is None else signal.low, inf if signal.high is None else signal.high)
        )
        if signal.type != "bool":
            numbers.add(node)
    box: dict[Variable, tuple[float, float]] = {}
    for node, ranges in ends.items():
        low, high = sorted((max(low for low, _ in ranges), min(high for _, high in ranges)))
        box[node] = low, high
    return box, frozenset(node for node in ends if node not in numbers)


def _shortened(difference: Apart, one: Meaning, other: Meaning, box: Box) -> Apart:
    """Return the same result with shorter numbers, if they are in the box and show the same."""
    for digits in (2, 3, 4, 6):
        sample = {name: float(f"{value:.{digits}g}") for name, value in difference.sample}
        is_inside = all(low <= sample[node.name] <= high for node, (low, high) in box.items())
        shorter = _at(sample, one, other) if is_inside else None
        if shorter is not None and shorter.is_judged_otherwise == difference.is_judged_otherwise:
            return shorter
    return difference


def _at(sample: Mapping[str, float], one: Meaning, other: Meaning) -> Apart | None:
    (first, why), (second, why_other) = one.at(sample), other.at(sample)
    difference = Apart(tuple(sample.items()), (first, second), (why, why_other))
    if first is None or second is None:
        return None if first is second else difference
    return difference if difference.is_judged_otherwise or abs(first - second) > _ROUNDING else None


def _is_computed_alike(one: Meaning, other: Meaning) -> bool:
    """Whether the two have the same expression, ranges and param values."""

    def computed(of: Meaning) -> object:
        ranges = {signal.name: (signal.low, signal.high) for signal in of.signals}
        return of.expression, ranges, {param.name: param.value for param in of.params}

    return computed(one) == computed(other)
