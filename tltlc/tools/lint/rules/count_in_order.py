"""TLT0485: `reach a then times(b) >= 3`, which also counts each b before a."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, Unary
from tltlc.grammar.walk import conjuncts, operands
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.names import mentioned_signals
from tltlc.tools.lint.rule import LintRule, RuleFinding

_SIGNS: Final = (">", ">=", "==")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each count of all of play that is a goal behind another one."""
    for spec in view.specs:
        for _, value in spec.clauses("reach"):
            goals = operands(without_brackets(value.tree), "then")
            for before, goal in pairwise(goals):
                for part in conjuncts(without_brackets(goal)):
                    call = _count(without_brackets(part))
                    if call is None or call.name in view.env.scope.names:
                        continue
                    counted, scope = call.arguments[0].value, view.env.scope
                    if not mentioned_signals(counted, scope) & mentioned_signals(before, scope):
                        yield _finding(value.with_tree(without_brackets(before)), value.with_tree(part), call)


def _count(tree: Expr) -> CallExpr | None:
    """Return the count of a comparison that says how often something must have begun; None for others."""
    if not isinstance(tree, BinaryExpr) or tree.op not in _SIGNS:
        return None
    call = without_brackets(tree.left)
    return call if isinstance(call, CallExpr) and call.name == "times" and call.arguments else None


def _finding(before: ScopedExpression, goal: ScopedExpression, call: CallExpr) -> RuleFinding:
    counted, *most = (goal.with_tree(argument.value).text for argument in call.arguments)
    is_edge = isinstance(before.tree, Unary) and before.tree.op in ("begins", "ends")
    start = before.text if is_edge else f"begins {operand_text(before)}"
    since = f"times_since({', '.join((counted, start, *most))})"
    rest = goal.source.text[call.span.end : goal.tree.span.end]
    label = Label(goal.source, call.span, f"each `{counted}` since the first step of play counts")
    help_ = (
        f"if only those since the last `{start}` count, write `{since}{rest}`; if those before it count, too, allow "
        "this with the comment `// tltlc: allow TLT0485`"
    )
    return RuleFinding(f"this also counts what comes before `{before.text}`", (label,), help_)


RULE = LintRule("TLT0485", "note", check)
