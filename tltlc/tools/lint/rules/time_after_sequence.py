"""TLT0447: `(a then b) implies eventually within 2 s c`, where the time counts from a, and not from b."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, TemporalInterval, Unary
from tltlc.logic.text.phrases import is_state
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.step_times import steps_before, time_text
from tltlc.tools.lint.stretches import every_step


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule for every step whose condition is a sequence, and whose result has a bound.

    The steps of the sequence are about one step each; otherwise no clause with the past says the other reading.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            rules = every_step(clause, value)
            form = "{}"
            if len(rules) == 1:
                always = "always ({})"
                form = "keep {}" if clause.kind == "keep" else f"require {always}" if spec.declaration.block else always
            for tree in rules:
                if isinstance(tree, BinaryExpr) and tree.op == "implies":
                    yield from _finding(value.with_tree(tree), spec.fspa.clock_s, form)


def _finding(rule: ScopedExpression, step_s: float | None, form: str) -> Iterator[RuleFinding]:
    """Yield the finding for an implication, if there is one; ``form`` is the text around the one to write."""
    assert isinstance(rule.tree, BinaryExpr)
    sequence, result = rule.with_tree(without_brackets(rule.tree.left)), without_brackets(rule.tree.right)
    if isinstance(result, Unary) and result.op == "not":
        result = without_brackets(result.operand)
    if not isinstance(result, Unary) or result.op not in ("F", "G") or result.bound is None:
        return
    events, bounds = _steps(sequence)
    formulas = [event.formula() for event in events]
    if len(events) < 2 or any(formula is None or not is_state(formula) for formula in formulas):
        return
    condition = operand_text(events[0])
    for place, (event, bound) in enumerate(zip(events[1:], bounds, strict=True)):
        before = condition if place == 0 else f"({condition})"
        condition = f"{operand_text(event)} and {_earlier(bound, step_s)} {before}"
    first, last = events[0].text, events[-1].text
    label = Label(rule.source, result.bound.span, f"`{sequence.text}` holds at the step of `{first}`")
    meant = form.format(f"{condition} implies {rule.with_tree(rule.tree.right).text}")
    help_ = (
        f"if it counts from `{last}`, write `{meant}`; "
        f"if it counts from `{first}`, allow it with the comment `// tltlc: allow TLT0447`"
    )
    yield RuleFinding(f"this time counts from `{first}`, not from `{last}`", (label,), help_)


def _steps(sequence: ScopedExpression) -> tuple[list[ScopedExpression], list[TemporalInterval | None]]:
    """Return the steps of a sequence without brackets between them, and the bounds after the first one."""
    events, bounds, tree = [], [], sequence.tree
    while isinstance(tree, BinaryExpr) and tree.op == "then":
        events.append(sequence.with_tree(tree.left))
        bounds.append(tree.bound)
        tree = tree.right
    return [*events, sequence.with_tree(tree)], bounds


def _earlier(bound: TemporalInterval | None, step_s: float | None) -> str:
    """Return the words for an event at an earlier step, within the time of a `then`."""
    if bound is None:
        return "previously once"
    # From the step before, the time is one step shorter. With a clock that varies, no such rule compiles.
    steps = steps_before(bound.high, step_s)
    assert steps is not None
    return f"previously once within {time_text(steps, bound.high.unit, step_s)}" if steps else "previously"


RULE = LintRule("TLT0447", "warning", check)
