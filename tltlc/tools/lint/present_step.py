"""Find operators about several steps of which the present step decides all that matters.

`eventually a` means "a now, or later". Let the part about later steps be a truth value of its own, which
may be anything: then `b implies eventually a` is ``b -> (a | later)``. If a formula is the same for both
values of ``later``, then the present step decides it. How long a bound is makes no difference.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final, Literal

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.core.record import record, replace
from tltlc.core.source import Span
from tltlc.expression.tree import Const
from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, Quantified, Unary
from tltlc.logic.formula import FALSE, TRUE, Formula, and_, atom, iff, implies, not_, or_, rebuild
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Atom, Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import ScopedExpression, SpecView, without_brackets
from tltlc.tools.lint.timer_relations import timer_relations

Outcome = Literal["true", "false", "operand"]

_SOME: Final = ("F", "once", "within")
_ALL: Final = ("G", "historically")
_UNTIL: Final = ("U", "W", "since")
_RELEASE: Final = ("R", "M")
_TEMPORAL: Final = (*_SOME, *_ALL, *_UNTIL, *_RELEASE, "X", "N", "then", "previously", "begins", "ends")


@record
class DecidedOperator:
    """An operator of which the present step decides all that matters.

    ``outcome`` says what the operator means there: ``true``, ``false``, or its last operand.
    ``is_negated`` says that the formula around it negates it.
    """

    operator: ScopedExpression
    outcome: Outcome
    is_negated: bool


def decided_operators(formula: ScopedExpression, spec: SpecView) -> list[DecidedOperator]:
    """Return the operators in a formula that the present step decides, in the order of the text.

    An operator in the body of `all` or `any` is decided if it is so for each entity, in the same way.
    Operators under `iff`, which have both signs, are left out.
    """
    by_span: dict[Span, list[DecidedOperator | None]] = {}
    for root in _roots(formula):
        step = _PresentStep(root)
        for index, place in enumerate(step.places):
            outcome = _outcome(step, index, spec)
            decided = None if outcome is None else DecidedOperator(place.operator, outcome, place.is_negated)
            by_span.setdefault(place.operator.tree.span, []).append(decided)
    return [
        first
        for first, *others in by_span.values()
        if first is not None and all(other is not None and _is_alike(first, other) for other in others)
    ]


def _is_alike(one: DecidedOperator, other: DecidedOperator) -> bool:
    return (one.outcome, one.is_negated) == (other.outcome, other.is_negated)


def _roots(formula: ScopedExpression) -> Iterator[ScopedExpression]:
    """Yield the formula, and the operands of the temporal operators in it."""
    yield formula
    for part in formula.parts():
        if isinstance(part.tree, (Unary, BinaryExpr)) and part.tree.op in _TEMPORAL:
            yield from part.children()


@record
class _Place:
    """An operator in a formula about the present step.

    ``present`` is its formula with the atom ``others`` in place of what it says of other steps, and
    ``last`` the formula of its last operand. ``name`` is the name of the atom that stands for it.
    """

    operator: ScopedExpression
    is_negated: bool
    name: str
    others: Formula
    present: Formula
    last: Formula


class _PresentStep:
    """A formula about the present step: atoms of their own stand for whatever is about other steps.

    ``places`` has the operators about the present step and others, and ``unknown`` the names of the new atoms.
    """

    def __init__(self, root: ScopedExpression) -> None:
        self.places: list[_Place] = []
        self.unknown: dict[object, str] = {}
        self.root = root
        self._formula = self._encode(root, False)

    def with_values(self, values: Mapping[str, Formula]) -> Formula:
        """Return the formula, with these formulas in place of the atoms with these names."""
        places = {place.name: place.present for place in self.places}
        return _substitute(_substitute(self._formula, {**places, **values}), values)

    def _encode(self, part: ScopedExpression, is_negated: bool | None) -> Formula:
        """Return the formula of a part of the root. ``is_negated`` is None under `iff`."""
        tree = without_brackets(part.tree)
        part = part.with_tree(tree)
        if isinstance(tree, Quantified):
            return (and_ if tree.all else or_)(*(self._encode(body, is_negated) for body in part.children()))
        if isinstance(tree, Unary) and tree.op == "not":
            return not_(self._encode(part.with_tree(tree.operand), None if is_negated is None else not is_negated))
        if isinstance(tree, BinaryExpr) and tree.op in ("and", "or"):
            parts = (self._encode(part.with_tree(each), is_negated) for each in walk.operands(tree, tree.op))
            return (and_ if tree.op == "and" else or_)(*parts)
        if isinstance(tree, BinaryExpr) and tree.op == "implies":
            left = self._encode(part.with_tree(tree.left), None if is_negated is None else not is_negated)
            return implies(left, self._encode(part.with_tree(tree.right), is_negated))
        if isinstance(tree, BinaryExpr) and tree.op == "iff":
            return iff(*(self._encode(part.with_tree(each), None) for each in (tree.left, tree.right)))
        if isinstance(tree, (Unary, BinaryExpr)) and _counts_present(tree):
            return self._operator(part, tree, is_negated)
        if isinstance(tree, Unary) and tree.op in ("begins", "ends"):
            now = self._opaque(part.with_tree(tree.operand))
            return and_(now if tree.op == "begins" else not_(now), self._opaque(part))
        return self._opaque(part)

    def _operator(self, part: ScopedExpression, tree: Unary | BinaryExpr, is_negated: bool | None) -> Formula:
        operands = [self._opaque(operand) for operand in part.children()]
        first, last = operands[0], operands[-1]
        others = atom(self._new_name(("others", len(self.unknown))))
        if tree.op in _SOME:
            present = or_(last, others)
        elif tree.op in _ALL:
            present = and_(last, others)
        elif tree.op in _UNTIL:
            present = or_(last, and_(first, others))
        else:
            present = and_(last, or_(first, others))
        if is_negated is None:
            return present
        place = _Place(part, is_negated, self._new_name(("place", len(self.unknown))), others, present, last)
        self.places.append(place)
        return implies(first, atom(place.name)) if tree.op == "within" else atom(place.name)

    def _opaque(self, part: ScopedExpression) -> Formula:
        """Return the formula of a part if it is about the present step alone, else an atom that stands for it."""
        formula = part.formula()
        if formula is None:
            return atom(self._new_name(("part", len(self.unknown))))
        return formula if is_state(formula) else atom(self._new_name(formula))

    def _new_name(self, key: object) -> str:
        # No name in a source file begins with a question mark.
        return self.unknown.setdefault(key, f"?{len(self.unknown)}")


def _counts_present(tree: Unary | BinaryExpr) -> bool:
    """Whether this is an operator about the present step and others."""
    if tree.op not in (*_SOME, *_ALL, *_UNTIL, *_RELEASE):
        return False
    bound = tree.bound
    return bound is None or (bound.high.value > 0 and (bound.low is None or bound.low.value == 0))


def _outcome(step: _PresentStep, index: int, spec: SpecView) -> Outcome | None:
    """Return what an operator means if the present step decides it, else None."""
    place = step.places[index]
    with_others, without = (step.with_values({place.others.name: value}) for value in (TRUE, FALSE))
    rest = step.with_values({place.name: TRUE})
    inside, outside = place.present.atoms(), rest.atoms()
    proved = (*relations(spec, with_others.atoms()), *timer_relations(spec, with_others.atoms()))
    if not _are_related(set(inside), set(outside), proved, spec):
        return None
    atoms = (*spec.spec.atoms, *(Atom(name, Const(0.0)) for name in step.unknown.values()))
    declared = replace(spec.spec, atoms=atoms)

    def is_equal(other: Formula) -> bool:
        part = Conjunct(not_(iff(with_others, other)), step.root.source, step.root.tree.span)
        return unsatisfiable((part, *proved), declared)

    if not is_equal(without):
        return None
    if is_equal(rest):
        return "true"
    return "false" if is_equal(step.with_values({place.name: FALSE})) else "operand"


def _are_related(one: set[str], other: set[str], proved: tuple[Conjunct, ...], spec: SpecView) -> bool:
    """Whether two sets of atoms have an atom in common, or atoms of which something is known together."""
    groups = [set(relation.formula.atoms()) for relation in proved]
    groups += [{spec.spec.atoms[index].name for index in group} for group in spec.spec.exclusive]
    return bool(one & other) or any(group & one and group & other for group in groups)


def _substitute(formula: Formula, values: Mapping[str, Formula]) -> Formula:
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        if node.op == "atom" and node.name in values:
            done[node] = values[node.name]
        else:
            done[node] = rebuild(node, tuple(done[operand] for operand in node.args))
    return done[formula]
