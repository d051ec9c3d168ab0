"""TLT0434: `reach (always for 3 s a)`, which a single step can meet.

A bounded `always` requires nothing of the steps after the end of the trace.
"""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, NumberExpr, Unary
from tltlc.grammar.walk import operands
from tltlc.logic.formula import FALSE, and_, weak_next
from tltlc.resolve.spec import Conjunct
from tltlc.resolve.units import time_units
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.goals import conjuncts
from tltlc.tools.lint.rule import LintRule, RuleFinding

_SUGGESTION = "ask how long it has held, as in `time_holding(there) >= 3 s`"


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each bounded `always` in the last goal of a clause, if one step can meet this goal.

    Only specs over finite traces that are judged at their goal are checked: their episodes end as
    soon as the spec is met.
    """
    for spec in view.specs:
        if spec.fspa.semantics != "finite" or spec.fspa.judge != "goal":
            continue
        for clause, value in spec.clauses("reach", "require"):
            goals = (
                [value] if clause.kind == "reach" else [goal for part in conjuncts(value) for goal in _goals_of(part)]
            )
            for final in map(_last_parts, goals):
                findings = [finding for last_part in final for finding in _findings(last_part)]
                if findings and _is_met_by_one_step(final, spec):
                    yield from findings


def _goals_of(part: ScopedExpression) -> Iterator[ScopedExpression]:
    """Yield the operand if ``part`` is an `eventually`, or ``part`` itself if it is a `then` chain; else nothing."""
    if isinstance(part.tree, Unary) and part.tree.op == "F":
        yield part.with_tree(part.tree.operand)
    elif isinstance(part.tree, BinaryExpr) and part.tree.op == "then":
        yield part


def _last_parts(goal: ScopedExpression) -> list[ScopedExpression]:
    """Return the conjuncts of a goal that are met last.

    Of a `then` chain, they are the conjuncts of the last step; of `eventually a`, the conjuncts of a.
    """
    parts: list[ScopedExpression] = []
    pending = [goal]
    while pending:
        goal = pending.pop()
        for part in conjuncts(goal.with_tree(operands(goal.tree, "then")[-1])):
            inside = list(_goals_of(part))
            pending += inside
            parts += [] if inside else [part]
    return parts


def _is_met_by_one_step(final: list[ScopedExpression], spec: SpecView) -> bool:
    """Whether a trace of one step can satisfy all of these expressions."""
    formulas = (formula for formula in map(ScopedExpression.formula, final) if formula is not None)
    at_end = and_(weak_next(FALSE), *formulas)
    return not unsatisfiable((Conjunct(at_end, spec.spec.source, spec.spec.name_span),), spec.spec)


def _findings(goal: ScopedExpression) -> Iterator[RuleFinding]:
    """Yield a finding for each bounded `always`, and for each negated bounded `eventually`, in ``goal``."""
    pending = [(goal, True)]
    while pending:
        part, holds = pending.pop()
        tree = without_brackets(part.tree)
        if isinstance(tree, Unary) and tree.op == "not":
            pending.append((part.with_tree(tree.operand), not holds))
        elif isinstance(tree, BinaryExpr) and tree.op in ("and", "or"):
            pending += (part.with_tree(tree.right), holds), (part.with_tree(tree.left), holds)
        elif isinstance(tree, Unary) and tree.bound is not None and tree.op == ("G" if holds else "F"):
            lasting = part.with_tree(tree.operand)
            condition = lasting.text if holds else f"not {operand_text(lasting)}"
            message = f"it asks nothing after the end, so one step with `{condition}` is enough"
            help_ = _suggestion(condition, tree.bound.high, lasting) if holds else _SUGGESTION
            yield RuleFinding("this goal is met by one step", (Label(part.source, tree.span, message),), help_)


def _suggestion(condition: str, time: NumberExpr, lasting: ScopedExpression) -> str:
    """Return advice on what to write in place of a goal that ``condition`` holds for a ``time``."""
    if time.unit not in time_units() or not lasting.depends_on_one_step():
        return _SUGGESTION
    return f"ask how long it has held: `time_holding({condition}) >= {lasting.source.slice(time.span)}`"


RULE = LintRule("TLT0434", "warning", check)
