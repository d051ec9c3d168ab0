"""Find the atoms and registers that are only ever -1 or 1, which a monitor computes as Booleans: *flags*.

The atom of a bool signal is such a number, and so is everything that a monitor remembers of it, as in
``once key`` or ``begins damage``. They are found by induction over the samples: if all registers that
are taken for flags are -1 or 1 before a sample, then they are after it, too.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import Final, Literal, Union

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import Computation
from tltlc.expression.tree import (
    AtomValue,
    Before,
    Condition,
    Const,
    Expression,
    Op,
    ParamValue,
    SignalValue,
    VariableKey,
    When,
    nodes,
    variable_key,
)
from tltlc.resolve import registers

_BOOL: Final = frozenset((0.0, 1.0))
_FLAG: Final = frozenset((-1.0, 1.0))
_WITHIN: Final = (_FLAG, frozenset((-1.0,)), frozenset((1.0,)))
_MOST: Final = 4
"""The most values of an expression that are listed."""

_Values = Union[frozenset[float], None]
_Truth = Union[Condition, bool]
"""A condition, or what is known to be true or false."""


class Flags:
    """The atoms and registers of an automaton that are -1 or 1 at every sample, by the keys of their values.

    A register is among them as it is before the sample, too. ``order`` is the order in which a monitor
    computes atoms and registers. The atoms whose names are in ``given`` are taken for flags, too, such as those of
    enums, which are -1 or 1 if the game supplies whole numbers.
    """

    def __init__(self, fspa: Fspa, order: Sequence[Computation], given: Collection[str] = ()) -> None:
        self._fspa, self._order, self._given = fspa, order, given
        taken = {register.name for register in fspa.registers if register.initial in _FLAG}
        while True:
            self._values = _Valuation(_known(fspa, taken))
            left = taken - self._one_sample(taken)
            if not left:
                break
            taken -= left

    def _one_sample(self, taken: Iterable[str]) -> set[str]:
        """Find the flags after a sample, before which the registers in ``taken`` are flags; return these registers."""
        flags: set[str] = set()
        for step in self._order:
            if step.kind == "atom":
                atom = self._fspa.atoms[step.index]
                if atom.name in self._given or self._values.of(atom.expression) in _WITHIN:
                    self._values.known[AtomValue(atom.name)] = _FLAG
            else:
                register = self._fspa.registers[step.index]
                if register.name in taken and self._values.of(register.update) in _WITHIN:
                    self._values.known[register.name] = _FLAG
                    flags.add(register.name)
        return flags

    def __contains__(self, key: VariableKey) -> bool:
        return self._values.known.get(key) == _FLAG

    def is_flag(self, node: Expression) -> bool:
        """Whether an expression is -1 or 1 at every sample."""
        return self.values(node) in _WITHIN

    def values(self, node: Expression) -> frozenset[float] | None:
        """Return the values that an expression may have; None if they are too many, or not known."""
        return self._values.of(node)


def _known(fspa: Fspa, taken: Iterable[str]) -> dict[VariableKey, frozenset[float]]:
    known: dict[VariableKey, frozenset[float]] = {
        signal.name: _BOOL for signal in fspa.signals if signal.type == "bool"
    }
    return known | {Before(name): _FLAG for name in taken}


class _Valuation:
    """Lists the values that expressions may have; None if there are too many, or if this is not known.

    ``known`` has the values of variables. More may be added, but an expression that reads them must not have
    been asked for before.
    """

    def __init__(self, known: dict[VariableKey, frozenset[float]]) -> None:
        self.known = known
        self._done: dict[Expression, _Values] = {}

    def of(self, node: Expression) -> _Values:
        """Return the values that an expression may have."""
        if node not in self._done:
            self._done[node] = self._of(node)
        return self._done[node]

    def _of(self, node: Expression) -> _Values:
        match node:
            case Const(value):
                return frozenset((float(value),))
            case SignalValue() | AtomValue() | Before():
                return self.known.get(variable_key(node))
            case When():
                return self._when(node)
            case Op("+" | "-" | "*" | "neg" | "min" | "max", args):
                values = self.of(args[0])
                if node.op == "neg":
                    return values and frozenset(-value for value in values)
                for part in args[1:]:
                    others = self.of(part)
                    if values is None or others is None:
                        return None
                    values = _few(_result(node.op, left, right) for left in values for right in others)
                return values
        return None

    def _when(self, node: When) -> _Values:
        opposite = negation_operand(node)
        if opposite is not None:
            values = self.of(opposite)
            return None if values is None or 0.0 in values else frozenset(-value for value in values)
        # A condition must not fail, since the truth of a `when` may test it twice, or not at all.
        if not all(is_plain(condition) for condition, _ in node.cases):
            return None
        all_values: set[float] = set()
        for value in (*(value for _, value in node.cases), node.otherwise):
            values = self.of(value)
            if values is None:
                return None
            all_values |= values
        return _few(all_values)


def _few(values: Iterable[float]) -> _Values:
    distinct = frozenset(values)
    return distinct if len(distinct) <= _MOST else None


def _result(op: str, left: float, right: float) -> float:
    match op:
        case "min" | "max":
            return min(left, right) if op == "min" else max(left, right)
        case "+" | "-":
            return left + right if op == "+" else left - right
    return left * right


def negation_operand(node: When) -> Expression | None:
    """Return the operand of an expression that :func:`tltlc.resolve.registers.negated` has made; None for others."""
    (_, value), *others = node.cases
    if not others and isinstance(value, Op) and value.op == "neg" and node == registers.negated(value.args[0]):
        return value.args[0]
    return None


def is_plain(condition: Condition) -> bool:
    """Whether a condition compares numbers that exist and are finite, without arithmetic that may fail."""
    plain = (Condition, Const, SignalValue, ParamValue, AtomValue, Before)
    return all(
        isinstance(node, plain) or (isinstance(node, Op) and node.op in ("neg", "min", "max"))
        for node in nodes(condition)
    )


class Truths:
    """Turns expressions into conditions that are true where the expressions are above 0."""

    def __init__(self, flags: Flags) -> None:
        self._flags = flags
        self._done: dict[Expression, _Truth] = {}

    def condition(self, node: Expression) -> Condition:
        """Return the condition for an expression that is a flag."""
        condition = self._of(node)
        return registers.holds(Const(1.0 if condition else -1.0)) if isinstance(condition, bool) else condition

    def splits(self, node: Expression) -> bool:
        """Whether an expression is a flag, and its condition has none of its arithmetic."""
        is_joined = isinstance(node, When) or (isinstance(node, Op) and node.op in ("min", "max", "neg"))
        return is_joined and self._flags.is_flag(node)

    def _of(self, node: Expression) -> _Truth:
        if node not in self._done:
            self._done[node] = self._compute(node)
        return self._done[node]

    def _compute(self, node: Expression) -> _Truth:
        values = self._flags.values(node)
        assert values, "a part of a flag has few values"
        if max(values) <= 0.0 or min(values) > 0.0:
            return min(values) > 0.0
        match node:
            case Op("min" | "max", args):
                return _joined("and" if node.op == "min" else "or", [self._of(part) for part in args])
            case When():
                opposite = negation_operand(node)
                return self._when(node) if opposite is None else _not(self._of(opposite))
            case Op("neg", (operand,)) if 0.0 not in values:
                return _not(self._of(operand))
            case Op("+" | "-", (Op("*", (Const(factor), SignalValue() as signal)), Const(offset))):
                # Of a bool signal, since no other has few values: it is 0 or 1.
                first = -offset if node.op == "-" else offset
                if first <= 0.0 < first + factor:
                    return registers.holds(signal)
        return registers.holds(node)

    def _when(self, node: When) -> _Truth:
        result = self._of(node.otherwise)
        for condition, value in reversed(node.cases):
            inside = _joined("and", [condition, self._of(value)])
            outside = _joined("and", [_not(condition), result]) if inside is not condition else result
            result = _joined("or", [inside, outside])
        return result


def _not(truth: _Truth) -> _Truth:
    if isinstance(truth, bool):
        return not truth
    return truth.args[0] if truth.op == "not" else Condition("not", (truth,))  # type: ignore[return-value]


def _joined(op: Literal["and", "or"], truths: Iterable[_Truth]) -> _Truth:
    """Return the ``and`` or ``or`` of conditions, without those that are known."""
    decides = op == "or"
    open_: list[Condition] = []
    for truth in truths:
        if truth is decides:
            return decides
        if isinstance(truth, Condition):
            open_.append(truth)
    if not open_:
        return not decides
    return open_[0] if len(open_) == 1 else Condition(op, tuple(open_))
