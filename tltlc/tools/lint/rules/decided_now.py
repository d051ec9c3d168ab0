"""TLT0440: an operator about several steps that the present step decides, as in `a implies (not a until b)`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Clause, Unary
from tltlc.grammar.walk import conjuncts
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.present_step import DecidedOperator, decided_operators
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules import never_answered

_PAST: Final = ("once", "historically", "since")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each operator that says no more than the present step, which it counts.

    An example is `a implies eventually within 5 s a`, where a itself is the answer. There is no finding where
    TLT0432 says that an implication only forbids its condition.
    """
    found = [
        (clause, value, decided)
        for spec in view.specs
        for clause, value in spec.clauses("reach", "keep", "avoid", "require")
        for decided in decided_operators(value, spec)
    ]
    reported = [finding.labels[0] for finding in never_answered.check(view)] if found else []
    for clause, value, decided in found:
        source, span = decided.operator.source, decided.operator.tree.span
        if not any(label.source == source and label.span.covers(span) for label in reported):
            yield _finding(clause, value, decided)


def _finding(clause: Clause, value: ScopedExpression, decided: DecidedOperator) -> RuleFinding:
    operator = decided.operator
    assert isinstance(operator.tree, (Unary, BinaryExpr))
    word = operator.source.slice(operator.tree.op_span)
    meaning = {
        "true": "always true here",
        "false": "never true here",
        "operand": f"this means only `{operator.children()[-1].text}` here",
    }[decided.outcome]
    message = f"{meaning}: `{word}` counts the present step"
    is_forbidden = decided.is_negated != (clause.kind == "avoid")
    event = _event(clause, value, operator) if is_forbidden or operator.tree.op == "historically" else None
    if event is None:
        advice = _advice(clause, decided, is_forbidden=is_forbidden)
    else:
        message += f", so this only forbids `{event.text}`"
        is_moment = isinstance(event.tree, Unary) and event.tree.op in ("begins", "ends")
        begins = f"({event.text})" if is_moment else f"(begins {operand_text(event)})"
        advice = (
            f"to forbid that it begins again, write `avoid {begins} {_then(operator)} {begins}`; "
            f"to forbid `{event.text}` altogether, write `avoid {event.text}`"
        )
    label = Label(operator.source, operator.tree.span, message)
    return RuleFinding(f"the present step alone decides this `{word}`", (label,), advice)


def _advice(clause: Clause, decided: DecidedOperator, *, is_forbidden: bool) -> str:
    operator, text = decided.operator, operand_text(decided.operator)
    assert isinstance(operator.tree, (Unary, BinaryExpr))
    if operator.tree.op in _PAST:
        # At the first step, `previously` is false.
        if decided.outcome == "operand" or is_forbidden:
            return f"for the steps before, write `previously {text}`"
        return "ask for what must have come at an earlier step"
    if decided.outcome == "operand":
        if operator.tree.op == "U" and not is_forbidden:
            first, goal = operator.children()
            weak = f"({operand_text(first)} weak_until {operand_text(goal)})"
            strong = f"`weak_next {text}` if it must"
            return f"for the steps after it, write `weak_next {weak}` if `{goal.text}` need not come, {strong}"
        return f"for the steps after it, write `{'next' if is_forbidden else 'weak_next'} {text}`"
    if decided.outcome == "true":
        # Where `a` asks for another `a`, `next` would forbid it: there is a last one.
        later = is_forbidden or clause.kind == "reach"
        return f"for a later step, write `next {text}`" if later else "ask for what must come at a later step"
    return f"for the steps after it, write `weak_next {text}`"


def _event(clause: Clause, value: ScopedExpression, operator: ScopedExpression) -> ScopedExpression | None:
    """Return the event that a clause forbids because it meant to forbid that the event comes twice, else None.

    For example, return a for `avoid a and once within 5 s a` and for `keep a implies not once within 5 s a`.
    """
    tree, operated = without_brackets(value.tree), operator.tree
    if clause.kind == "require" and isinstance(tree, Unary) and tree.op == "G" and tree.bound is None:
        tree = without_brackets(tree.operand)
    elif clause.kind not in ("keep", "avoid"):
        return None
    if clause.kind == "avoid":
        others = [part for part in conjuncts(tree) if without_brackets(part) != operated]
    elif isinstance(tree, BinaryExpr) and tree.op == "implies":
        others = [tree.left]
    else:
        return None
    if len(others) != 1 or not isinstance(operated, Unary):
        return None
    again = without_brackets(operated.operand)
    if operated.op == "historically" and isinstance(again, Unary) and again.op == "not":
        again = again.operand
    elif operated.op not in ("F", "once"):
        return None
    event = value.with_tree(without_brackets(others[0]))
    return event if event.text == operator.with_tree(again).text else None


def _then(operator: ScopedExpression) -> str:
    """Return `then` with the bound of the operator."""
    assert isinstance(operator.tree, (Unary, BinaryExpr))
    if operator.tree.bound is None:
        return "then"
    high = operator.tree.bound.high
    return f"then within {' '.join(operator.source.slice(high.span).split())}{'' if high.unit else ' steps'}"


RULE = LintRule("TLT0440", "warning", check, supersedes=("TLT0430", "TLT0443"))
