"""TLT0461: `a implies b and c implies d`, which is one rule, read as `a implies ((b and c) implies d)`."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, LetDecl, SpecDecl
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each implication whose result is, without brackets, an implication from an `and`."""
    for declaration in view.module.declarations:
        if isinstance(declaration, (LetDecl, SpecDecl)):
            for expression in walk.expressions(declaration):
                for part in walk.parts(expression):
                    if isinstance(part, BinaryExpr) and part.op == "implies":
                        inner = part.right
                        if isinstance(inner, BinaryExpr) and inner.op == "implies":
                            yield from _finding(part, inner, view)


def _finding(outer: BinaryExpr, inner: BinaryExpr, view: FileView) -> Iterator[RuleFinding]:
    both = inner.left
    if not isinstance(both, BinaryExpr) or both.op != "and":
        return

    def text(start: int, end: int) -> str:
        lines = view.source.text[start:end].splitlines()
        return " ".join(" ".join(line.partition("//")[0] for line in lines).split())

    condition, conditions = (text(side.span.start, side.span.end) for side in (outer.left, both))
    last = walk.operands(both, "and")[-1].span.start
    two = f"({condition} implies {text(both.span.start, both.op_span.start)}) and ({text(last, inner.span.end)})"
    one = f"{condition} implies (({conditions}) implies {text(inner.right.span.start, inner.span.end)})"
    label = view.label(outer.span, f"read as `{one}`")
    yield RuleFinding("this is one rule, and not two", (label,), f"write `{two}` for two rules, `{one}` for one")


RULE = LintRule("TLT0461", "warning", check)
