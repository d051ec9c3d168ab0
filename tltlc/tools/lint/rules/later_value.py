"""TLT0480: `avoid (mode is idle) then (mode is chase)`, which forbids more than the direct change."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Clause, GroupExpr, IsExpr, Quantified
from tltlc.resolve.enums import enum_of
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules.first_change import same_text


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `avoid` clause that forbids a value of an enum after another value of it.

    There is none for an enum of two values: there, the later value comes by a direct change. The two may also be in
    the body of an `any`.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("avoid"):
            inner = value
            while isinstance(inner.tree, GroupExpr) or (isinstance(inner.tree, Quantified) and not inner.tree.all):
                inner = inner.children()[0]
            tree = inner.tree
            if isinstance(tree, BinaryExpr) and tree.op == "then" and tree.bound is None:
                first, later = (inner.with_tree(without_brackets(side)) for side in (tree.left, tree.right))
                if _are_values_of_one(first, later):
                    yield _finding(clause, inner, first, later)


def _are_values_of_one(first: ScopedExpression, later: ScopedExpression) -> bool:
    """Whether two conditions are tests for different values of one enum, which has a third one."""
    one, other = first.tree, later.tree
    if not isinstance(one, IsExpr) or not isinstance(other, IsExpr) or one.negated or other.negated:
        return False
    enum = enum_of(one.operand, first.env)
    is_one = same_text(first, one.operand, other.operand) and one.value != other.value
    return is_one and enum is not None and len(enum.values) > 2


def _finding(
    clause: Clause, sequence: ScopedExpression, first: ScopedExpression, later: ScopedExpression
) -> RuleFinding:
    assert isinstance(sequence.tree, BinaryExpr)
    source, change = sequence.source, f"previously {first.text} and {later.text}"
    text = source.text
    before = text[clause.keyword_span.end : sequence.tree.span.start]
    after = text[sequence.tree.span.end : clause.span.end]
    is_whole = not before.strip(" (") and not after.strip(" )")
    meant = f"avoid {change}" if is_whole else " ".join(f"avoid{before}{change}{after}".split())
    label = Label(source, sequence.tree.op_span, "`then` means any later step")
    help_ = (
        f"if only a direct change is meant, write `{meant}`; "
        "if any later step is, allow this with the comment `// tltlc: allow TLT0480`"
    )
    return RuleFinding(f"this forbids `{later.text}` at any later step", (label,), help_)


RULE = LintRule("TLT0480", "note", check)
