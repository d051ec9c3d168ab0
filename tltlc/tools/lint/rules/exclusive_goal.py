"""TLT0414: a goal that asks for exclusive atoms, which never hold together."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.logic.formula import and_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct, Spec
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, without_brackets
from tltlc.tools.lint.goals import conjuncts, goals
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each goal that asks for two atoms of an ``exclusive`` group at one step."""
    for spec in view.specs:
        for goal in goals(spec) if spec.spec.exclusive else ():
            names = _conflicting_atoms(goal, spec)
            if names:
                title = "this goal asks for atoms that never hold together"
                listed = " and ".join(f"`{name}`" for name in names)
                label = Label(goal.source, without_brackets(goal.tree).span, f"{listed} are `exclusive`")
                help_ = "ask for one after the other with `then`, or for either with `or`"
                yield RuleFinding(title, (label,), help_)


def _conflicting_atoms(goal: ScopedExpression, spec: SpecView) -> list[str]:
    """Return the names of the exclusive atoms that make a goal impossible.

    The list is empty if the goal is possible, or if it is impossible for another reason. Only the
    conjuncts of the goal without temporal operators are considered.
    """
    formulas = [part.formula() for part in conjuncts(goal)]
    formula = and_(*(state for state in formulas if state is not None and is_state(state)))
    goal_atoms = formula.atoms()
    for group in spec.spec.exclusive:
        names = [name for name in goal_atoms if name in {spec.spec.atoms[index].name for index in group}]
        part = Conjunct(formula, goal.source, goal.tree.span)
        if (
            len(names) > 1
            and _is_impossible(part, spec.spec)
            and not _is_impossible(part, _without_exclusive(spec.spec))
        ):
            return names
    return []


def _is_impossible(part: Conjunct, spec: Spec) -> bool:
    return unsatisfiable((part,), spec)


def _without_exclusive(spec: Spec) -> Spec:
    return replace(spec, exclusive=())


RULE = LintRule("TLT0414", "warning", check, supersedes=("TLT0410",))
