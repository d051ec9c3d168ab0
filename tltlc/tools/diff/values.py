"""Whether two expressions have the same value at all samples, by a search for one at which they have not."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import TYPE_CHECKING, Final

from tltlc.core.record import record
from tltlc.expression.tree import Const, Expression, Op, nodes
from tltlc.expression.tree import Param as ParamNode
from tltlc.expression.tree import Signal as SignalNode

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.range_proof.region import Box, Variable
    from tltlc.resolve.spec import Param, Signal, Vocabulary

_ROUNDING: Final = 1e-9
"""How far apart two values may be that count as one."""


@record
class Meaning:
    """What the value of an atom is computed from; ``signals`` and ``params`` are those that the expression uses."""

    expression: Expression
    signals: tuple[Signal, ...]
    params: tuple[Param, ...]

    def at(self, sample: Mapping[str, float]) -> tuple[float | None, str]:
        """The value at a sample, as a monitor has it; None, and why, where it has none."""
        from tltlc.resolve.range_proof.witness import value_at

        point: dict[Variable, float] = {ParamNode(param.name): param.value for param in self.params}
        for signal in self.signals:
            low = -inf if signal.low is None else signal.low
            high = inf if signal.high is None else signal.high
            point[SignalNode(signal.name)] = min(max(sample[signal.name], low), high)
        found = value_at(self.expression, point)
        return (None if found.value is None else min(max(found.value, -1.0), 1.0)), found.reason


@record
class Apart:
    """A sample of signals at which two atoms have different values, or one of them has none, and then why."""

    sample: tuple[tuple[str, float], ...]
    values: tuple[float | None, float | None]
    reasons: tuple[str, str] = ("", "")

    @property
    def is_judged_otherwise(self) -> bool:
        """Whether one of the atoms holds there and the other does not."""
        one, other = (None if value is None else value > 0.0 for value in self.values)
        return one != other


def meaning(of: Fspa | Vocabulary, atom: int) -> Meaning:
    """What the value of an atom of an automaton or vocabulary is computed from."""
    return meaning_of(of.atoms[atom].expression, of.signals, of.params)


def meaning_of(expression: Expression, signals: tuple[Signal, ...], params: tuple[Param, ...]) -> Meaning:
    """What the value of an expression is computed from; of the signals and params those that it uses."""
    used = {(type(node), node.name) for node in nodes(expression) if isinstance(node, (SignalNode, ParamNode))}
    return Meaning(
        expression,
        tuple(signal for signal in signals if (SignalNode, signal.name) in used),
        tuple(param for param in params if (ParamNode, param.name) in used),
    )


def apart(one: Meaning, other: Meaning) -> Apart | None:
    """A sample at which the two have different values, one at which only one holds if there is such; None if none was
    found.  The search is deterministic and of bounded work, so it may miss one.
    """
    if _is_computed_alike(one, other):
        return None
    from tltlc.resolve.range_proof.witness import points

    box, bools = _shared(one, other)
    values = [Const(param.value) for param in (*one.params, *other.params)]
    found: Apart | None = None
    for point in points(Op("+", (one.expression, other.expression, *values)), box, bools):
        here = _at({variable.name: value for variable, value in point.items()}, one, other)
        if here is not None and here.is_judged_otherwise:
            return _shortened(here, one, other, box)
        found = found or here
    return found and _shortened(found, one, other, box)


def _shared(one: Meaning, other: Meaning) -> tuple[dict[Variable, tuple[float, float]], frozenset[Variable]]:
    """The values of signals that are in the ranges of both, and the signals that are bools.

    Where ranges have nothing in common, it is what lies between them: there, each of the two takes its own end.
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


def _shortened(found: Apart, one: Meaning, other: Meaning, box: Box) -> Apart:
    """The same with shorter numbers, if they lie in the box and show the same."""
    for digits in (2, 3, 4, 6):
        sample = {name: float(f"{value:.{digits}g}") for name, value in found.sample}
        is_inside = all(low <= sample[node.name] <= high for node, (low, high) in box.items())
        here = _at(sample, one, other) if is_inside else None
        if here is not None and here.is_judged_otherwise == found.is_judged_otherwise:
            return here
    return found


def _at(sample: Mapping[str, float], one: Meaning, other: Meaning) -> Apart | None:
    (first, why), (second, why_other) = one.at(sample), other.at(sample)
    here = Apart(tuple(sample.items()), (first, second), (why, why_other))
    if first is None or second is None:
        return None if first is second else here
    return here if here.is_judged_otherwise or abs(first - second) > _ROUNDING else None


def _is_computed_alike(one: Meaning, other: Meaning) -> bool:
    """Whether nothing differs by which a value could."""

    def computed(of: Meaning) -> object:
        ranges = {signal.name: (signal.low, signal.high) for signal in of.signals}
        return of.expression, ranges, {param.name: param.value for param in of.params}

    return computed(one) == computed(other)
