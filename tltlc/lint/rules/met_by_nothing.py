"""TLT0412: a goal that is met where nothing has been done, because it may be met by what does not hold."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Binary
from tltlc.lint.goals import conjuncts, goals
from tltlc.lint.rule import Remark, Rule
from tltlc.lint.view import Expression, SpecView, View, inner, operand
from tltlc.logic.formula import Formula, and_, atom, eventually, not_, or_, rebuild
from tltlc.resolve.spec import Part


def check(view: View) -> Iterator[Remark]:
    """A remark for each goal that can be met while none of what it asks for holds, whatever the other clauses ask."""
    for spec in view.specs:
        if spec.fspa.states[0].verdict not in ("satisfied", "violated"):
            for goal in goals(spec):
                awaited = _met_without(goal, spec)
                if awaited:
                    yield _remark(goal, awaited)


def _met_without(goal: Expression, spec: SpecView) -> list[str]:
    """What a goal asks for, where it can be met while none of it holds; nothing where it cannot."""
    formula = goal.formula()
    if formula is None:
        return []
    still = _standing_still(formula)
    holding, failing = _wanted(still)
    awaited = [name for name in holding if name not in failing]
    # A goal that is only to hold, or only not to hold, is one that a player brings about.
    if not awaited or not failing:
        return []

    def can_be(state: Formula) -> bool:
        part = Part(eventually(state), goal.source, goal.tree.span)
        return not spec.decision((*spec.spec.parts, part), spec.spec)

    # What the other clauses keep anyway is nothing to bring about.
    awaited = [name for name in awaited if can_be(not_(atom(name)))]
    met = and_(still, *(not_(atom(name)) for name in awaited))
    return awaited if can_be(met) else []


def _standing_still(formula: Formula) -> Formula:
    """What a formula comes to while nothing changes: one without temporal operators."""
    found: dict[Formula, Formula] = {}
    for part in formula.bottom_up():
        args = tuple(found[each] for each in part.args)
        if part.op in ("X", "N", "F", "G"):
            found[part] = args[0]
        elif part.op in ("U", "R"):
            found[part] = args[1]
        elif part.op == "W":
            found[part] = or_(*args)
        elif part.op == "M":
            found[part] = and_(*args)
        else:
            found[part] = rebuild(part, args)
    return found[formula]


def _wanted(state: Formula) -> tuple[list[str], list[str]]:
    """The atoms whose truth helps a formula, and those whose falsehood does; some may be both."""
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
            waiting += [(each, sign) for each in part.args for sign in (True, False)]
        else:
            waiting += [(each, holds) for each in reversed(part.args)]
    atoms = [(part.name, holds) for part, holds in signs if part.op == "atom"]
    return [name for name, holds in atoms if holds], [name for name, holds in atoms if not holds]


def _remark(goal: Expression, awaited: list[str]) -> Remark:
    labels, ways = [], []
    # The body of `all` is one place, for all its entities.
    for part in {part.tree.span: part for part in conjuncts(goal) if _is_implication(part)}.values():
        assert isinstance(part.tree, Binary)
        condition, result = part.at(part.tree.left), part.at(part.tree.right)
        labels.append(Label(part.source, part.tree.span, f"true while {condition.text} is false"))
        ways.append(f"{operand(condition)} and {operand(result)}")
    if labels:
        return Remark(_TITLE, tuple(labels), f"`{ways[0]}`" if len(ways) == 1 else f"`({') or ('.join(ways)})`")
    listed = " and ".join(f"`{name}`" for name in awaited)
    label = Label(goal.source, inner(goal.tree).span, f"can be met without {listed}")
    return Remark(_TITLE, (label,), f"ask with `and` for what is to be done, or for {listed} alone")


def _is_implication(part: Expression) -> bool:
    return isinstance(part.tree, Binary) and part.tree.op == "implies"


_TITLE: Final = "this goal can be met without doing anything"

RULE = Rule("TLT0412", "warning", check)
