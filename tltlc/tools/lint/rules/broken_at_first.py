"""TLT0458: `keep x > previous(x)`, which no first step keeps, and `reach times(a) <= 3`, which each one meets."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import SignalValue, nodes
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, NumberExpr, Unary
from tltlc.grammar.walk import operands, parts
from tltlc.logic.formula import Formula, and_, not_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.first_step_values import known_at_first_step
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.stretches import every_step

_BEFORE: Final = {"previous", "previously", "initial"}
"""What compares a step with one before; at the first step, there is none."""
_LATER: Final = ("F", "G", "X", "N", "U", "W", "R", "M", "then", "within")
"""The operators about later steps."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule for every step that the first step breaks, and for each goal that it meets.

    There is none where the rule or the goal has the same truth value at every step.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("reach", "keep", "avoid", "require"):
            if clause.kind == "reach":
                yield from _goal(value, spec)
            else:
                trees = [without_brackets(value.tree)] if clause.kind == "avoid" else every_step(clause, value)
                for tree in trees:
                    yield from _rule(clause, value.with_tree(tree), spec, is_whole=len(trees) == 1)


def _rule(clause: Clause, rule: ScopedExpression, spec: SpecView, *, is_whole: bool) -> Iterator[RuleFinding]:
    formula = _state(rule)
    if formula is None:
        return
    kept = not_(formula) if clause.kind == "avoid" else formula
    if _decides(kept, rule, spec):
        label = Label(rule.source, rule.tree.span, "no recording keeps this: at its first step, it is false")
        if clause.kind == "avoid":
            label = Label(rule.source, rule.tree.span, "each recording breaks this: at its first step, it is true")
        help_ = "ask for it from a later step on"
        if is_whole:
            help_ = _advice(clause, rule, kept, spec)
        yield RuleFinding("the first step always breaks this rule", (label,), help_)


def _advice(clause: Clause, rule: ScopedExpression, kept: Formula, spec: SpecView) -> str:
    if _kinds(kept, spec) <= _BEFORE:
        always = f"weak_next always ({_kept_text(clause, rule)})"
        return f"for the steps after the first, write `{f'require {always}' if spec.declaration.block else always}`"
    if clause.kind == "avoid":
        return "if it must end at some time, write `reach`, and what holds then"
    if not spec.declaration.block:
        return f"if it must come, write `eventually ({rule.text})`"
    free = _of_window(rule)
    if free:
        return f"if it is about any such time of play, write `{free}`; for once, write `reach {rule.text}`"
    lasting = _lasting(rule)
    if lasting:
        return f"if it must last that long each time, write `{lasting}`; for once, write `reach {rule.text}`"
    if isinstance(rule.tree, BinaryExpr) and rule.tree.op == "==":
        left, right = (rule.with_tree(side).text for side in (rule.tree.left, rule.tree.right))
        return f"if it must come to that, and no further, write `reach {left} >= {right}` and `keep {left} <= {right}`"
    return f"if it must come, write `reach {rule.text}`"


def _kept_text(clause: Clause, rule: ScopedExpression) -> str:
    """Return the formula that a rule asks for: the rule itself, or its negation in an `avoid` clause."""
    if clause.kind != "avoid":
        return rule.text
    if isinstance(rule.tree, Unary) and rule.tree.op == "not":
        return rule.with_tree(rule.tree.operand).text
    return f"not ({rule.text})" if isinstance(rule.tree, BinaryExpr) else f"not {rule.text}"


def _of_window(rule: ScopedExpression) -> str:
    """Return `keep total_time_within(not p, 10 s) <= 8 s` for the rule `total_time_within(p, 10 s) >= 2 s`; else ""."""
    tree = rule.tree
    if not isinstance(tree, BinaryExpr) or tree.op not in (">", ">="):
        return ""
    call, least = without_brackets(tree.left), without_brackets(tree.right)
    if not isinstance(call, CallExpr) or call.name != "total_time_within" or not isinstance(least, NumberExpr):
        return ""
    window = without_brackets(call.arguments[1].value)
    if not isinstance(window, NumberExpr) or window.unit != least.unit or window.value <= least.value:
        return ""
    event, length = (rule.with_tree(part) for part in (call.arguments[0].value, window))
    sign, most = "<" if tree.op == ">" else "<=", window.value - least.value
    return f"keep total_time_within(not {operand_text(event)}, {length.text}) {sign} {most:g} {least.unit}"


def _lasting(rule: ScopedExpression) -> str:
    """Return the clause that each stretch of p lasts for 3 s, for the rule `time_holding(p) >= 3 s`; else ""."""
    tree = rule.tree
    if not isinstance(tree, BinaryExpr) or tree.op not in (">", ">="):
        return ""
    timer, time = without_brackets(tree.left), rule.with_tree(tree.right).text
    if not isinstance(timer, CallExpr) or timer.name != "time_holding" or not time[:1].isdigit():
        return ""
    event = operand_text(rule.with_tree(timer.arguments[0].value))
    return f"keep begins {event} implies always for {time} {event}"


def _goal(value: ScopedExpression, spec: SpecView) -> Iterator[RuleFinding]:
    """Yield a finding if the first step meets the first goal of a `reach` clause."""
    first, *later = operands(without_brackets(value.tree), "then")
    goal = value.with_tree(without_brackets(first))
    formula = _state(goal)
    if formula is not None and _decides(not_(formula), goal, spec):
        label = Label(goal.source, goal.tree.span, "this holds at every first step, so it asks for nothing")
        help_ = f"if it must hold to the end, write `keep {goal.text}`"
        if later:
            help_ = "leave it out, or ask for what must come"
        elif _kinds(formula, spec) <= _BEFORE:
            help_ = f"for a later step, write `require next eventually ({goal.text})`"
        yield RuleFinding("the first step always meets this goal", (label,), help_)


def _state(part: ScopedExpression) -> Formula | None:
    if any(isinstance(tree, (Unary, BinaryExpr)) and tree.op in _LATER for tree in parts(part.tree)):
        return None  # without the work of resolving it
    formula = part.formula()
    return formula if formula is not None and is_state(formula) else None


def _decides(state: Formula, part: ScopedExpression, spec: SpecView) -> bool:
    """Whether a state never holds at the first step, but may hold at other steps, and may not."""
    if not {atom.name for atom in spec.spec.atoms}.issuperset(state.atoms()):
        return False
    known = known_at_first_step(spec, state.atoms())
    return (
        bool(known.atoms())
        and not _can_be(and_(state, known), part, spec)
        and _can_be(state, part, spec)
        and _can_be(not_(state), part, spec)
    )


def _can_be(state: Formula, part: ScopedExpression, spec: SpecView) -> bool:
    conjunct = Conjunct(state, part.source, part.tree.span)
    return not unsatisfiable((conjunct, *relations(spec, state.atoms())), spec.spec)


def _kinds(state: Formula, spec: SpecView) -> set[str]:
    """Return the kinds of what a state reads of the trace so far."""
    kinds = {register.name: register.kind for register in spec.fspa.registers}
    names = set(state.atoms())
    return {
        kinds[node.name]
        for candidate in spec.fspa.atoms
        if candidate.name in names
        for node in nodes(candidate.expression)
        if isinstance(node, SignalValue) and node.name in kinds
    }


RULE = LintRule("TLT0458", "warning", check)
