"""Decide whether a bound matters, by comparing a clause with simpler ones.

``F[0,n] p`` lies between ``p | X p`` and ``F p`` for each n above 0: the first implies it, and it implies the
second. Clauses with these formulas in its place lie in the same order, or the other way round where the
operator is negated. So if the first and the last clause are equal, then the one with the bound equals both.
The automata of such clauses are small, however long the bound is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final, Literal

from tltlc.automaton.finite.contradiction import contradiction, unsatisfiable
from tltlc.core.record import record, replace
from tltlc.core.source import Span
from tltlc.expression.tree import Const
from tltlc.grammar.tree import BinaryExpr, Clause, Unary
from tltlc.grammar.walk import conjuncts
from tltlc.logic.formula import (
    Formula,
    always,
    and_,
    atom,
    bound_of,
    eventually,
    next_,
    not_,
    or_,
    rebuild,
    time_bound_of,
    weak_next,
)
from tltlc.resolve.formulas import with_bounds
from tltlc.resolve.spec import Atom, Conjunct
from tltlc.resolve.unfolding import bounded_parts
from tltlc.tools.lint.file_view import ScopedExpression, SpecView

_MOST_OTHERS: Final = 3
"""The most other clauses that a comparison takes into account."""

Meaning = Literal["implied", "operand", "unbounded"]


@record
class NeedlessBound:
    """A bound without which its clause means the same.

    ``whole`` is the formula of the clause, or a conjunct of `require`. ``meaning`` says what it means the same
    with: with the ``operand`` of the operator alone, or with the ``unbounded`` operator. ``implied`` says that
    other clauses imply the clause, whatever the bound is. ``reasons`` are the clauses that this depends on.
    """

    operator: ScopedExpression
    whole: ScopedExpression
    meaning: Meaning
    reasons: tuple[Conjunct, ...]


def needless_bounds(spec: SpecView) -> Iterator[tuple[Clause, NeedlessBound]]:
    """Yield the bounds without which the clauses of a spec mean the same, each with its clause.

    The spec must be over finite traces. Bounds that begin later, and clauses that every trace or no trace
    satisfies, are left out. So are bounds about which no short proof is found.
    """
    for clause, value in spec.clauses("reach", "keep", "avoid", "require"):
        trees = conjuncts(value.tree) if clause.kind == "require" else [value.tree]
        for whole in map(value.with_tree, trees):
            formula = _of_clause(clause, with_bounds(whole.tree, whole.env))
            if any(True for _ in bounded_parts(formula)):
                for needless in _in_clause(formula, clause, whole, spec):
                    yield clause, needless


def _of_clause(clause: Clause, formula: Formula) -> Formula:
    if clause.kind == "keep":
        return always(formula)
    if clause.kind == "avoid":
        return always(not_(formula))
    is_sequence = isinstance(clause.value, BinaryExpr) and clause.value.op == "then"
    return formula if clause.kind == "require" or is_sequence else eventually(formula)


def _in_clause(formula: Formula, clause: Clause, whole: ScopedExpression, spec: SpecView) -> Iterator[NeedlessBound]:
    signs = _signs(formula)
    by_span: dict[Span, list[NeedlessBound | None]] = {}
    for part in whole.parts():
        node = _bounded_node(part)
        if node is not None:
            found = None
            if len(signs.get(node, ())) == 1:
                found = _Comparison(formula, node, clause, spec, holds=True in signs[node]).meaning()
            needless = NeedlessBound(part, whole, *found) if found is not None else None
            by_span.setdefault(part.tree.span, []).append(needless)
    for first, *others in by_span.values():
        # In the body of `all`, the bound must be needless for each entity.
        if first is not None and all(other is not None and other.meaning == first.meaning for other in others):
            yield first


def _bounded_node(part: ScopedExpression) -> Formula | None:
    """Return the formula of a bounded operator whose bound begins at once and is longer than one step, else None."""
    tree = part.tree
    if not isinstance(tree, (Unary, BinaryExpr)) or tree.bound is None or tree.op not in ("F", "G", "then", "within"):
        return None
    places = part.env.context.bound_of
    for node in bounded_parts(with_bounds(tree, part.env)):
        if places[node].span == tree.bound.span and places[node].source == part.source:
            bound = bound_of(node)
            return node if bound is None or (bound.low == 0 and bound.high > 0) else None
    return None


def _signs(formula: Formula) -> dict[Formula, set[bool]]:
    """Map each part of a formula to its signs: True if the formula asks for it, False if for its negation."""
    signs: dict[Formula, set[bool]] = {}
    pending = [(formula, True)]
    while pending:
        part, holds = pending.pop()
        if holds in signs.setdefault(part, set()):
            continue
        signs[part].add(holds)
        if part.op == "iff":
            pending += [(operand, sign) for operand in part.args for sign in (True, False)]
        elif part.op == "implies":
            pending += (part.args[0], not holds), (part.args[1], holds)
        else:
            pending += [(operand, holds != (part.op == "not")) for operand in part.args]
    return signs


class _Comparison:
    """Compares a clause with the clauses in which a simpler formula takes the place of a bounded operator."""

    def __init__(self, formula: Formula, node: Formula, clause: Clause, spec: SpecView, *, holds: bool) -> None:
        self._formula, self._node = formula, node
        others = [part for part in bounded_parts(formula) if part is not node]
        # A bounded operator around this one has no formula without its own bound.
        self._is_simple = not any(node in part.walk() for part in others)
        self._unknown = {part: atom(f"?{number}") for number, part in enumerate(others)}
        self._spec = replace(
            spec.spec,
            atoms=(*spec.spec.atoms, *(Atom(unknown.name, Const(0.0)) for unknown in self._unknown.values())),
        )
        # Whether the clause with the operand alone is the strictest, and not the one with the unbounded operator.
        self._ascends = (node.op == "F[]") == holds
        self._others = _others(formula, clause, spec)

    def meaning(self) -> tuple[Meaning, tuple[Conjunct, ...]] | None:
        """Return what the clause means the same with, and the other clauses that this depends on."""
        is_eventually, bound = self._node.op == "F[]", time_bound_of(self._node)
        operand = _substitute(self._node.args[0], self._unknown)
        if not self._is_simple or (bound is not None and bound.later):
            return None
        nearest = self._with(operand)
        unbounded = self._with(eventually(operand) if is_eventually else always(operand))
        two_steps = self._with(or_(operand, next_(operand)) if is_eventually else and_(operand, weak_next(operand)))
        strictest = nearest if self._ascends else unbounded
        if self._reasons(not_(strictest), ()) is not None:
            return None
        # Where the clock varies, the next step may come after the end of the bound.
        pairs: list[tuple[Meaning, Formula]] = [("operand", nearest)]
        pairs += [("unbounded", two_steps)] if bound is None else []
        for others in ((), self._others) if self._others else ((),):
            implied = self._reasons(not_(strictest), others) if others else None
            if implied is not None:
                return "implied", implied
            for meaning, other in pairs:
                larger, smaller = (unbounded, other) if self._ascends else (other, unbounded)
                reasons = self._reasons(and_(larger, not_(smaller)), others)
                if reasons is not None:
                    return meaning, reasons
        return None

    def _with(self, simpler: Formula) -> Formula:
        """Return the clause with a simpler formula in place of the bounded operator."""
        return _substitute(self._formula, {**self._unknown, self._node: simpler})

    def _reasons(self, impossible: Formula, others: Sequence[Conjunct]) -> tuple[Conjunct, ...] | None:
        """Return those of the other clauses that are needed to prove that no trace satisfies a formula, too.

        Return None if there is no short proof.
        """
        part = Conjunct(impossible, self._spec.source, self._spec.name_span)
        if not unsatisfiable((part, *others), self._spec):
            return None
        needed = contradiction(replace(self._spec, parts=(part, *others))) if others else ()
        return tuple(other for other in others if other in needed)


def _others(formula: Formula, clause: Clause, spec: SpecView) -> tuple[Conjunct, ...]:
    """Return the first clauses without bounds that have an atom in common with a formula of another clause."""
    names = set(formula.atoms())
    found = [
        part
        for part in spec.spec.parts
        if part.unbounded is None and not clause.span.covers(part.span) and names.intersection(part.formula.atoms())
    ]
    return tuple(found[:_MOST_OTHERS])


def _substitute(formula: Formula, values: Mapping[Formula, Formula]) -> Formula:
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        done[node] = values.get(node) or rebuild(node, tuple(done[operand] for operand in node.args))
    return done[formula]
