"""TLT0488: `keep begins a implies x >= previous(value_at(x, begins a)) + 8`, which the first a compares with step 1."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import CallExpr, Unary
from tltlc.grammar.walk import conjuncts, parts
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules.first_change import has_step_before


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule about an event that compares a number with its value at the event before.

    At the first event, that is the value of the first step of play. There is none if the condition says what has been.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                compared = None if asked.steps else _value_before(asked)
                if compared is not None and compared[0].name not in view.env.scope.names:
                    yield _finding(asked, *compared, is_whole=asked.is_all_of(clause, value))


def _value_before(asked: AskedResult) -> tuple[CallExpr, ScopedExpression] | None:
    """Return `value_at(x, a)` in `previous(value_at(x, a))`, where a is in the condition, and a."""
    condition = asked.condition
    events = [condition.with_tree(without_brackets(tree)) for tree in conjuncts(condition.tree)]
    others = [event.tree for event in events if not _is_edge(event)]
    if any(has_step_before(tree) for tree in others):
        return None
    for part in parts(asked.part.tree):
        if not isinstance(part, CallExpr) or part.name != "previous" or part.arguments[1:]:
            continue
        call = without_brackets(part.arguments[0].value)
        if isinstance(call, CallExpr) and call.name == "value_at":
            formula = asked.part.with_tree(call.arguments[1].value).formula()
            same = next((event for event in events if formula is not None and event.formula() == formula), None)
            if same is not None:
                return call, same
    return None


def _is_edge(event: ScopedExpression) -> bool:
    return isinstance(event.tree, Unary) and event.tree.op in ("begins", "ends")


def _finding(asked: AskedResult, call: CallExpr, event: ScopedExpression, *, is_whole: bool) -> RuleFinding:
    state = event.children()[0] if _is_edge(event) and event.tree.op == "begins" else event  # type: ignore[union-attr]
    label = Label(asked.part.source, call.span, f"at the first `{event.text}`, this is the value of the first step")
    came = f"previously once {operand_text(state)}"
    help_ = f"if the first `{event.text}` is free, add `and {came}` to that condition"
    if is_whole:
        help_ = (
            f"if the first `{event.text}` is free, write "
            f"`keep {asked.condition.text} and {came} implies {asked.part.text}`"
        )
    help_ += "; if it is compared with the first step, allow this with the comment `// tltlc: allow TLT0488`"
    return RuleFinding(f"this compares the first `{event.text}` with the first step of play", (label,), help_)


RULE = LintRule("TLT0488", "note", check)
