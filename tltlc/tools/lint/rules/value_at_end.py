"""TLT0476: `value_at(x, ends a)` and `value_at(x, previously a)`, the value one step after a."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import CallExpr, Unary
from tltlc.grammar.walk import parts
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `value_at(x, ends p)` of a number that is not a value of the step before itself."""
    for spec in view.specs:
        for part in (part for formula in spec.formulas() for part in formula.parts()):
            call = part.tree
            if not isinstance(call, CallExpr) or call.name != "value_at" or call.name in view.env.scope.names:
                continue
            number, event = (without_brackets(argument.value) for argument in call.arguments[:2])
            is_before = any(isinstance(inner, CallExpr) and inner.name == "previous" for inner in parts(number))
            if isinstance(event, Unary) and event.op in ("ends", "previously") and not is_before:
                yield _finding(part, part.with_tree(number), part.with_tree(event))


def _finding(call: ScopedExpression, number: ScopedExpression, event: ScopedExpression) -> RuleFinding:
    assert isinstance(event.tree, Unary)
    state = event.with_tree(event.tree.operand).text
    if event.tree.op == "previously":
        label = Label(call.source, call.tree.span, f"from the step after the last `{state}`")
        help_ = (
            f"for the step with `{state}`, write `previous(value_at({number.text}, {state}))`, which is the last one "
            "before this step; if the step after it is meant, allow this with the comment `// tltlc: allow TLT0476`"
        )
        return RuleFinding(f"this is the value one step after `{state}`", (label,), help_)
    label = Label(call.source, call.tree.span, f"from the first step without `{state}`")
    help_ = (
        f"for the last step with `{state}`, write `value_at(previous({number.text}), {event.text})`; if the first step "
        "without it is meant, allow this with the comment `// tltlc: allow TLT0476`"
    )
    return RuleFinding(f"this is the value after `{state}`, and not at its last step", (label,), help_)


RULE = LintRule("TLT0476", "note", check)
