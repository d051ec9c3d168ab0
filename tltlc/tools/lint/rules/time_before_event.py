"""TLT0487: `keep a implies (b until time_holding(c) >= 2 s)`, where the 2 s may have begun before a."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, Unary
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, edited_text, without_brackets
from tltlc.tools.lint.names import mentioned_signals
from tltlc.tools.lint.rule import LintRule, RuleFinding

_UNTIL: Final = ("U", "W")
_LEAST: Final = (">", ">=")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each time of something that ends an `until` behind an event, or comes within a time of it.

    There is none if the event is the beginning or end of that thing, or mentions it.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            keyword = f"{clause.kind} " if spec.declaration.block else ""
            for asked in asked_results(clause, value):
                call = _time(asked)
                if call is not None and not asked.steps and call.name not in view.env.scope.names:
                    yield _finding(asked, call, value, keyword)


def _time(asked: AskedResult) -> CallExpr | None:
    """Return the `time_holding(c)` that an answer waits for behind an event; None for other rules."""
    condition, tree = asked.condition.tree, asked.part.tree
    if not isinstance(condition, Unary) or condition.op not in ("begins", "ends"):
        return None
    if isinstance(tree, BinaryExpr) and tree.op in _UNTIL:
        awaited = without_brackets(tree.right)
    elif isinstance(tree, Unary) and tree.op == "F":
        awaited = without_brackets(tree.operand)
    else:
        return None
    call = _held(awaited)
    scope = asked.part.env.scope
    if call is None or mentioned_signals(call, scope) & mentioned_signals(condition, scope):
        return None
    return call


def _held(tree: Expr) -> CallExpr | None:
    """Return `time_holding(c)` of `time_holding(c) >= 2 s`."""
    if not isinstance(tree, BinaryExpr) or tree.op not in _LEAST:
        return None
    call = without_brackets(tree.left)
    return call if isinstance(call, CallExpr) and call.name == "time_holding" and len(call.arguments) == 1 else None


def _finding(asked: AskedResult, call: CallExpr, value: ScopedExpression, keyword: str) -> RuleFinding:
    tree = asked.part.tree
    awaited = asked.part.with_tree(
        without_brackets(tree.right if isinstance(tree, BinaryExpr) else tree.operand)  # type: ignore[union-attr]
    )
    assert isinstance(awaited.tree, BinaryExpr)
    event, what = asked.condition.text, awaited.with_tree(call.arguments[0].value).text
    length = awaited.with_tree(awaited.tree.right).text
    both = f"({awaited.text} and time_since({event}) {awaited.tree.op} {length})"
    inner = tree.right if isinstance(tree, BinaryExpr) else tree.operand  # type: ignore[union-attr]
    label = Label(awaited.source, call.span, f"this may have begun before `{event}`")
    help_ = (
        f"if `{what}` must hold for {length} from then on, write `{keyword}{edited_text(value, inner.span, both)}`; "
        "if the time before it counts, too, allow this with the comment `// tltlc: allow TLT0487`"
    )
    return RuleFinding(f"the {length} with `{what}` may have begun before `{event}`", (label,), help_)


RULE = LintRule("TLT0487", "note", check)
