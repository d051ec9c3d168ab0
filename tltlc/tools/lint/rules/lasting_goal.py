"""TLT0434: `reach (always for 3 s a)`, which one step meets: past the end of the play it asks nothing."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Binary, Unary
from tltlc.grammar.walk import operands
from tltlc.logic.formula import FALSE, and_, weak_next
from tltlc.resolve.spec import Part
from tltlc.tools.lint.file_view import Expression, SpecView, View, inner, operand
from tltlc.tools.lint.goals import conjuncts
from tltlc.tools.lint.rule import Remark, Rule

_WAY_OUT = "let a signal count the time, and ask for enough of it, as in `reach time_there >= 3 s`"


def check(view: View) -> Iterator[Remark]:
    """A remark for each bounded `always` in a last goal, of specs that end with success as soon as they are met."""
    for spec in view.specs:
        if spec.fspa.semantics != "finite" or spec.fspa.judge != "goal":
            continue
        for clause, value in spec.clauses("reach", "require"):
            wanted = [value] if clause.kind == "reach" else [goal for part in conjuncts(value) for goal in _asked(part)]
            for asked in map(_last, wanted):
                found = [remark for goal in asked for remark in _remarks(goal)]
                if found and _is_met_by_one_step(asked, spec):
                    yield from found


def _asked(part: Expression) -> Iterator[Expression]:
    """What a conjunct asks for at some step, as a goal; nothing of one that is no goal."""
    if isinstance(part.tree, Unary) and part.tree.op == "F":
        yield part.at(part.tree.operand)
    elif isinstance(part.tree, Binary) and part.tree.op == "then":
        yield part


def _last(goal: Expression) -> list[Expression]:
    """What a goal asks for last: of a chain its last step, of `eventually a` what that asks for."""
    found: list[Expression] = []
    waiting = [goal]
    while waiting:
        goal = waiting.pop()
        for part in conjuncts(goal.at(operands(goal.tree, "then")[-1])):
            inside = list(_asked(part))
            waiting += inside
            found += [] if inside else [part]
    return found


def _is_met_by_one_step(asked: list[Expression], spec: SpecView) -> bool:
    """Whether a play of one step can meet all of it; what is to come at the next step or later takes more."""
    formulas = (formula for formula in map(Expression.formula, asked) if formula is not None)
    ended = and_(weak_next(FALSE), *formulas)
    return not unsatisfiable((Part(ended, spec.spec.source, spec.spec.name_span),), spec.spec)


def _remarks(goal: Expression) -> Iterator[Remark]:
    waiting = [(goal, True)]
    while waiting:
        part, holds = waiting.pop()
        tree = inner(part.tree)
        if isinstance(tree, Unary) and tree.op == "not":
            waiting.append((part.at(tree.operand), not holds))
        elif isinstance(tree, Binary) and tree.op in ("and", "or"):
            waiting += (part.at(tree.right), holds), (part.at(tree.left), holds)
        elif isinstance(tree, Unary) and tree.bound is not None and tree.op == ("G" if holds else "F"):
            lasting = part.at(tree.operand)
            what = lasting.text if holds else f"not {operand(lasting)}"
            message = f"past the end it asks nothing, so one step with `{what}` is enough"
            yield Remark("this goal is met by one step", (Label(part.source, tree.span, message),), _WAY_OUT)


RULE = Rule("TLT0434", "warning", check)
