"""Find what atoms say about timers at the step that resets them: where p holds, `time_since(p) >= 2 s` does not."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Final

from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import AtomValue, Condition, Const, Expression, Op, ParamValue, SignalValue, When, nodes
from tltlc.logic.formula import Formula, always, and_, atom, not_
from tltlc.resolve.spec import Atom, Conjunct, Register
from tltlc.tools.lint.file_view import SpecView

_TIMERS: Final = ("time_since", "time_holding")


def timer_relations(spec: SpecView, names: Collection[str]) -> tuple[Conjunct, ...]:
    """Return clauses ``G !(p & q)`` of the atoms ``names``: where p holds, a timer that q reads is 0.

    Each of p and q is an atom or a negated atom.
    """
    formulas = (always(not_(pair)) for pair in _impossible_pairs(spec, names))
    return tuple(Conjunct(formula, spec.spec.source, spec.spec.name_span) for formula in formulas)


def readers(spec: SpecView, names: Collection[str]) -> Iterator[tuple[Register, Atom]]:
    """Yield each timer with each atom, of the atoms ``names``, that depends on this timer alone."""
    atoms = [candidate for candidate in spec.fspa.atoms if candidate.name in names]
    for timer in spec.fspa.registers:
        if timer.kind in _TIMERS:
            yield from ((timer, candidate) for candidate in atoms if _reads_only(candidate, timer))


def _impossible_pairs(spec: SpecView, names: Collection[str]) -> Iterator[Formula]:
    atoms = [candidate for candidate in spec.fspa.atoms if candidate.name in names]
    for timer, reader in readers(spec, names):
        for candidate in atoms:
            for holds in (True, False):
                value = _value(timer.update, {candidate.name: holds})
                if value is not None:
                    is_true = evaluate(reader.expression, {timer.name: value}, {}) > 0
                    yield and_(_literal(candidate, holds), _literal(reader, not is_true))


def _literal(candidate: Atom, holds: bool) -> Formula:
    return atom(candidate.name) if holds else not_(atom(candidate.name))


def _reads_only(candidate: Atom, timer: Register) -> bool:
    """Whether a timer is all that an atom depends on."""
    read = {node.name for node in nodes(candidate.expression) if isinstance(node, (SignalValue, ParamValue))}
    return read == {timer.name}


def _value(expression: Expression, literals: dict[str, bool]) -> float | None:
    """Return the value of an update if the truth of some atoms determines it, else None."""
    if isinstance(expression, Const):
        return expression.value
    if isinstance(expression, Op) and expression.op == "min":
        values = [_value(argument, literals) for argument in expression.args]
        return min((value for value in values if value is not None), default=None) if None not in values else None
    if not isinstance(expression, When):
        return None
    for condition, result in expression.cases:
        truth = _truth(condition, literals)
        if truth is not False:
            return _value(result, literals) if truth else None
    return _value(expression.otherwise, literals)


def _truth(condition: Expression | Condition, literals: dict[str, bool]) -> bool | None:
    """Return whether a condition holds if the truth of some atoms determines it, else None."""
    if not isinstance(condition, Condition):
        return None
    if condition.op in ("and", "or", "not"):
        parts = [_truth(part, literals) for part in condition.args]
        if condition.op == "not":
            return None if parts[0] is None else not parts[0]
        decisive = condition.op == "or"
        return decisive if decisive in parts else None if None in parts else not decisive
    left, right = condition.args
    if not isinstance(left, AtomValue) or right != Const(0.0) or condition.op not in (">", "<="):
        return None
    holds = literals.get(left.name)
    return None if holds is None else holds == (condition.op == ">")
