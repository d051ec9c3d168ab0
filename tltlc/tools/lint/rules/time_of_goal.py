"""TLT0481: `reach a then b then within 20 s c`, where the time counts from b, and not from a."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, Expr, IsExpr, TemporalInterval, Unary
from tltlc.logic.formula import Formula, and_, eventually, not_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `reach` of three or more goals, of which one after the second has a time of its own.

    There is none if other goals have times, too, or if the goal before the time is an edge, unlike the first one: then
    the author has said where the time begins. Nor is there one if the first goal must hold again at a later one.
    """
    for spec in view.specs:
        for _, value in spec.clauses("reach"):
            goals, bounds = _goals(value)
            if bounds and bounds[0] is not None and isinstance(without_brackets(goals[0].tree), IsExpr):
                yield _from_any_step(goals, bounds)
            timed = [place for place, bound in enumerate(bounds, start=1) if bound is not None]
            if len(timed) == 1 and timed[0] >= 2:
                (place,) = timed
                is_said = _is_edge(goals[place - 1].tree) and not _is_edge(goals[0].tree)
                if not is_said and _begins_once(goals[: place + 1], spec):
                    yield _finding(goals, place, bounds[place - 1])


def _from_any_step(goals: list[ScopedExpression], bounds: list[TemporalInterval | None]) -> RuleFinding:
    """Return the finding for `reach (mode is one) then within 3 min b`, which may count from a late step of one."""
    first, source, bound = goals[0], goals[0].source, bounds[0]
    assert bound is not None
    last = goals[-1].tree.span
    rest = " ".join(source.text[first.tree.span.end : last.end].lstrip(") ").split())
    label = Label(source, bound.span, f"from any step with `{first.text}`, such as its last")
    help_ = (
        f"if it counts from where `{first.text}` begins, write `reach begins ({first.text}) {rest}`; if it counts from "
        "its last step, allow this with the comment `// tltlc: allow TLT0481`"
    )
    return RuleFinding(f"this time counts from any step with `{first.text}`", (label,), help_)


def _goals(value: ScopedExpression) -> tuple[list[ScopedExpression], list[TemporalInterval | None]]:
    """Return the goals of a sequence, and the bound before each one but the first."""
    bounds, tree = [], value.tree
    while isinstance(tree, BinaryExpr) and tree.op == "then":
        bounds.append(tree.bound)
        tree = tree.right
    return [value.with_tree(goal) for goal in walk.operands(value.tree, "then")], bounds


def _is_edge(goal: Expr) -> bool:
    """Whether a goal holds for one step at a time: `begins a`, `ends a`, or one of these and another condition."""
    return any(
        isinstance(part, Unary) and part.op in ("begins", "ends")
        for part in map(without_brackets, walk.conjuncts(goal))
    )


def _begins_once(goals: list[ScopedExpression], spec: SpecView) -> bool:
    """Whether the first goal and the last one are about one step, and no later one includes the first."""
    first, last = goals[0].formula(), goals[-1].formula()
    if first is None or last is None or not is_state(first) or not is_state(last):
        return False
    states = (goal.formula() for goal in goals[1:])
    return not any(state is not None and is_state(state) and _includes(state, first, spec) for state in states)


def _includes(state: Formula, other: Formula, spec: SpecView) -> bool:
    """Whether each step with a condition has the other one, too, as far as is known."""
    apart = and_(state, not_(other))
    if not {atom.name for atom in spec.spec.atoms}.issuperset(apart.atoms()):
        return False
    part = Conjunct(eventually(apart), spec.spec.source, spec.spec.name_span)
    return spec.decision((part, *relations(spec, apart.atoms())), spec.spec)


def _finding(goals: list[ScopedExpression], place: int, bound: TemporalInterval | None) -> RuleFinding:
    """Return the finding for the goal at a place, with its bound."""
    assert bound is not None
    first, before, goal = goals[0], goals[place - 1], goals[place]
    source, time = first.source, " ".join(first.source.slice(bound.span).split())
    beginning = operand_text(first) if _is_edge(first.tree) else f"begins {operand_text(first)}"
    inner = without_brackets(goal.tree)
    is_chain = isinstance(inner, BinaryExpr) and inner.op == "and"
    timed = f"({goal.text if is_chain else operand_text(goal)} and once {time} {beginning})"
    texts = [" ".join(source.slice(part.tree.span).split()) for part in goals]
    meant = " then ".join([*texts[:place], timed, *texts[place + 1 :]])
    label = Label(source, bound.span, "from the goal just before it")
    help_ = (
        f"if it counts from where `{first.text}` begins, the last time if it begins again, write `reach {meant}`; "
        f"if it counts from `{before.text}`, allow this with the comment `// tltlc: allow TLT0481`"
    )
    return RuleFinding(f"this time counts from `{before.text}`, not from `{first.text}`", (label,), help_)


RULE = LintRule("TLT0481", "note", check)
