"""TLT0468: `always for 3 s a until b`, where each step before b begins a time of its own."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `until` and `weak_until` whose left side lasts for a time.

    The left side must hold at each step before the right side, and each time counts from its own step. So a must hold
    until b, and on.
    """
    for spec in view.specs:
        for part in (part for formula in spec.formulas() for part in formula.parts()):
            tree = part.tree
            if isinstance(tree, BinaryExpr) and tree.op in ("U", "W"):
                lasting = without_brackets(tree.left)
                if isinstance(lasting, Unary) and lasting.op == "G" and lasting.bound is not None:
                    yield _finding(part, part.with_tree(lasting), part.with_tree(tree.right))


def _finding(until: ScopedExpression, lasting: ScopedExpression, end: ScopedExpression) -> RuleFinding:
    assert isinstance(until.tree, BinaryExpr) and isinstance(lasting.tree, Unary)
    state, word = lasting.with_tree(lasting.tree.operand), until.source.slice(until.tree.op_span)
    label = Label(until.source, until.tree.span, f"each step before `{end.text}` begins this time anew")
    meant = f"(({lasting.text}) or ({operand_text(state)} until {operand_text(end)}))"
    help_ = (
        f"if `{end.text}` may end the time, write `{meant}`; if each step must begin it, allow this with the comment "
        "`// tltlc: allow TLT0468`"
    )
    return RuleFinding(f"this `{word}` waits for `{end.text}`, and no time ends it", (label,), help_)


RULE = LintRule("TLT0468", "warning", check, supersedes=("TLT0448", "TLT0446"))
