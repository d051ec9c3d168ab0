"""Take formulas apart as the clauses of a sentence need them: lists, rules, conditions and what follows from them."""

from __future__ import annotations

from tltlc.core.names import ComparisonName
from tltlc.logic import formula as build
from tltlc.logic.bounded_operators import bounded_operator, operands_with_bounds, opposite
from tltlc.logic.formula import FALSE, TRUE, Formula
from tltlc.logic.implication import complement
from tltlc.logic.normal_form import negation_normal_form, outermost_operators
from tltlc.logic.text.phrases import is_state
from tltlc.logic.text.sequences import next_goal


def listed_parts(node: Formula, *, states_first: bool = False) -> list[Formula]:
    """Return the operands of an ``and`` or ``or``, with all operands without temporal operators joined to one.

    The joined operand stands in the place of the first of them: ``a & F p & b`` gives ``a & b`` and
    ``F p``. If ``states_first``, it comes first: behind ``F p``, "at that step" would be the step with p.
    """
    make = build.and_ if node.op == "and" else build.or_
    operands = operands_with_bounds(node)
    states = [part for part in operands if is_state(part)]
    parts: list[Formula] = []
    for part in operands:
        if not is_state(part):
            parts.append(part)
        elif part is states[0]:
            parts.append(make(*states))
    return sorted(dict.fromkeys(parts), key=lambda part: states_first and not is_state(part))


def has_rules(body: Formula) -> bool:
    """Whether the clause of ``G body`` lists the operands of ``body`` one by one."""
    return body.op == "and" and not all(part.op == "atom" for part in body.args)


def rules_of(body: Formula) -> list[Formula]:
    """Return the operands of an ``and``, with all atoms joined to one operand.

    The joined operand stands in the place of the first atom: ``a & !c & b`` gives ``a & b`` and
    ``!c``.
    """
    atoms = [part for part in body.args if part.op == "atom"]
    joined = build.and_(*atoms)
    parts = [joined if part.op == "atom" else part for part in body.args]
    return list(dict.fromkeys(parts))


def is_condition(body: Formula) -> bool:
    """Whether the clause of ``G body`` names one thing to keep or to avoid."""
    return is_state(body) and body.op != "implies" and not has_rules(body)


def avoided_sequence(body: Formula) -> Formula | None:
    """Return ``a & X F(b & X F c)`` if ``G body`` forbids this sequence of three goals or more; None if it does not."""
    if not _may_be_sequence(body):
        return None
    sequence = negation_normal_form(build.not_(body))
    goals = [sequence]
    while (following := next_goal(goals[-1])) is not None:
        goals.append(following.body)
    return sequence if len(goals) > 2 and is_state(goals[-1]) else None


def _may_be_sequence(body: Formula) -> bool:
    """Whether the negation of a formula may be three goals in a row: the normal form of a long one takes long."""
    operator, operands = outermost_operators(body, negated=True)
    temporal = [(inner, part) for inner, part in operands if not is_state(part)]
    if operator != "and" or len(temporal) != 1:
        return False
    ((inner, part),) = temporal
    bound = bounded_operator(part.args[0]) if inner == "X" else None
    return inner in ("F", "X") and (bound is None or not is_state(bound.body))


def instructed(state: Formula) -> Formula:
    """Return a condition as it is best asked for: ``!(a & b)`` for ``!a | !b``, and any other unchanged."""
    first = state.args[0] if state.op == "or" else state
    if first is state or first.op != "not" or isinstance(first.args[0].name, ComparisonName):
        return state
    return build.not_(build.and_(*(negation(part) for part in state.args)))


def implication(body: Formula) -> tuple[Formula | None, Formula | None]:
    """Return the condition ``a`` and the consequence ``p`` if ``body`` has the form ``a -> p`` or ``!a | p``.

    The condition has no temporal operator. For any other body, both are None.
    """
    if body.op == "implies" and is_state(body.args[0]):
        return body.args[0], body.args[1]
    if body.op == "or":
        negated = [negation(part) for part in body.args if is_state(part)]
        if negated:
            return build.and_(*negated), build.or_(*(part for part in body.args if not is_state(part)))
    return None, None


def without_negation(node: Formula) -> Formula:
    """Return an equivalent formula without a leading ``not``: ``F !a`` for ``!G a``."""
    negations = 0
    while node.op == "not":
        node, negations = node.args[0], negations + 1
    return negation(node) if negations % 2 else node


def negation(node: Formula) -> Formula:
    """Return the negation of a formula, with ``not`` pushed through its outermost operator: ``F !a`` for ``G a``."""
    if node.op == "iff":
        return build.iff(node.args[0], complement(node.args[1]))
    operator = bounded_operator(node)
    return complement(node, depth=1) if operator is None else opposite(operator)


def is_about_end(node: Formula) -> bool:
    """Whether the formula is ``X true`` (this step is not the last one) or ``N false`` (this step is the last one)."""
    return (node.op, *node.args) in (("X", TRUE), ("N", FALSE))
