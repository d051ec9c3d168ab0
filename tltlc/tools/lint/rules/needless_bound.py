"""TLT0443: a bound that changes nothing, because the clause means the same without it."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Clause, Unary
from tltlc.resolve.constants import samples
from tltlc.tools.lint.bounded_operators import NeedlessBound, needless_bounds
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.removal_advice import removal_help
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules import never_answered

_LASTING = ("G", "historically")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each bound that covers one step alone, or without which its clause means the same.

    For example, `keep a implies always for 2 s a` means `keep a implies always a`: the time begins anew at each
    step with a. Other rules report the frequent cases TLT0432, TLT0437 and TLT0440.
    """
    for spec in view.specs:
        for formula in spec.formulas():
            for part in formula.parts():
                yield from _one_step(part)
    needless = [
        (spec, clause, bound)
        for spec in view.specs
        if spec.spec.semantics == "finite" and not spec.is_settled
        for clause, bound in needless_bounds(spec)
    ]
    reported = [finding.labels[0] for finding in never_answered.check(view)] if needless else []
    for spec, clause, bound in needless:
        source, span = bound.operator.source, bound.operator.tree.span
        if not any(label.source == source and label.span.covers(span) for label in reported):
            yield _finding(bound, clause, spec)


def _one_step(part: ScopedExpression) -> Iterator[RuleFinding]:
    """Yield a finding if a bound covers the present step alone."""
    tree = part.tree
    if part.env.context.clock_varies or not isinstance(tree, (Unary, BinaryExpr)) or tree.bound is None:
        return
    if tree.op not in ("F", "once", "within", *_LASTING) or (tree.bound.low is not None and tree.bound.low.value):
        return
    steps = samples(tree.bound.high, part.env)
    if steps != (1 if tree.op in _LASTING and tree.bound.words else 0):
        return
    label = Label(part.source, tree.span, "this is about the present step alone")
    is_rounded = tree.bound.high.value > 0 and tree.bound.high.unit not in (None, "step", "steps")
    period = part.env.context.clock_s
    help_ = f"write `{_present(part)}`" + (
        f", or a longer time: a step takes {period:.3g} s" if is_rounded and period else ""
    )
    yield RuleFinding("this bound covers one step", (label,), help_)


def _finding(needless: NeedlessBound, clause: Clause, spec: SpecView) -> RuleFinding:
    operator, tree = needless.operator, needless.operator.tree
    reasons = [Label(reason.source, reason.span, "because of this") for reason in needless.reasons]
    if needless.meaning == "implied":
        span = needless.whole.tree.span if clause.kind == "require" else clause.span
        label = Label(needless.whole.source, span, "this adds nothing, whatever its time is")
        title = f"{'another clause already implies' if len(reasons) == 1 else 'other clauses already imply'} this"
        parts = [part for part in spec.spec.parts if part.span == span]
        remaining = [part for part in spec.spec.parts if part not in parts]
        removal = removal_help(parts[0], remaining, spec) if parts else "leave it out"
        return RuleFinding(title, (label, *reasons), f"{removal}, or write what else it should ask for")
    assert isinstance(tree, (Unary, BinaryExpr))
    if needless.meaning == "operand" and tree.op != "then":
        present = _present(operator)
        message = f"the clause means the same with `{present}` in its place"
        help_ = f"write `{present}` in its place, or say which steps it is about"
    else:
        message, help_ = "the clause means the same without this time", "leave the time out"
        event = None if reasons else _event(needless)
        if event is not None:
            message += f": it begins anew at each step with `{event.text}`"
            help_ += f"; to count from where `{event.text}` begins, write `begins {operand_text(event)}`"
    label = Label(operator.source, tree.span, message)
    return RuleFinding("this bound changes nothing", (label, *reasons), help_)


def _present(operator: ScopedExpression) -> str:
    """Return what an operator says of the present step."""
    *before, last = operator.children()
    return f"{operand_text(before[0])} implies {operand_text(last)}" if before else last.text


def _event(needless: NeedlessBound) -> ScopedExpression | None:
    """Return the condition of an implication whose result is `always` with the bound; None if there is none."""
    operated = needless.operator.tree
    for part in needless.whole.parts():
        tree = part.tree
        if isinstance(tree, BinaryExpr) and tree.op == "implies" and without_brackets(tree.right) == operated:
            condition = part.with_tree(without_brackets(tree.left))
            is_lasting = isinstance(operated, Unary) and operated.op == "G"
            return condition if is_lasting and condition.depends_on_one_step() else None
    return None


RULE = LintRule("TLT0443", "warning", check)
