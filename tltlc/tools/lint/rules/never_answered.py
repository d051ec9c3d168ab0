"""TLT0432: `p implies q` where q never holds at the step of p, so p is forbidden.

The same is true of `p implies always for 1 s q` and `p implies not eventually within 1 s r`, which begin at the step
of p, and of `p implies time_since(p) >= 1 s`, because the time is 0 s at that step. The rule
`p implies time_holding(p) >= 1 s` fails when p begins, and so forbids p, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, NameExpr, NumberExpr, Unary
from tltlc.grammar.walk import conjuncts
from tltlc.logic.formula import Formula, always, and_, not_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.step_times import steps_before, time_text
from tltlc.tools.lint.stretches import ForbiddenStretch, every_step, forbidden_stretches, forbidding_clause
from tltlc.tools.lint.timer_relations import timer_relations

_REQUIRING: Final = ("implies", "and", "G", "X", "N")
"""Implications, and the operators whose operands are all required to hold."""
_TIMERS: Final = ("time_since", "time_holding")


@record
class _Required:
    """What an implication requires at the step of its condition.

    ``operand`` is required there, or its negation if ``negated``. ``lasting`` is the expression with `always` or
    `eventually` that requires it, or None if there is none.
    """

    implication: ScopedExpression
    operand: ScopedExpression
    lasting: ScopedExpression | None = None
    negated: bool = False

    @property
    def condition(self) -> ScopedExpression:
        assert isinstance(self.implication.tree, BinaryExpr)
        return self.implication.with_tree(self.implication.tree.left)

    def formula(self) -> Formula | None:
        """Return what is required, as a formula; None if it is unknown."""
        formula = self.operand.formula()
        return not_(formula) if formula is not None and self.negated else formula


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each required implication whose two sides never hold at the same step.

    Also yield one for each rule that asks how long an event has lasted, also at the step at which it begins.
    Such an implication only forbids its condition. There is no finding if one of the sides never
    holds at all, or if no trace satisfies the clause: then more is wrong.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            found = [required for part in _implications(value) for required in _impossible(part, spec)]
            if found and _can_hold(clause, value, spec):
                always = every_step(clause, value)
                for required in found:
                    yield _finding(required, spec.fspa.clock_s, at_every_step=required.implication.tree in always)
        for clause, value in spec.clauses("keep", "avoid", "require"):
            for stretch in forbidden_stretches(clause, value, spec):
                yield _stretch_finding(stretch, in_block=spec.declaration.block)


def _implications(value: ScopedExpression) -> Iterator[ScopedExpression]:
    """Yield the implications that an expression requires to hold.

    These are not inside another implication, nor below an operator that ``_REQUIRING`` does not name:
    there they need not hold for the expression to hold.
    """
    pending = [value]
    while pending:
        part = pending.pop()
        if isinstance(part.tree, (Unary, BinaryExpr)) and part.tree.op not in _REQUIRING:
            continue
        if isinstance(part.tree, BinaryExpr) and part.tree.op == "implies":
            yield part
        else:
            pending += reversed(part.children())


def _impossible(implication: ScopedExpression, spec: SpecView) -> list[_Required]:
    """Return what an implication requires although it never holds together with the condition; at most one."""
    assert isinstance(implication.tree, BinaryExpr)
    right = implication.tree.right
    if _is_past(right):
        return []  # TLT0440 reports it.
    candidates = [_required(implication, right), *(_required(implication, part) for part in conjuncts(right))]
    whole = [candidates[0]] if _never_together(candidates[0], spec) else []
    return whole or [part for part in candidates[1:] if part.lasting is not None and _never_together(part, spec)][:1]


def _is_past(result: Expr) -> bool:
    """Whether this is `once` or `historically`, perhaps negated."""
    tree = without_brackets(result)
    if isinstance(tree, Unary) and tree.op == "not":
        tree = without_brackets(tree.operand)
    return isinstance(tree, Unary) and tree.op in ("once", "historically")


def _never_together(required: _Required, spec: SpecView) -> bool:
    condition, result = required.condition.formula(), required.formula()
    if condition is None or result is None or not is_state(condition) or not is_state(result):
        return False
    names = and_(condition, result).atoms()
    proved = (*relations(spec, names), *timer_relations(spec, names))

    def can_be(state: Formula) -> bool:
        return not unsatisfiable(
            (Conjunct(state, required.operand.source, required.operand.tree.span), *proved), spec.spec
        )

    return not can_be(and_(condition, result)) and can_be(condition) and can_be(result)


def _required(implication: ScopedExpression, result: Expr) -> _Required:
    """Return what an implication requires by ``result``, a conjunct of its right side, at the step of its condition.

    `always` requires its operand at this step, too, unless its bound begins later, and so does `not eventually`
    with the negated operand.
    """
    tree = lasting = without_brackets(result)
    is_negated = isinstance(tree, Unary) and tree.op == "not"
    if isinstance(tree, Unary) and is_negated:
        lasting = without_brackets(tree.operand)
    if isinstance(lasting, Unary) and lasting.op == ("F" if is_negated else "G"):
        low = lasting.bound.low if lasting.bound is not None else None
        if low is None or low.value == 0:
            operand = implication.with_tree(lasting.operand)
            return _Required(implication, operand, implication.with_tree(tree), is_negated)
    return _Required(implication, implication.with_tree(result))


def _can_hold(clause: Clause, value: ScopedExpression, spec: SpecView) -> bool:
    formula = value.formula()
    if formula is None:
        # A bound on a clock that varies has no formula.
        return True
    whole = Conjunct(always(formula) if clause.kind == "keep" else formula, value.source, value.tree.span)
    return not spec.decision((whole, *relations(spec, formula.atoms())), spec.spec)


def _finding(required: _Required, step_s: float | None, *, at_every_step: bool) -> RuleFinding:
    implication, condition, result = required.implication, required.condition, required.operand
    label = Label(implication.source, implication.tree.span, f"so this only forbids `{condition.text}`")
    text = f"not {operand_text(result)}" if required.negated else result.text
    if required.lasting is not None:
        help_: str | None = _later(required)
    else:
        help_ = _timer_help(required, step_s, at_every_step=at_every_step)
    if help_ is not None and at_every_step:
        help_ += f"; to forbid `{condition.text}` altogether, write `{forbidding_clause(condition)}`"
    help_ = help_ or f"if it comes later, write `{operand_text(condition)} implies eventually {operand_text(result)}`"
    return RuleFinding(f"`{text}` never holds at the same step as `{condition.text}`", (label,), help_)


def _stretch_finding(stretch: ForbiddenStretch, *, in_block: bool) -> RuleFinding:
    event, forbidden = stretch.event.text, stretch.forbidden
    title = f"`time_holding({event})` is 0 s when `{event}` begins, so this forbids `{forbidden.text}`"
    place = Label(
        stretch.rule.source, stretch.rule.tree.span, f"each stretch of `{event}` breaks this at its first step"
    )
    forbidding = forbidding_clause(forbidden) if in_block else f"always not {operand_text(forbidden)}"
    help_ = f"to forbid `{forbidden.text}` altogether, write `{forbidding}`"
    if stretch.least:
        rule = stretch.lasting_rule()
        lasting = f"keep {rule}" if in_block else f"always ({rule})"
        help_ = f"if each stretch of `{event}` lasts at least {stretch.least}, write `{lasting}`; {help_}"
    return RuleFinding(title, (place,), help_)


def _later(required: _Required) -> str:
    """Return advice on how to write the rule that begins after the step of its condition."""
    condition, lasting = required.condition, required.lasting
    assert lasting is not None
    outer = lasting.tree
    assert isinstance(outer, Unary)
    inner = without_brackets(outer.operand)
    timed = outer if outer.op == "G" else inner
    assert isinstance(timed, Unary)
    if timed.bound is None or not isinstance(inner, Unary) or "not" not in (outer.op, inner.op):
        # `next` would ask for another step.
        return f"for the steps after it, write `{operand_text(condition)} implies weak_next {operand_text(lasting)}`"
    high, avoided = timed.bound.high, condition.with_tree(without_brackets(inner.operand))
    time = f"{' '.join(condition.source.slice(high.span).split())}{'' if high.unit else ' steps'}"
    if avoided.text == condition.text and not isinstance(avoided.tree, Unary):
        # An event may last for several steps.
        begins = f"(begins {operand_text(condition)})"
        return f"to forbid that it begins again within {time}, write `avoid {begins} then within {time} {begins}`"
    return f"for the steps after it, write `avoid {_goal_text(condition)} then within {time} {_goal_text(avoided)}`"


def _goal_text(part: ScopedExpression) -> str:
    is_name = isinstance(without_brackets(part.tree), (NameExpr, CallExpr))
    return part.text if is_name else f"({part.text})"


def _timer_help(required: _Required, step_s: float | None, *, at_every_step: bool) -> str | None:
    """Return the help for a comparison of a timer with a time, else None."""
    result = required.operand
    tree = without_brackets(result.tree)
    if not isinstance(tree, BinaryExpr) or not isinstance(tree.left, CallExpr) or tree.left.name not in _TIMERS:
        return None
    event, may_repeat = result.with_tree(without_brackets(tree.left.arguments[0].value)), True
    help_ = f"`{result.with_tree(tree.left).text}` is 0 s at that step"
    condition = without_brackets(required.condition.tree)
    if isinstance(condition, Unary) and condition.op == "ends":
        help_ += f": write `previously ({result.text})`"
        ended = required.condition.with_tree(without_brackets(condition.operand)).text
        if at_every_step and tree.op == ">=" and isinstance(tree.right, NumberExpr) and event.text == ended:
            text = operand_text(event)
            help_ += f", or `keep begins {text} implies always for {result.with_tree(tree.right).text} {text}`"
            help_ += ", which needs one step less" if step_s else ""
        return help_
    if tree.left.name == "time_holding":
        may_repeat = isinstance(event.tree, Unary) and event.tree.op == "not"
        event = event.with_tree(event.tree.operand) if isinstance(event.tree, Unary) else event
    if may_repeat and isinstance(tree.right, NumberExpr) and tree.op in (">", ">="):
        time = _forbidden_time(result.with_tree(tree.right), tree.right, step_s, inclusive=tree.op == ">")
        if time is not None:
            begins = f"(begins {operand_text(event)})"
            return f"{help_}; to forbid a second beginning so soon, write `avoid {begins} then within {time} {begins}`"
    return f"{help_}: compare it at another step"


def _forbidden_time(time: ScopedExpression, tree: NumberExpr, step_s: float | None, *, inclusive: bool) -> str | None:
    """Return the longest time after which an event must not begin again if it may after the time ``tree``.

    It may at this time itself, unless ``inclusive``. Return None if no event begins again so soon, because another
    step must lie between.
    """
    shorter, steps = steps_before(tree, step_s), steps_before(tree, step_s, inclusive=inclusive)
    if shorter is None or steps is None:
        return time.text
    if steps <= 1:
        return None
    return time.text if steps > shorter else time_text(steps, tree.unit, step_s)


RULE = LintRule("TLT0432", "warning", check)
