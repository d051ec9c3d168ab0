"""TLT0435: `always a implies b`, where `always` covers only `a`."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, GroupExpr, Unary
from tltlc.grammar.walk import operands
from tltlc.tools.lint.file_view import FileView, ScopedExpression
from tltlc.tools.lint.goals import conjuncts
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `implies` or `iff` whose left side begins with a bare `always`.

    An example is `G a -> F b`: it is read as `(G a) -> F b`, but the author probably means
    `G (a -> F b)`. Only `require` clauses are checked. If the operand of `always` contains temporal
    operators, as in `G F a -> G F b`, the author usually means what is written, so there is no
    finding.
    """
    for spec in view.specs:
        for _, value in spec.clauses("require"):
            for part in conjuncts(value):
                if isinstance(part.tree, BinaryExpr) and part.tree.op in ("implies", "iff"):
                    first, *rest = operands(part.tree.left, "and")
                    if isinstance(first, Unary) and first.op == "G" and not isinstance(first.operand, GroupExpr):
                        condition = (part.with_tree(first.operand), *map(part.with_tree, rest))
                        if all(map(ScopedExpression.depends_on_one_step, condition)):
                            yield _finding(part, part.tree, first)


def _finding(part: ScopedExpression, tree: BinaryExpr, first: Unary) -> RuleFinding:
    def text_between(start: int, end: int) -> str:
        return " ".join(part.source.text[start:end].split())

    word = text_between(first.span.start, first.operand.span.start)
    corrected = text_between(first.operand.span.start, tree.span.end)
    connective = text_between(tree.op_span.start, tree.op_span.end)
    side = "condition" if tree.op == "implies" else "left side"
    label = Label(part.source, tree.left.span, f"all of this is the {side}: `{word}` ends before `{connective}`")
    condition = text_between(first.span.start, tree.left.span.end)
    help_ = (
        f"for every step, write `{word} ({corrected})`; if you mean it as it is, write `({condition}) {connective} …`"
    )
    return RuleFinding(f"`{word}` applies only to the {side}", (label,), help_)


RULE = LintRule("TLT0435", "warning", check)
