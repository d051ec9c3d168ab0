"""Find clauses that forbid p by mistake, because `time_holding(p)` is 0 s at the step at which p begins."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.core.record import record
from tltlc.expression.evaluate import evaluate
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, NumberExpr, Unary
from tltlc.grammar.walk import conjuncts
from tltlc.logic.formula import Formula, and_, atom, not_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.timer_relations import readers


@record
class ForbiddenStretch:
    """A rule that each stretch of ``event`` breaks at its first step.

    ``rule`` is the conjunct of a clause, or the expression of an `avoid` clause. ``comparison`` is the
    part of it that compares the timer ``time_holding(event)``. ``forbidden`` is what the rule forbids
    therefore: the event, or a condition of which the event is a part.
    """

    rule: ScopedExpression
    comparison: ScopedExpression
    event: ScopedExpression
    forbidden: ScopedExpression

    @property
    def least(self) -> str:
        """The time with which the timer is compared, as in the source text; "" if it is 0 or no number."""
        tree = self.comparison.tree
        assert isinstance(tree, BinaryExpr)
        for side in (tree.left, tree.right):
            if isinstance(side, NumberExpr) and side.value > 0:
                return self.comparison.with_tree(side).text
        return ""

    def lasting_rule(self) -> str:
        """Return the formula that each stretch lasts for the time ``least``; it belongs to every step."""
        event = operand_text(self.event)
        return f"begins {event} implies always for {self.least} {event}"


def forbidden_stretches(clause: Clause, value: ScopedExpression, spec: SpecView) -> Iterator[ForbiddenStretch]:
    """Yield the rules of a clause that no stretch of some event can keep at its first step.

    A rule is left out if it forbids the event whatever the timer is, or if no step can keep it.
    """
    for tree in every_step(clause, value) if clause.kind != "avoid" else [value.tree]:
        rule = value.with_tree(tree)
        for comparison, event in _timers(rule):
            formula, begins, at_zero = rule.formula(), _begins(event, spec), _at_zero(comparison, spec)
            if formula is None or begins is None or at_zero is None or not is_state(formula):
                continue
            kept = not_(formula) if clause.kind == "avoid" else formula
            if (
                not _can_be(and_(begins, at_zero, kept), rule, spec)
                and _can_be(and_(begins, kept), rule, spec)
                and _can_be(and_(at_zero, kept), rule, spec)
            ):
                yield ForbiddenStretch(rule, comparison, event, _forbidden(rule, event, at_zero, spec))


def every_step(clause: Clause, value: ScopedExpression) -> list[Expr]:
    """Return the conjuncts of the formula that a clause requires at every step, or [] if it has another form."""
    tree = without_brackets(value.tree)
    if clause.kind == "require":
        if not isinstance(tree, Unary) or tree.op != "G" or tree.bound is not None:
            return []
        tree = tree.operand
    return [without_brackets(part) for part in conjuncts(tree)]


def forbidding_clause(event: ScopedExpression) -> str:
    """Return the clause that forbids an event: `avoid a`, or `keep a` for the event `not a`."""
    tree = without_brackets(event.tree)
    if isinstance(tree, Unary) and tree.op == "not":
        return f"keep {event.with_tree(tree.operand).text}"
    return f"avoid {event.text}"


def _timers(rule: ScopedExpression) -> Iterator[tuple[ScopedExpression, ScopedExpression]]:
    """Yield the comparisons of `time_holding(p)`, each with p."""
    for part in rule.parts():
        if isinstance(part.tree, BinaryExpr):
            for side in map(without_brackets, (part.tree.left, part.tree.right)):
                if isinstance(side, CallExpr) and side.name == "time_holding":
                    yield part, part.with_tree(without_brackets(side.arguments[0].value))


def _forbidden(rule: ScopedExpression, event: ScopedExpression, at_zero: Formula, spec: SpecView) -> ScopedExpression:
    """Return the condition of an implication if the rule forbids it together with the event, else the event."""
    tree, formula = rule.tree, rule.formula()
    if isinstance(tree, BinaryExpr) and tree.op == "implies" and formula is not None:
        condition = rule.with_tree(tree.left)
        held, begun = condition.formula(), event.formula()
        assert held is not None and begun is not None
        without_event, without_condition = and_(held, at_zero, formula, not_(begun)), and_(begun, not_(held))
        if not _can_be(without_event, rule, spec) and not _can_be(without_condition, rule, spec):
            return condition
    return event


def _begins(event: ScopedExpression, spec: SpecView) -> Formula | None:
    """Return the formula `begins event`, or that of the event if no atom of the spec reads its last value."""
    tree = event.tree
    known = {candidate.name for candidate in spec.fspa.atoms}
    begins = event.with_tree(Unary("begins", tree, None, tree.span, tree.span)).formula()
    return begins if begins is None or known.issuperset(begins.atoms()) else event.formula()


def _at_zero(comparison: ScopedExpression, spec: SpecView) -> Formula | None:
    """Return whether each atom of a comparison holds if the timer that it reads is 0, as a formula."""
    compared = comparison.formula()
    if compared is None:
        return None
    literals = (
        atom(reader.name) if evaluate(reader.expression, {timer.name: 0.0}, {}) > 0 else not_(atom(reader.name))
        for timer, reader in readers(spec, compared.atoms())
    )
    return and_(*literals)


def _can_be(state: Formula, rule: ScopedExpression, spec: SpecView) -> bool:
    part = Conjunct(state, rule.source, rule.tree.span)
    return not unsatisfiable((part, *relations(spec, state.atoms())), spec.spec)
