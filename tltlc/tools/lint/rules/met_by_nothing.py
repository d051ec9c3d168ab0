"""TLT0412: a goal that can be met without doing anything, while its atoms are false."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.logic.formula import TRUE, Formula, and_, atom, eventually, not_, or_, rebuild
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.goals import conjuncts, goals
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each goal that can be met while none of the atoms that it asks for holds.

    An example is `reach a implies b`, which a step without a and b meets. Only traces that satisfy
    all clauses of the spec count. The answer in a rule such as `keep a implies eventually b` is no goal.
    """
    for spec in view.specs:
        if not spec.is_settled:
            for goal in goals(spec, answers=False):
                yield from _findings(goal, spec)
            yield from _absent_last(spec)


def _absent_last(spec: SpecView) -> Iterator[RuleFinding]:
    """Yield a finding for `reach a then not b`: the last goal only asks that something new does not hold.

    One step without it is enough. `reach a then not a` asks for the end of a, and is left out, as is a
    comparison such as `kills >= 1`, which is the negation of another atom.
    """
    for _, value in spec.clauses("reach"):
        *before, last = [value.with_tree(step) for step in walk.operands(value.tree, "then")]
        tree = without_brackets(last.tree)
        formula = last.formula() if before and isinstance(tree, Unary) and tree.op == "not" else None
        earlier = [goal.formula() for goal in before]
        if formula is None or formula.op != "not" or formula.args[0].op != "atom" or None in earlier:
            continue
        if set(formula.atoms()) & {name for goal in earlier if goal is not None for name in goal.atoms()}:
            continue
        absent = last.text.removeprefix("not ").removeprefix("!").strip()
        label = Label(last.source, without_brackets(last.tree).span, f"one step without `{absent}` is enough")
        help_ = f"write a clause `avoid {absent}` if it must never hold, or leave the goal out"
        yield RuleFinding(_TITLE, (label,), help_)


def _findings(goal: ScopedExpression, spec: SpecView) -> Iterator[RuleFinding]:
    formula = goal.formula()
    if formula is None:
        return
    still = _without_temporal_operators(formula)
    holding, failing = _helpful_atoms(still)
    # If no atom helps by being false, the goal cannot be met by doing nothing.
    # If no atom helps only by being true, the goal asks for none.
    if not failing or not set(holding) - set(failing):
        return

    proved = relations(spec, spec.spec.formula.atoms())

    def can_be(state: Formula) -> bool:
        part = Conjunct(eventually(state), goal.source, goal.tree.span)
        return not spec.decision((*spec.spec.parts, *proved, part), spec.spec)

    # An atom that the other clauses already ensure needs no action.
    missing = [name for name in holding if can_be(not_(atom(name)))]
    awaited = [name for name in missing if name not in failing]
    met = and_(formula, still, *(not_(atom(name)) for name in missing))
    if awaited and can_be(met):
        implications = _implications(goal)
        conditions = (part.formula() or TRUE for part, _ in implications)
        # If some condition always holds, the implications are not the reason.
        if implications and can_be(and_(met, *map(not_, conditions))):
            yield _finding_on_implications(implications)
        else:
            listed = " and ".join(f"`{name}`" for name in awaited)
            label = Label(goal.source, without_brackets(goal.tree).span, f"can be met without {listed}")
            yield RuleFinding(_TITLE, (label,), f"use `and` to ask for what must be done, or ask for {listed} alone")


def _without_temporal_operators(formula: Formula) -> Formula:
    """Remove the temporal operators from a formula: the result means the same as long as no atom changes.

    For example, ``a & X b`` becomes ``a & b``.
    """
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


def _helpful_atoms(state: Formula) -> tuple[list[str], list[str]]:
    """Return the atoms that can help to make a formula true by being true, and those that can by being false.

    For ``a & !b``, these are ``["a"]`` and ``["b"]``. An atom may be in both lists.
    """
    signs: dict[tuple[Formula, bool], None] = {}
    pending = [(state, True)]
    while pending:
        part, holds = pending.pop()
        if (part, holds) in signs:
            continue
        signs[part, holds] = None
        if part.op == "not":
            pending.append((part.args[0], not holds))
        elif part.op == "implies":
            pending += (part.args[1], holds), (part.args[0], not holds)
        elif part.op == "iff":
            pending += [(argument, sign) for argument in part.args for sign in (True, False)]
        else:
            pending += [(argument, holds) for argument in reversed(part.args)]
    atoms = [(part.name, holds) for part, holds in signs if part.op == "atom"]
    return [name for name, holds in atoms if holds], [name for name, holds in atoms if not holds]


def _implications(goal: ScopedExpression) -> list[tuple[ScopedExpression, ScopedExpression]]:
    """Return the condition and the result of each implication among the conjuncts of a goal.

    An implication in the body of `all` is listed once, not once for each entity.
    """
    by_span: dict[Span, tuple[ScopedExpression, ScopedExpression]] = {}
    for part in conjuncts(goal):
        if isinstance(part.tree, BinaryExpr) and part.tree.op == "implies":
            by_span[part.tree.span] = part.with_tree(part.tree.left), part.with_tree(part.tree.right)
    return list(by_span.values())


def _finding_on_implications(implications: list[tuple[ScopedExpression, ScopedExpression]]) -> RuleFinding:
    labels, alternatives = [], []
    for condition, result in implications:
        span = condition.tree.span.to(result.tree.span)
        labels.append(Label(condition.source, span, f"true while {condition.text} is false"))
        alternatives.append(f"{operand_text(condition)} and {operand_text(result)}")
    wanted = alternatives[0] if len(alternatives) == 1 else f"({') or ('.join(alternatives)})"
    return RuleFinding(_TITLE, tuple(labels), f"write `{wanted}`")


_TITLE: Final = "this goal can be met without doing anything"

RULE = LintRule("TLT0412", "warning", check)
