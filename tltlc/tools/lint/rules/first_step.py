"""TLT0429: a formula without a temporal operator, which constrains only the first step."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import takewhile

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import GroupExpr, Unary
from tltlc.grammar.walk import conjuncts
from tltlc.tools.lint import goals
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `require` clause that constrains only the first step.

    A spec of the form `spec NAME = FORMULA` gets no such finding.

    Also yield a finding for conjuncts like b in `eventually a and b`. This is read as
    `(eventually a) and b`, so b must hold at the first step, but the author probably means
    `eventually (a and b)`.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("require"):
            parts = [value.with_tree(tree) for tree in conjuncts(value.tree)]
            if spec.declaration.block and all(map(ScopedExpression.depends_on_one_step, parts)):
                label = Label(value.source, clause.span, "required at the first step, and never again")
                help_ = f"for every step, write `keep {value.text}`"
                if not goals.consists_of_implications(value):
                    help_ += f"; for some step, write `reach {value.text}`"
                if spec.spec.semantics == "finite":
                    help_ += f"; for the last step, write `require eventually always {operand_text(value)}`"
                yield RuleFinding("this is only about the first step", (label,), help_)
                continue
            for place, part in enumerate(parts):
                following = list(takewhile(ScopedExpression.depends_on_one_step, parts[place + 1 :]))
                if following and isinstance(part.tree, Unary) and _is_bare(part.tree):
                    yield _finding(part, part.tree, following)


def _is_bare(tree: Unary) -> bool:
    """Whether this is an `eventually` or `always` without brackets around its operand."""
    return tree.op in ("F", "G") and not isinstance(tree.operand, GroupExpr)


def _finding(temporal: ScopedExpression, tree: Unary, following: list[ScopedExpression]) -> RuleFinding:
    source = temporal.source
    word = " ".join(source.text[tree.span.start : tree.operand.span.start].split())
    inside = " and ".join(map(operand_text, (temporal.with_tree(tree.operand), *following)))
    span = following[0].tree.span.to(following[-1].tree.span)
    label = Label(source, span, f"required at the first step: `{word}` ends before it")
    together = "both" if len(following) == 1 else "all of them"
    help_ = f"for {together} together, write `{word} ({inside})`"
    return RuleFinding("this is only about the first step", (label,), help_)


RULE = LintRule("TLT0429", "warning", check, supersedes=("TLT0446",))
