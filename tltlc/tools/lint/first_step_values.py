"""Find out what atoms about the trace so far say at the first step: `x > previous(x)` is false there."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

from tltlc.core.record import record, replace
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import (
    AtomValue,
    Before,
    Condition,
    Const,
    Expression,
    Op,
    SignalValue,
    StepLength,
    When,
    nodes,
)
from tltlc.logic.formula import Formula, and_, atom, not_
from tltlc.resolve.spec import Atom, Param, Register, Signal
from tltlc.tools.lint.atom_signs import can_be, is_always
from tltlc.tools.lint.file_view import SpecView

_MOST_NODES: Final = 200
_TRIES: Final = 40
"""Limits that keep lint rules fast: the most nodes of an expression, and the most samples before a proof is tried."""


@record
class _DeclaredSignals:
    signals: tuple[Signal, ...]
    params: tuple[Param, ...]
    registers: tuple[Register, ...] = ()


def known_at_first_step(spec: SpecView, names: Collection[str]) -> Formula:
    """Return those of the atoms ``names`` that read the trace so far and have one truth value at the first step.

    The result is a conjunction of atoms and negated atoms.
    """
    first = _FirstStep(spec)
    declared = _DeclaredSignals(spec.fspa.signals, spec.fspa.params)
    literals = []
    for candidate in spec.fspa.atoms:
        if candidate.name in names and first.reads_past(candidate.expression):
            expression = first.expression(candidate.expression)
            if expression is not None:
                value = replace(candidate, expression=expression)
                if not can_be("positive", value, declared, _TRIES) and is_always("not positive", value, declared):
                    literals.append(not_(atom(candidate.name)))
                elif not can_be("not positive", value, declared, _TRIES) and _is_positive(value, declared):
                    literals.append(atom(candidate.name))
    return and_(*literals)


def _is_positive(value: Atom, declared: _DeclaredSignals) -> bool:
    expression = value.expression
    return expression.value > 0 if isinstance(expression, Const) else is_always("positive", value, declared)


class _NotKnownError(Exception):
    """A value at the first step depends on the length of a step, which only a clock that varies asks for."""


class _FirstStep:
    """The values that registers and atoms have at the first step, as expressions of the signals there."""

    def __init__(self, spec: SpecView) -> None:
        self._registers = {register.name: register for register in spec.fspa.registers}
        self._atoms = {candidate.name: candidate for candidate in spec.fspa.atoms}

    def reads_past(self, expression: Expression) -> bool:
        return any(isinstance(node, SignalValue) and node.name in self._registers for node in nodes(expression))

    def expression(self, expression: Expression) -> Expression | None:
        """Return an expression without registers that has the same value at the first step, or None."""
        try:
            first = self._value(expression)
        except (RecursionError, _NotKnownError):
            return None
        return first if sum(1 for _ in nodes(first)) <= _MOST_NODES else None

    def _value(self, expression: Expression) -> Expression:
        match expression:
            case SignalValue(name=name) if name in self._registers:
                return self._value(self._registers[name].update)
            case Before(name=name):
                return Const(self._registers[name].initial)
            case AtomValue(name=name):
                return self._value(self._atoms[name].expression)
            case StepLength():
                raise _NotKnownError
            case Op():
                args = tuple(map(self._value, expression.args))
                folded = Op(expression.op, args)
                is_known = all(isinstance(argument, Const) for argument in args)
                return Const(evaluate(folded, {}, {})) if is_known else folded
            case When():
                return self._case(expression)
        return expression

    def _case(self, expression: When) -> Expression:
        cases = []
        for condition, value in expression.cases:
            truth = self._truth(condition)
            if truth is True:
                otherwise = self._value(value)
                break
            if truth is not False:
                cases.append((truth, self._value(value)))
        else:
            otherwise = self._value(expression.otherwise)
        return When(tuple(cases), otherwise) if cases else otherwise

    def _truth(self, condition: Condition) -> Condition | bool:
        """Return a condition at the first step, or its truth value if that is known."""
        if condition.op == "not":
            (part,) = condition.args
            assert isinstance(part, Condition)
            truth = self._truth(part)
            return not truth if isinstance(truth, bool) else Condition("not", (truth,))
        if condition.op in ("and", "or"):
            decisive = condition.op == "or"
            parts = [self._truth(part) for part in condition.args if isinstance(part, Condition)]
            unknown = tuple(part for part in parts if isinstance(part, Condition))
            if decisive in [part for part in parts if isinstance(part, bool)]:
                return decisive
            if len(unknown) < 2:
                return unknown[0] if unknown else not decisive
            return Condition(condition.op, unknown)
        sides = tuple(self._value(side) for side in condition.args if not isinstance(side, Condition))
        compared = Condition(condition.op, sides)
        if all(isinstance(side, Const) for side in sides):
            return evaluate(When(((compared, Const(1.0)),), Const(0.0)), {}, {}) > 0
        return compared
