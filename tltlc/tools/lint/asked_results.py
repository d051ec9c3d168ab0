"""Find what the rules for every step ask for: the results of `keep a implies b` and `require always (a implies b)`.

A result may be written with a weak operator, which asks for less where play ends. :meth:`Rewriting.differs` says
whether that makes a difference in a spec.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.core.record import record, replace
from tltlc.core.source import Span
from tltlc.grammar.tree import BinaryExpr, Clause, Expr, GroupExpr, Quantified, Unary
from tltlc.grammar.walk import parts
from tltlc.logic.formula import Formula, always, not_
from tltlc.logic.normal_form import negation_normal_form
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import ScopedExpression, SpecView, without_brackets

_MOST_PARTS: Final = 24
"""Of the specs with more clauses, only the clause itself is compared, because the others make it slow."""
_WEAK: Final = {"U": "W", "X": "N"}
"""Maps each strong operator to the weak one."""
_WEAK_WORDS: Final = {"U": "weak_until", "X": "weak_next"}
"""Maps each strong operator to the word for the weak one."""


@record
class AskedResult:
    """A part of the result of an implication, which is asked for wherever ``condition`` holds.

    It has no brackets around it, and is no conjunction. ``steps`` are each `next` and `weak_next` around it.
    """

    part: ScopedExpression
    condition: ScopedExpression
    steps: tuple[ScopedExpression, ...] = ()

    @property
    def next_steps(self) -> list[ScopedExpression]:
        """Each `next` around the result, outer before inner, without those that are weak."""
        return [step for step in self.steps if isinstance(step.tree, Unary) and step.tree.op == "X"]

    def is_all_of(self, clause: Clause, value: ScopedExpression) -> bool:
        """Whether a `keep` clause with this formula asks for this part alone, so that a help can write it anew."""
        rule = without_brackets(value.tree)
        return (
            clause.kind == "keep"
            and isinstance(rule, BinaryExpr)
            and without_brackets(rule.left) is self.condition.tree
            and without_brackets(rule.right) is without_brackets(self.part.tree)
        )


def asked_results(clause: Clause, value: ScopedExpression) -> Iterator[AskedResult]:
    """Yield what a clause asks for at each step where the condition of an implication holds, in the order of the text.

    The body of an `all` is that of the first entity. The operand of a `next` follows the `next` itself.
    """
    root = without_brackets(value.tree)
    if clause.kind == "require":
        if not isinstance(root, Unary) or root.op != "G" or root.bound is not None:
            return
        root = root.operand
    elif clause.kind != "keep":
        return
    pending: list[tuple[ScopedExpression, ScopedExpression | None, tuple[ScopedExpression, ...]]]
    pending = [(value.with_tree(root), None, ())]
    while pending:
        part, condition, steps = pending.pop()
        tree = part.tree
        if isinstance(tree, GroupExpr) or (isinstance(tree, Quantified) and tree.all):
            pending.append((part.children()[0], condition, steps))
        elif isinstance(tree, BinaryExpr) and tree.op == "and":
            pending += [(side, condition, steps) for side in reversed(part.children())]
        elif isinstance(tree, BinaryExpr) and tree.op == "implies":
            pending.append((part.with_tree(tree.right), part.with_tree(without_brackets(tree.left)), steps))
        elif condition is not None:
            yield AskedResult(part, condition, steps)
            if isinstance(tree, Unary) and tree.op in ("X", "N"):
                pending.append((part.with_tree(tree.operand), condition, (*steps, part)))


@record
class Rewriting:
    """A clause in which some strong operators, ``until`` or ``next``, may be made weak."""

    clause: Clause
    value: ScopedExpression
    spec: SpecView

    def differs(self, operators: Sequence[ScopedExpression], others: Sequence[ScopedExpression]) -> bool:
        """Whether the spec would accept more if the ``operators`` were weak; ``others`` are weak in both.

        Also return True if this cannot be decided.
        """
        strong = self._formula(others)
        weak = self._formula([*operators, *others])
        spec, place = self.spec.spec, self.clause.span
        if strong is None or weak is None or not {*strong.atoms()} <= {atom.name for atom in spec.atoms}:
            return True
        rest = [part for part in spec.parts if not (part.source == self.value.source and place.covers(part.span))]
        rules = {rule.span for rule, _ in self.spec.clauses("keep", "avoid")}
        rest = [replace(part, formula=_without_times(part, is_rule=part.span in rules)) for part in rest]
        compared = [Conjunct(formula, self.value.source, place) for formula in (weak, not_(strong))]
        known = (*(rest if len(rest) < _MOST_PARTS else ()), *relations(self.spec, strong.atoms()))
        return not self.spec.decision((*compared, *known), spec)

    def text(self, operators: Sequence[ScopedExpression]) -> str:
        """Return the text of the clause, or of a spec's formula, with these operators weak.

        It is on one line, without comments.
        """
        source = self.value.source
        whole = self.clause.span if self.spec.declaration.block else self.value.tree.span
        pieces, place = [], whole.start
        words = {_word(operator.tree): operator.tree for operator in operators}
        for span in sorted(words, key=lambda span: span.start):
            op = _operator(words[span])
            pieces += [source.text[place : span.start], _WEAK[op] if source.slice(span) == op else _WEAK_WORDS[op]]
            place = span.end
        lines = "".join([*pieces, source.text[place : whole.end]]).splitlines()
        return " ".join(word for line in lines for word in line.partition("//")[0].split())

    def _formula(self, operators: Sequence[ScopedExpression]) -> Formula | None:
        """Return the formula of the clause with these operators weak; None if it is unknown."""
        weak = {id(operator.tree) for operator in operators}
        formula = self.value.with_tree(_rewritten(self.value.tree, weak)).formula()
        return always(formula) if formula is not None and self.clause.kind == "keep" else formula


def _word(tree: Expr) -> Span:
    assert isinstance(tree, (Unary, BinaryExpr))
    return tree.op_span


def _operator(tree: Expr) -> str:
    assert isinstance(tree, (Unary, BinaryExpr))
    return tree.op


def _without_times(part: Conjunct, *, is_rule: bool) -> Formula:
    """Return the formula of a clause with `eventually p` for `eventually within 3 s p`, which says less.

    Return the whole formula if it has an `always` that may have had a time: without it, that would say more.
    The `always` of a rule, a `keep` or `avoid` clause, had none.
    """
    if part.unbounded is None:
        return part.formula
    normal = negation_normal_form(part.unbounded)
    has_always = any(node.op == "G" and not (is_rule and node is normal) for node in normal.bottom_up())
    return part.formula if has_always else part.unbounded


def _rewritten(tree: Expr, weak: set[int]) -> Expr:
    """Return an expression in which the operators with these ids are weak. Does not recurse."""
    if not weak:
        return tree
    rewritten: dict[int, Expr] = {}
    for part in reversed([*parts(tree)]):
        fields = {name: rewritten.get(id(getattr(part, name)), getattr(part, name)) for name in _operand_fields(part)}
        changed = any(value is not getattr(part, name) for name, value in fields.items())
        if id(part) in weak:
            assert isinstance(part, (Unary, BinaryExpr))
            rewritten[id(part)] = replace(part, op=_WEAK[part.op], **fields)
        elif changed:
            rewritten[id(part)] = replace(part, **fields)
    return rewritten.get(id(tree), tree)


def _operand_fields(part: Expr) -> tuple[str, ...]:
    """Return the names of the fields with the operands of an operator that may be around a result."""
    match part:
        case Unary():
            return ("operand",)
        case BinaryExpr():
            return ("left", "right")
        case GroupExpr():
            return ("inner",)
        case Quantified():
            return ("body",)
    return ()
