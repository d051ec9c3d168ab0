"""TLT0433: `avoid a until b` and `reach a until b`, where a has no effect."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Expr
from tltlc.grammar.walk import operands
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

if TYPE_CHECKING:
    from typing import TypeGuard


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `until` in a `reach` or `avoid` clause.

    `a until b` holds at every step where b holds, so the clause means the same with b alone. In a
    chain such as `reach (a until b) then (c until d)`, only the last `until` gets a finding: an
    earlier `until` also determines from which step on the next goal counts.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("reach", "avoid"):
            *earlier, last = operands(value.tree, "then")
            if not earlier:
                yield from _among_alternatives(clause.kind, value)
                if clause.kind == "avoid":
                    yield from _among_conditions(value)
                continue
            part = value.with_tree(without_brackets(last))
            if is_until(part.tree):
                previous = operand_text(value.with_tree(earlier[-1]))
                label = Label(
                    value.source, part.tree.span, f"this means only `{value.with_tree(part.tree.right).text}`"
                )
                help_ = f"write `{previous} and ({part.text})`, which counts from that step on"
                yield RuleFinding(_TITLE, (label,), help_)


def _among_alternatives(kind: str, value: ScopedExpression) -> Iterator[RuleFinding]:
    """Yield a finding for the first `until` among the operands of `or`: ``avoid a or b until c`` means ``a or c``."""
    alternatives = [value.with_tree(without_brackets(part)) for part in operands(without_brackets(value.tree), "or")]
    place = next((place for place, part in enumerate(alternatives) if is_until(part.tree)), None)
    if place is None:
        return
    until = alternatives[place].tree
    assert isinstance(until, BinaryExpr)
    before, goal = value.with_tree(until.left), value.with_tree(until.right)
    others = alternatives[:place], alternatives[place + 1 :]
    rest = " or ".join(part.text for part in (*others[0], goal, *others[1]))
    label = Label(value.source, until.span, f"this means only `{kind} {rest}`")
    first, second = _joined([*others[0], before]), _joined([goal, *others[1]])
    help_ = f"write `require {first} until {second}`"
    if kind == "avoid":
        # `avoid` does not require its second formula to occur, hence `weak_until`.
        help_ = f"write `require (not {first}) weak_until {second}`"
    yield RuleFinding(_TITLE, (label,), help_)


def _among_conditions(value: ScopedExpression) -> Iterator[RuleFinding]:
    """Yield a finding for `avoid a until b and c`, which forbids each step with b and c."""
    first, *others = [value.with_tree(part) for part in operands(without_brackets(value.tree), "and")]
    if not others or not is_until(first.tree):
        return
    before, goal = first.with_tree(first.tree.left), first.with_tree(first.tree.right)
    end = " and ".join(part.text for part in (goal, *others))
    label = Label(value.source, value.tree.span, f"each step with `{end}` is forbidden")
    help_ = f"write `require (not {operand_text(before)}) weak_until ({end})`"
    yield RuleFinding("this forbids the end of its `until`", (label,), help_)


def _joined(parts: Sequence[ScopedExpression]) -> str:
    """Return the text of a disjunction, in brackets if it has several parts."""
    if len(parts) == 1:
        return operand_text(parts[0])
    return f"({' or '.join(part.text for part in parts)})"


def is_until(tree: Expr) -> TypeGuard[BinaryExpr]:
    """Whether an expression is `a until b`."""
    return isinstance(tree, BinaryExpr) and tree.op == "U"


_TITLE: Final = "the first half of this `until` has no effect"

RULE = LintRule("TLT0433", "warning", check)
