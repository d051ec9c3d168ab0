"""TLT0439: a time behind `next`, which counts from the next step, where the clock varies."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `next` or `weak_next` before a bound in seconds, if the clock varies."""
    if not view.env.context.clock_varies:
        return
    for spec in view.specs:
        for formula in spec.formulas():
            for part in formula.parts():
                tree = part.tree
                if isinstance(tree, BinaryExpr) and tree.op == "implies":
                    yield from _findings(part.with_tree(tree.right), part.with_tree(tree.left))
                elif isinstance(tree, Unary):
                    yield from _findings(part.with_tree(tree.operand), None)


def _findings(part: ScopedExpression, event: ScopedExpression | None) -> Iterator[RuleFinding]:
    """Yield a finding if a formula is a time behind `next`; ``event`` is what it follows, if that is known."""
    outer = without_brackets(part.tree)
    if not isinstance(outer, Unary) or outer.op not in ("X", "N") or outer.bound is not None:
        return
    inner = without_brackets(outer.operand)
    if not isinstance(inner, Unary) or inner.op not in ("F", "G") or inner.bound is None:
        return
    word = part.source.slice(outer.op_span)
    yield RuleFinding(
        f"this time counts from the step after `{word}`",
        (Label(part.source, inner.bound.span, "the time from the event to that step comes on top"),),
        _advice(part, outer, inner, event),
    )


def _advice(part: ScopedExpression, outer: Unary, timed: Unary, event: ScopedExpression | None) -> str:
    assert timed.bound is not None
    time, word = " ".join(part.source.slice(timed.bound.high.span).split()), part.source.slice(outer.op_span)
    avoided = without_brackets(timed.operand)
    if event is not None and timed.op == "G" and isinstance(avoided, Unary) and avoided.op == "not":
        first, second = operand_text(event), operand_text(part.with_tree(avoided.operand))
        # `for` leaves out the end of the time, and `next` is false at the last step.
        and_no_step = f", and asks for no step after `{first}`" if outer.op == "X" else ""
        return (
            f"to count from the event, write `avoid ({first}) then within {time} ({second})`, which also forbids "
            f"`{second}` at exactly {time}{and_no_step}"
        )
    return f"to count from the {'event' if event else 'step before'}, leave out `{word}`: then that step counts, too"


RULE = LintRule("TLT0439", "warning", check, supersedes=("TLT0449",))
