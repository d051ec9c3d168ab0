"""TLT0412: a goal that can be met without doing anything, because false atoms can meet it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr
from tltlc.logic.formula import TRUE, Formula, and_, atom, eventually, not_, or_, rebuild
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.file_view import Expression, SpecView, View, inner, operand
from tltlc.tools.lint.goals import conjuncts, goals
from tltlc.tools.lint.relations import relations
from tltlc.tools.lint.rule import LintRule, Remark


def check(view: View) -> Iterator[Remark]:
    """Yield a remark for each goal that can be met while none of the atoms it asks for holds.

    The other clauses are taken into account.
    """
    for spec in view.specs:
        if not spec.is_settled:
            for goal in goals(spec):
                yield from _remarks(goal, spec)


def _remarks(goal: Expression, spec: SpecView) -> Iterator[Remark]:
    formula = goal.formula()
    if formula is None:
        return
    still = _standing_still(formula)
    holding, failing = _wanted(still)
    # If all atoms should hold, or all should not, the player has to bring the goal about.
    if not failing or not set(holding) - set(failing):
        return

    known = relations(spec, spec.spec.formula.atoms())

    def can_be(state: Formula) -> bool:
        part = Conjunct(eventually(state), goal.source, goal.tree.span)
        return not spec.decision((*spec.spec.parts, *known, part), spec.spec)

    # If the other clauses already ensure an atom, there is nothing to do for it.
    missing = [name for name in holding if can_be(not_(atom(name)))]
    awaited = [name for name in missing if name not in failing]
    met = and_(formula, still, *(not_(atom(name)) for name in missing))
    if awaited and can_be(met):
        implications = _implications(goal)
        conditions = (part.formula() or TRUE for part, _ in implications)
        # If some condition always holds, the implications are not the reason.
        if implications and can_be(and_(met, *map(not_, conditions))):
            yield _of_implications(implications)
        else:
            listed = " and ".join(f"`{name}`" for name in awaited)
            label = Label(goal.source, inner(goal.tree).span, f"can be met without {listed}")
            yield Remark(_TITLE, (label,), f"ask with `and` for what is to be done, or for {listed} alone")


def _standing_still(formula: Formula) -> Formula:
    """Return what a formula amounts to while nothing changes, without temporal operators."""
    still: dict[Formula, Formula] = {}
    for part in formula.bottom_up():
        args = tuple(still[argument] for argument in part.args)
        if part.op in ("X", "N", "F", "G"):
            still[part] = args[0]
        elif part.op in ("U", "R"):
            still[part] = args[1]
        elif part.op == "W":
            still[part] = or_(*args)
        elif part.op == "M":
            still[part] = and_(*args)
        else:
            still[part] = rebuild(part, args)
    return still[formula]


def _wanted(state: Formula) -> tuple[list[str], list[str]]:
    """Return the atoms whose truth helps a formula, and those whose falsehood does.

    An atom may be in both.
    """
    signs: dict[tuple[Formula, bool], None] = {}
    waiting = [(state, True)]
    while waiting:
        part, holds = waiting.pop()
        if (part, holds) in signs:
            continue
        signs[part, holds] = None
        if part.op == "not":
            waiting.append((part.args[0], not holds))
        elif part.op == "implies":
            waiting += (part.args[1], holds), (part.args[0], not holds)
        elif part.op == "iff":
            waiting += [(argument, sign) for argument in part.args for sign in (True, False)]
        else:
            waiting += [(argument, holds) for argument in reversed(part.args)]
    atoms = [(part.name, holds) for part, holds in signs if part.op == "atom"]
    return [name for name, holds in atoms if holds], [name for name, holds in atoms if not holds]


def _implications(goal: Expression) -> list[tuple[Expression, Expression]]:
    """Return the condition and the result of each implication that a goal asks for.

    The body of `all` counts once for all entities.
    """
    by_span: dict[Span, tuple[Expression, Expression]] = {}
    for part in conjuncts(goal):
        if isinstance(part.tree, BinaryExpr) and part.tree.op == "implies":
            by_span[part.tree.span] = part.at(part.tree.left), part.at(part.tree.right)
    return list(by_span.values())


def _of_implications(implications: list[tuple[Expression, Expression]]) -> Remark:
    labels, alternatives = [], []
    for condition, result in implications:
        span = condition.tree.span.to(result.tree.span)
        labels.append(Label(condition.source, span, f"true while {condition.text} is false"))
        alternatives.append(f"{operand(condition)} and {operand(result)}")
    return Remark(
        _TITLE,
        tuple(labels),
        f"`{alternatives[0]}`" if len(alternatives) == 1 else f"`({') or ('.join(alternatives)})`",
    )


_TITLE: Final = "this goal can be met without doing anything"

RULE = LintRule("TLT0412", "warning", check)
