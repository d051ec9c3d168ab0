"""Find `next(x) > x`, where `next` applies to the comparison and not to the number, and write what was meant."""

from __future__ import annotations

from typing import Final

from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, GroupExpr, NameExpr, Unary
from tltlc.logic.text.phrases import is_state
from tltlc.tools.lint.file_view import ScopedExpression, SpecView, operand_text, without_brackets

_COMPARISONS: Final = ("<", "<=", ">", ">=")


def compared_next(name: str, spec: SpecView) -> tuple[ScopedExpression, str] | None:
    """Return the first `next` that applies to the comparison with the atom ``name``, and advice; None without one.

    The operand of `next` must have no brackets around the whole comparison, so that it seems to be a number.
    """
    for clause, value in spec.clauses("reach", "keep", "avoid", "require"):
        for part in value.parts():
            comparison = part.tree.operand if isinstance(part.tree, Unary) and part.tree.op in ("X", "N") else None
            if isinstance(comparison, BinaryExpr) and comparison.op in _COMPARISONS:
                compared = part.with_tree(comparison)
                formula = compared.formula()
                if formula is not None and formula.atoms() == (name,):
                    return part, _advice(clause, value, part, compared)
    return None


def _advice(clause: Clause, value: ScopedExpression, operator: ScopedExpression, compared: ScopedExpression) -> str:
    assert isinstance(operator.tree, Unary)
    word, (shown, meant) = operator.source.slice(operator.tree.op_span), _with_values_before(compared)
    advice = f"`{word}` applies to the comparison `{shown}`, not to the number"
    rule = without_brackets(value.tree)
    if clause.kind == "keep" and isinstance(rule, BinaryExpr) and rule.op == "implies":
        condition = value.with_tree(rule.left)
        formula = condition.formula()
        if without_brackets(rule.right) == operator.tree and formula is not None and is_state(formula):
            return f"{advice}: write `keep previously {operand_text(condition)} implies {meant}`"
    return f"{advice}: compare it one step later, where the step before is known: `{meant}`"


def _with_values_before(compared: ScopedExpression) -> tuple[str, str]:
    """Return the text of a comparison, and that with `previous(x)` for each signal but the operand of `next`."""
    comparison, source = compared.tree, compared.source
    assert isinstance(comparison, BinaryExpr)
    first: Expr = comparison
    while isinstance(first, BinaryExpr):
        first = first.left
    inside = without_brackets(first)
    named = isinstance(first, GroupExpr) and isinstance(inside, (NameExpr, CallExpr))
    now = source.slice((inside if named else first).span)
    edits = []
    pending = [comparison.right, comparison.left]
    while pending:
        part = pending.pop()
        if part is first:
            continue
        if isinstance(part, (NameExpr, CallExpr)) and _is_signal(part, compared):
            edits.append(part.span)
        else:
            pending += reversed([*walk.children(part)])
    end = first.span.end
    shown = meant = now
    for span in sorted(edits, key=lambda span: span.start):
        between, text = source.text[end : span.start], source.slice(span)
        shown, meant, end = f"{shown}{between}{text}", f"{meant}{between}previous({text})", span.end
    rest = source.text[end : comparison.span.end]
    return " ".join(f"{shown}{rest}".split()), " ".join(f"{meant}{rest}".split())


def _is_signal(part: NameExpr | CallExpr, compared: ScopedExpression) -> bool:
    binding = compared.env.scope.names.get(part.name)
    return binding is not None and binding.kind == "signal"
