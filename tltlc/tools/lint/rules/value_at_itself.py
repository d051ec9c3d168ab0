"""TLT0490: `keep ends a implies x == value_at(x, begins b)`, where b may begin at the step at which a ends."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr
from tltlc.grammar.walk import children, parts
from tltlc.tools.lint.asked_results import asked_results
from tltlc.tools.lint.edges import edge_of
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.names import mentioned_signals
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule about an event that compares a number with its value at another event.

    There is none if both events are about the same signal, because they are seldom at one step then.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                edge = edge_of(asked.condition)
                if edge is None or asked.steps:
                    continue
                for call in _compared_with_themselves(asked.part):
                    event, scope = call.with_tree(call.tree.arguments[1].value), call.env.scope  # type: ignore[union-attr]
                    if edge_of(event) is not None and not (
                        mentioned_signals(event.tree, scope) & mentioned_signals(edge.tree, scope)
                    ):
                        yield _finding(call, event, edge)


def _compared_with_themselves(answer: ScopedExpression) -> Iterator[ScopedExpression]:
    """Yield each `value_at(x, b)` in a comparison that has x, too."""
    for part in answer.parts() if answer.depends_on_one_step() else ():
        if isinstance(part.tree, BinaryExpr) and part.tree.op in ("<", "<=", ">", ">=", "==", "!="):
            for inner in parts(part.tree):
                if isinstance(inner, CallExpr) and _is_compared_value(part, inner):
                    yield part.with_tree(inner)


def _is_compared_value(comparison: ScopedExpression, call: CallExpr) -> bool:
    """Whether a call is `value_at(x, b)`, and the comparison has x outside it, too."""
    if call.name != "value_at" or call.name in comparison.env.scope.names or len(call.arguments) != 2:
        return False
    remembered = comparison.with_tree(call.arguments[0].value).text
    pending = [comparison.tree]
    while pending:
        part = pending.pop()
        if comparison.with_tree(part).text == remembered:
            return True
        # What a function makes of the value is another value.
        pending += () if isinstance(part, CallExpr) else children(part)
    return False


def _finding(call: ScopedExpression, event: ScopedExpression, edge: ScopedExpression) -> RuleFinding:
    remembered = call.with_tree(call.tree.arguments[0].value)  # type: ignore[union-attr]
    text = operand_text(event.with_tree(without_brackets(event.tree)))
    label = Label(call.source, call.tree.span, f"at such a step, this is the `{remembered.text}` of that step")
    help_ = (
        f"if the value of an earlier step is meant, write `value_at({remembered.text}, {text} and not {edge.text})`; "
        "if the two are never at one step, allow this with the comment `// tltlc: allow TLT0490`"
    )
    title = f"where `{event.text}` is at the step of `{edge.text}`, this compares `{remembered.text}` with itself"
    return RuleFinding(title, (label,), help_)


RULE = LintRule("TLT0490", "note", check)
