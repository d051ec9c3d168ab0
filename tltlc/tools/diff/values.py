"""Search for a sample at which two expressions have different values."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import TYPE_CHECKING, Final

from tltlc.core.record import record
from tltlc.expression.tree import Const, Expression, Op, nodes
from tltlc.expression.tree import ParamValue as ParamNode
from tltlc.expression.tree import SignalValue as SignalNode
from tltlc.resolve.spec import Signal

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.range_proof.region import Box, Variable
    from tltlc.resolve.spec import Param, Vocabulary

_ROUNDING: Final = 1e-9
"""Values that differ by no more than this count as equal."""


@record
class Meaning:
    """What determines the value of an atom: its expression, and the signals and params in the expression.

    Registers count as signals.
    """

    expression: Expression
    signals: tuple[Signal, ...]
    params: tuple[Param, ...]

    def value_at(self, sample: Mapping[str, float]) -> tuple[float | None, str]:
        """Return the value of the atom at a sample, in [-1, 1], as a monitor computes it.

        The text in the result is then empty. If the expression has no value at the sample, for
        example because it divides by zero, return None and the reason as a text.
        """
        from tltlc.resolve.range_proof.witness import value_at

        point: dict[Variable, float] = {ParamNode(param.name): param.value for param in self.params}
        for signal in self.signals:
            low = -inf if signal.low is None else signal.low
            high = inf if signal.high is None else signal.high
            point[SignalNode(signal.name)] = min(max(sample[signal.name], low), high)
        witness = value_at(self.expression, point)
        return (None if witness.value is None else min(max(witness.value, -1.0), 1.0)), witness.reason


@record
class ValueDifference:
    """A sample at which two atoms have different values.

    ``sample`` has the name and the value of each signal. ``values`` are the values of the two atoms.
    If an atom has no value at the sample, its entry in ``values`` is None, and its entry in
    ``reasons`` says why.
    """

    sample: tuple[tuple[str, float], ...]
    values: tuple[float | None, float | None]
    reasons: tuple[str, str] = ("", "")

    @property
    def differs_in_truth(self) -> bool:
        """Whether one of the atoms holds at the sample and the other does not."""
        one, other = (None if value is None else value > 0.0 for value in self.values)
        return one != other


def meaning(vocabulary: Fspa | Vocabulary, atom: int) -> Meaning:
    """Return the meaning of an atom; ``atom`` is its index in an automaton or vocabulary."""
    registers = (Signal(each.name, "number", each.low, each.high) for each in vocabulary.registers)
    return meaning_of(vocabulary.atoms[atom].expression, (*vocabulary.signals, *registers), vocabulary.params)


def meaning_of(expression: Expression, signals: tuple[Signal, ...], params: tuple[Param, ...]) -> Meaning:
    """Return the meaning of an expression, with only the signals and params that it uses."""
    used = {(type(node), node.name) for node in nodes(expression) if isinstance(node, (SignalNode, ParamNode))}
    return Meaning(
        expression,
        tuple(signal for signal in signals if (SignalNode, signal.name) in used),
        tuple(param for param in params if (ParamNode, param.name) in used),
    )


def value_difference(one: Meaning, other: Meaning) -> ValueDifference | None:
    """Return a sample at which two atoms have different values, or None if none was found.

    The search prefers samples at which only one of the atoms holds. It is deterministic, and its
    work is bounded, so it may miss a sample.
    """
    if _have_same_meaning(one, other):
        return None
    from tltlc.resolve.range_proof.witness import points

    box, bools = _common_box(one, other)
    values = [Const(param.value) for param in (*one.params, *other.params)]
    ints = {signal.name for signal in (*one.signals, *other.signals) if signal.type == "int"}
    fallback: ValueDifference | None = None
    for point in points(Op("+", (one.expression, other.expression, *values)), box, bools):
        sample = {variable.name: float(round(v)) if variable.name in ints else v for variable, v in point.items()}
        difference = _difference_at(sample, one, other)
        if difference is not None and difference.differs_in_truth:
            return _shorten(difference, one, other, box)
        fallback = fallback or difference
    return fallback and _shorten(fallback, one, other, box)


def _common_box(one: Meaning, other: Meaning) -> tuple[dict[Variable, tuple[float, float]], frozenset[Variable]]:
    """Return the interval in which to search the values of each signal, and the bool signals.

    If both atoms read a signal, the interval is the intersection of the two ranges of the signal. If
    these ranges do not overlap, it is the gap between them. At values in the gap, each atom clamps
    the signal to an end of its own range.
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


def _shorten(difference: ValueDifference, one: Meaning, other: Meaning, box: Box) -> ValueDifference:
    """Round the values in the sample of a difference to few digits, and return the difference there.

    The result has the same ``differs_in_truth`` as ``difference``, and its sample is in ``box``. If no
    rounding gives such a result, return ``difference`` itself.
    """
    for digits in (2, 3, 4, 6):
        sample = {name: float(f"{value:.{digits}g}") for name, value in difference.sample}
        is_inside = all(low <= sample[node.name] <= high for node, (low, high) in box.items())
        shorter = _difference_at(sample, one, other) if is_inside else None
        if shorter is not None and shorter.differs_in_truth == difference.differs_in_truth:
            return shorter
    return difference


def _difference_at(sample: Mapping[str, float], one: Meaning, other: Meaning) -> ValueDifference | None:
    (first, why), (second, why_other) = one.value_at(sample), other.value_at(sample)
    difference = ValueDifference(tuple(sample.items()), (first, second), (why, why_other))
    if first is None or second is None:
        return None if first is second else difference
    return difference if difference.differs_in_truth or abs(first - second) > _ROUNDING else None


def _have_same_meaning(one: Meaning, other: Meaning) -> bool:
    """Whether two atoms have the same expression, ranges and param values."""

    def key(meaning: Meaning) -> object:
        ranges = {signal.name: (signal.low, signal.high) for signal in meaning.signals}
        return meaning.expression, ranges, {param.name: param.value for param in meaning.params}

    return key(one) == key(other)
