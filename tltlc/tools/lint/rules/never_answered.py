"""TLT0432: `p implies q` where q never holds at the step of p, so p is forbidden.

The same is true of `p implies always for 1 s q`, which begins at the step of p.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Clause, Unary
from tltlc.logic.formula import Formula, always, and_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_REQUIRING: Final = ("implies", "and", "G", "X", "N")
"""Implications, and the operators whose operands are all required to hold."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each required implication whose two sides never hold at the same step.

    Such an implication only forbids its condition. There is no finding if one of the sides never
    holds at all, or if no trace satisfies the clause: then more is wrong.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            implications = [part for part in _implications(value) if _never_together(part, spec)]
            if implications and _can_hold(clause, value, spec):
                yield from map(_finding, implications)


def _implications(value: ScopedExpression) -> Iterator[ScopedExpression]:
    """Yield the implications that an expression requires to hold.

    These are not inside another implication, nor below an operator that ``_REQUIRING`` does not name:
    there they need not hold for the expression to hold.
    """
    pending = [value]
    while pending:
        part = pending.pop()
        if isinstance(part.tree, (Unary, BinaryExpr)) and part.tree.op not in _REQUIRING:
            continue
        if isinstance(part.tree, BinaryExpr) and part.tree.op == "implies":
            yield part
        else:
            pending += reversed(part.children())


def _never_together(implication: ScopedExpression, spec: SpecView) -> bool:
    condition, result = (part.formula() for part in _sides(implication))
    if condition is None or result is None or not is_state(condition) or not is_state(result):
        return False
    proved = relations(spec, and_(condition, result).atoms())

    def can_be(state: Formula) -> bool:
        return not unsatisfiable((Conjunct(state, implication.source, implication.tree.span), *proved), spec.spec)

    return not can_be(and_(condition, result)) and can_be(condition) and can_be(result)


def _sides(implication: ScopedExpression) -> tuple[ScopedExpression, ScopedExpression]:
    """Return the condition of an implication, and what it requires at the same step.

    `always` requires its operand at this step, too, unless its bound begins later.
    """
    tree = implication.tree
    assert isinstance(tree, BinaryExpr)
    lasting = _lasting(implication)
    result = tree.right if lasting is None else lasting.operand
    return implication.with_tree(tree.left), implication.with_tree(result)


def _lasting(implication: ScopedExpression) -> Unary | None:
    """Return the `always` that an implication requires from its own step on, or None."""
    assert isinstance(implication.tree, BinaryExpr)
    right = without_brackets(implication.tree.right)
    if not isinstance(right, Unary) or right.op != "G":
        return None
    low = right.bound.low if right.bound is not None else None
    return right if low is None or low.value == 0 else None


def _can_hold(clause: Clause, value: ScopedExpression, spec: SpecView) -> bool:
    formula = value.formula()
    if formula is None:
        return False
    whole = Conjunct(always(formula) if clause.kind == "keep" else formula, value.source, value.tree.span)
    return not spec.decision((whole, *relations(spec, formula.atoms())), spec.spec)


def _finding(implication: ScopedExpression) -> RuleFinding:
    assert isinstance(implication.tree, BinaryExpr)
    condition, result = _sides(implication)
    label = Label(implication.source, implication.tree.span, f"so this only forbids `{condition.text}`")
    help_ = f"if it comes later, write `{operand_text(condition)} implies eventually {operand_text(result)}`"
    lasting = _lasting(implication)
    if lasting is not None:
        after = f"next {implication.with_tree(lasting).text}"
        help_ = f"for the steps after it, write `{operand_text(condition)} implies {after}`"
    return RuleFinding(f"`{result.text}` never holds at the same step as `{condition.text}`", (label,), help_)


RULE = LintRule("TLT0432", "warning", check)
