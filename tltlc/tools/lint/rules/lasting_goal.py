"""TLT0434: `reach (always for 3 s a)`, which a single step can meet.

The bounded `always` asks for nothing after the end of the trace.
"""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.grammar.walk import operands
from tltlc.logic.formula import FALSE, and_, weak_next
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.file_view import Expression, SpecView, View, inner, operand
from tltlc.tools.lint.goals import conjuncts
from tltlc.tools.lint.rule import LintRule, Remark

_SUGGESTION = "let a signal count the time, and ask for enough of it, as in `reach time_there >= 3 s`"


def check(view: View) -> Iterator[Remark]:
    """Yield a remark for each bounded `always` in a last goal.

    This applies to specs that end with success as soon as they are met.
    """
    for spec in view.specs:
        if spec.fspa.semantics != "finite" or spec.fspa.judge != "goal":
            continue
        for clause, value in spec.clauses("reach", "require"):
            goals = (
                [value] if clause.kind == "reach" else [goal for part in conjuncts(value) for goal in _goals_of(part)]
            )
            for final in map(_last, goals):
                remarks = [remark for last_part in final for remark in _remarks(last_part)]
                if remarks and _is_met_by_one_step(final, spec):
                    yield from remarks


def _goals_of(part: Expression) -> Iterator[Expression]:
    """Yield what a conjunct asks for at some step, as a goal; nothing if it is no goal."""
    if isinstance(part.tree, Unary) and part.tree.op == "F":
        yield part.at(part.tree.operand)
    elif isinstance(part.tree, BinaryExpr) and part.tree.op == "then":
        yield part


def _last(goal: Expression) -> list[Expression]:
    """Return what a goal asks for last.

    For a chain this is its last step, for `eventually a` it is what a asks for last.
    """
    parts: list[Expression] = []
    waiting = [goal]
    while waiting:
        goal = waiting.pop()
        for part in conjuncts(goal.at(operands(goal.tree, "then")[-1])):
            inside = list(_goals_of(part))
            waiting += inside
            parts += [] if inside else [part]
    return parts


def _is_met_by_one_step(final: list[Expression], spec: SpecView) -> bool:
    """Whether a trace of one step can meet all of these expressions.

    Anything that asks for a later step needs a longer trace.
    """
    formulas = (formula for formula in map(Expression.formula, final) if formula is not None)
    at_end = and_(weak_next(FALSE), *formulas)
    return not unsatisfiable((Conjunct(at_end, spec.spec.source, spec.spec.name_span),), spec.spec)


def _remarks(goal: Expression) -> Iterator[Remark]:
    waiting = [(goal, True)]
    while waiting:
        part, holds = waiting.pop()
        tree = inner(part.tree)
        if isinstance(tree, Unary) and tree.op == "not":
            waiting.append((part.at(tree.operand), not holds))
        elif isinstance(tree, BinaryExpr) and tree.op in ("and", "or"):
            waiting += (part.at(tree.right), holds), (part.at(tree.left), holds)
        elif isinstance(tree, Unary) and tree.bound is not None and tree.op == ("G" if holds else "F"):
            lasting = part.at(tree.operand)
            condition = lasting.text if holds else f"not {operand(lasting)}"
            message = f"past the end it asks nothing, so one step with `{condition}` is enough"
            yield Remark("this goal is met by one step", (Label(part.source, tree.span, message),), _SUGGESTION)


RULE = LintRule("TLT0434", "warning", check)
