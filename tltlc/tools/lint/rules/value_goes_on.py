"""TLT0479: `keep x >= value_at(x, begins a) - 20`, which is also judged after a and before its first beginning."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, Unary
from tltlc.grammar.walk import children, parts
from tltlc.resolve.scope import MEMORY_FUNCTIONS
from tltlc.tools.lint.file_view import FileView, ScopedExpression, negated_text, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.stretches import every_step

_SIGNS: Final = ("<", "<=", ">", ">=", "==", "!=")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each comparison at every step with a value at the beginning or at the end of a condition."""
    for spec in view.specs:
        for clause, value in spec.clauses("keep"):
            for tree in every_step(clause, value):
                call = _only_value(tree)
                if call is not None and call.name not in view.env.scope.names:
                    event = without_brackets(call.arguments[1].value)
                    if isinstance(event, Unary) and event.op in ("begins", "ends"):
                        yield _finding(value.with_tree(tree), call, event)


def _only_value(rule: Expr) -> CallExpr | None:
    """Return the `value_at(x, a)` of a comparison; None if it has none or several, or one inside another function.

    `previous(value_at(x, begins a))` is from the stretch before where a begins, and so is about no single stretch.
    """
    if not isinstance(rule, BinaryExpr) or rule.op not in _SIGNS:
        return None
    calls = [part for part in parts(rule) if isinstance(part, CallExpr) and part.name == "value_at"]
    if len(calls) != 1:
        return None
    pending: list[Expr] = [rule]
    while pending:
        part = pending.pop()
        if part is calls[0]:
            return calls[0]
        if not isinstance(part, CallExpr) or part.name not in MEMORY_FUNCTIONS:
            pending += children(part)
    return None


def _finding(rule: ScopedExpression, call: CallExpr, event: Unary) -> RuleFinding:
    state = rule.with_tree(without_brackets(event.operand))
    if event.op == "begins":
        title = f"this is also judged where `{state.text}` does not hold"
        message = f"this stays after `{state.text}` ends, and is that of the first step before its first beginning"
        steps, condition = f"with `{state.text}`", operand_text(state)
    else:
        title = f"this is also judged while `{state.text}`"
        message = f"where `{state.text}` holds again, this is from its last end; before that, from the first step"
        steps, condition = f"without `{state.text}`", negated_text(state)
    help_ = (
        f"if only steps {steps} count, write `keep {condition} implies {rule.text}`; "
        "if all steps count, allow this with the comment `// tltlc: allow TLT0479`"
    )
    return RuleFinding(title, (Label(rule.source, call.span, message),), help_)


RULE = LintRule("TLT0479", "note", check)
