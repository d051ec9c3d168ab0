"""TLT0453: `a implies times_since(p, a) >= 2`, where the count has just begun anew, and so is 0 or 1.

In `ends a and time_holding(a) < 2 s`, the time is 0 s.
"""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.core.source import Span
from tltlc.grammar.past_words import OF_EVENTS
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, Unary
from tltlc.grammar.walk import conjuncts, operands, parts
from tltlc.resolve.memory import PAST
from tltlc.resolve.scope import MEMORY_FUNCTIONS
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `times_since(p, q)` and `value_at(x, q)` that a rule asks for at a step with q.

    So it does for `time_holding(q)` at a step with `ends q`.
    """
    for spec in view.specs:
        seen: set[Span] = set()
        for clause, value in spec.clauses("keep", "require", "avoid", "reach"):
            for joint in _joint_parts(clause, value):
                for finding in _ended(joint, view):
                    if finding.labels[0].span not in seen:
                        seen.add(finding.labels[0].span)
                        yield finding
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                if not asked.steps:
                    yield from _findings(asked, view)


def _joint_parts(clause: Clause, value: ScopedExpression) -> Iterator[list[ScopedExpression]]:
    """Yield conditions that a clause speaks of at one step: those of a rule and its answer, or of what it forbids."""
    if clause.kind in ("avoid", "reach"):
        yield [value.with_tree(without_brackets(part)) for part in conjuncts(without_brackets(value.tree))]
    for asked in asked_results(clause, value):
        if not asked.steps:
            beside = [asked.condition.with_tree(without_brackets(part)) for part in conjuncts(asked.condition.tree)]
            answers = [asked.part.with_tree(without_brackets(part)) for part in operands(asked.part.tree, "or")]
            # TLT0432 has an answer that never holds.
            yield [*beside, *(part for part in answers if answers[1:] or not _is_least(part.tree))]


def _ended(joint: list[ScopedExpression], view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each comparison of `time_holding(q)` beside `ends q`."""
    for event in joint:
        if not isinstance(event.tree, Unary) or event.tree.op != "ends":
            continue
        state = event.children()[0].formula()
        for part in joint:
            call = _held(part.tree)
            if call is None or call.name in view.env.scope.names or state is None:
                continue
            if part.with_tree(without_brackets(call.arguments[0].value)).formula() == state:
                held = part.with_tree(call).text
                title = f"at a step with `{event.text}`, `{held}` is 0 s"
                help_ = f"for the time up to the step before, write `previously ({part.text})`"
                yield RuleFinding(title, (view.label(call.span),), help_)


def _is_least(tree: Expr) -> bool:
    return isinstance(tree, BinaryExpr) and tree.op in (">", ">=") and _held(tree) is not None


def _held(tree: Expr) -> CallExpr | None:
    """Return the `time_holding(q)` that a comparison has on one side."""
    if not isinstance(tree, BinaryExpr) or tree.op not in ("<", "<=", ">", ">="):
        return None
    sides = (without_brackets(tree.left), without_brackets(tree.right))
    return next((side for side in sides if isinstance(side, CallExpr) and side.name == "time_holding"), None)


def _findings(asked: AskedResult, view: FileView) -> Iterator[RuleFinding]:
    calls = [part for part in parts(asked.part.tree) if isinstance(part, CallExpr) and part.name in OF_EVENTS]
    if not calls or not asked.part.depends_on_one_step():
        return
    conditions = [asked.condition.with_tree(part) for part in conjuncts(asked.condition.tree)]
    begun = [part.children()[0] for part in conditions if _is_beginning(part)]
    formulas = [condition.formula() for condition in (*conditions, *begun)]
    for part in _present_parts(asked.part):
        call = part.tree
        if not isinstance(call, CallExpr) or call.name not in OF_EVENTS or call.name in view.env.scope.names:
            continue
        event = part.with_tree(without_brackets(call.arguments[1].value))
        formula = event.formula()
        if formula is not None and formula in formulas:
            yield _finding(part, event, asked, view)


def _is_beginning(condition: ScopedExpression) -> bool:
    return isinstance(condition.tree, Unary) and condition.tree.op == "begins"


def _present_parts(asked: ScopedExpression) -> Iterator[ScopedExpression]:
    """Yield the parts of what is asked for that are about this step, and not those in what is about steps before."""
    pending = [asked]
    while pending:
        part = pending.pop()
        yield part
        is_past = isinstance(part.tree, Unary) and part.tree.op in PAST
        if not is_past and not (isinstance(part.tree, CallExpr) and part.tree.name in MEMORY_FUNCTIONS):
            pending += reversed(part.children())


def _finding(call: ScopedExpression, event: ScopedExpression, asked: AskedResult, view: FileView) -> RuleFinding:
    assert isinstance(call.tree, CallExpr)
    of = call.with_tree(without_brackets(call.tree.arguments[0].value)).text
    if call.tree.name in ("times_since", "total_time_since"):
        title = f"at a step with `{event.text}`, `{call.text}` has begun anew: it is about `{of}` at that step alone"
        help_ = f"for what was up to the step before, write `previously ({asked.part.text})`"
    else:
        title = f"at a step with `{event.text}`, `{call.text}` is `{of}` itself"
        help_ = f"for the value at the last `{event.text}` before this step, write `previous({call.text})`"
    return RuleFinding(title, (view.label(call.tree.span),), help_)


RULE = LintRule("TLT0453", "warning", check)
