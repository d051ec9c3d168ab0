"""TLT0455: `avoid a then b`, which allows b at the very step of a."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Clause
from tltlc.logic.formula import Formula, and_, eventually, not_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_MOST_PARTS: Final = 24
"""In specs with more clauses, the others are not asked whether they forbid both at one step; that would be slow."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `avoid` clause that forbids two conditions in sequence, but not at one step.

    There is none if the two never hold together, or if the other clauses forbid that. Nor is there one if one of
    them includes the other: `avoid a and b` would forbid that one altogether.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("avoid"):
            tree = without_brackets(value.tree)
            if isinstance(tree, BinaryExpr) and tree.op == "then" and (tree.bound is None or tree.bound.low is None):
                first, second = (value.with_tree(without_brackets(side)) for side in (tree.left, tree.right))
                if _may_coincide(first.formula(), second.formula(), clause, spec):
                    yield _finding(value.with_tree(tree), first, second)


def _may_coincide(first: Formula | None, second: Formula | None, clause: Clause, spec: SpecView) -> bool:
    """Whether two conditions may hold at one step, with or without each other."""
    if first is None or second is None or not (is_state(first) and is_state(second)):
        return False
    states = (and_(first, second), and_(first, not_(second)), and_(second, not_(first)))
    if not all(_can_be(state, (), clause, spec) for state in states):
        return False
    source = spec.env.scope.source
    others = tuple(part for part in spec.spec.parts if part.source != source or not clause.span.covers(part.span))
    return len(others) >= _MOST_PARTS or _can_be(states[0], others, clause, spec)


def _can_be(state: Formula, others: tuple[Conjunct, ...], clause: Clause, spec: SpecView) -> bool:
    """Whether a trace that keeps the other clauses may come to a state, as far as is known."""
    known = {atom.name for atom in spec.spec.atoms}
    if not known.issuperset(state.atoms()):
        return True
    part = Conjunct(eventually(state), spec.spec.source, clause.span)
    return not spec.decision((part, *others, *relations(spec, state.atoms())), spec.spec)


def _finding(sequence: ScopedExpression, first: ScopedExpression, second: ScopedExpression) -> RuleFinding:
    assert isinstance(sequence.tree, BinaryExpr)
    bound = sequence.tree.bound
    time = f" {' '.join(sequence.source.slice(bound.span).split())}" if bound is not None else ""
    label = Label(
        sequence.source, sequence.tree.op_span, f"so `{second.text}` at the very step of `{first.text}` is allowed"
    )
    help_ = (
        f"to forbid it at that step, too, write `avoid {operand_text(second)} and once{time} {operand_text(first)}`; "
        "if only later steps count, allow it with the comment `// tltlc: allow TLT0455`"
    )
    return RuleFinding("`then` means a later step", (label,), help_)


RULE = LintRule("TLT0455", "note", check)
