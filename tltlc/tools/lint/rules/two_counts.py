"""TLT0450: `always for 2 s p` beside `time_holding(p) >= 2 s`, which need different numbers of steps."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, NumberExpr, Unary
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.step_times import steps_before, time_text

_MOST_STEPS: Final = 100
"""With more steps, one more or less is hardly noticed."""


@record
class _Lasting:
    """An expression, and that it is about a ``condition`` that lasts for a ``time`` of a fixed clock.

    ``steps`` is how many steps in a row that takes, with the first of them.
    """

    expression: ScopedExpression
    condition: ScopedExpression
    time: tuple[int, int]
    steps: int


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `time_holding(p) >= 2 s` and `time_holding(p) > 2 s` in a spec with `always for 2 s p`.

    There is none for many steps, and none where the clock varies.
    """
    for spec in view.specs:
        step_s = spec.fspa.clock_s
        if not step_s:
            continue
        stretches = list(_stretches(spec, step_s))
        for comparison in _comparisons(spec, step_s) if stretches else ():
            formula = comparison.condition.formula()
            for stretch in stretches:
                if stretch.time == comparison.time and stretch.condition.formula() == formula is not None:
                    yield _finding(stretch, comparison, step_s)
                    break


def _stretches(spec: SpecView, step_s: float) -> Iterator[_Lasting]:
    """Yield each `always for` that asks for several steps."""
    for formula in spec.formulas():
        for part in formula.parts():
            tree = part.tree
            if isinstance(tree, Unary) and tree.op == "G" and tree.bound is not None and tree.bound.words:
                time = _time(tree.bound.high, step_s)
                if time is not None and 1 < time[0] <= _MOST_STEPS:
                    yield _Lasting(part, part.with_tree(without_brackets(tree.operand)), time, time[0])


def _comparisons(spec: SpecView, step_s: float) -> Iterator[_Lasting]:
    """Yield each `time_holding(p) >= T` and `time_holding(p) > T`."""
    for formula in spec.formulas():
        for part in formula.parts():
            tree = part.tree
            if not isinstance(tree, BinaryExpr) or tree.op not in (">", ">="):
                continue
            if (
                isinstance(tree.left, CallExpr)
                and tree.left.name == "time_holding"
                and isinstance(tree.right, NumberExpr)
            ):
                time = _time(tree.right, step_s)
                if time is not None:
                    condition = part.with_tree(without_brackets(tree.left.arguments[0].value))
                    # The time is 0 s at the first step.
                    yield _Lasting(part, condition, time, 1 + (time[0] if tree.op == ">=" else time[1] + 1))


def _time(time: NumberExpr, step_s: float) -> tuple[int, int] | None:
    """Return the number of steps that a time takes, rounded up and down; None if it is no time."""
    shorter, steps = steps_before(time, step_s), steps_before(time, step_s, inclusive=True)
    return None if shorter is None or steps is None else (shorter + 1, steps)


def _finding(stretch: _Lasting, comparison: _Lasting, step_s: float) -> RuleFinding:
    always, holding, tree = stretch.expression, comparison.expression, comparison.expression.tree
    assert isinstance(tree, BinaryExpr) and isinstance(tree.right, NumberExpr)
    labels = (
        Label(
            holding.source,
            tree.span,
            f"this needs {comparison.steps} steps in a row, because the time is 0 s at the first of them",
        ),
        Label(always.source, always.tree.span, f"this asks for {stretch.steps}, the present one among them"),
    )
    same = f"{holding.with_tree(tree.left).text} >= {time_text(stretch.steps - 1, tree.right.unit, step_s)}"
    help_ = (
        f"if both mean {stretch.steps} steps, write `{same}`; "
        "otherwise allow it with the comment `// tltlc: allow TLT0450`"
    )
    return RuleFinding(f"`{holding.text}` needs more steps than `{always.text}`", labels, help_)


RULE = LintRule("TLT0450", "note", check)
