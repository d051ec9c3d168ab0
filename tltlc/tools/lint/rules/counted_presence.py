"""TLT0469: `times_since(a, b) >= 1`, which counts beginnings where any step with a may be meant."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, NumberExpr, Unary
from tltlc.grammar.walk import parts
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.stretches import every_step

_ANY: Final = ((">=", 1), (">", 0), ("!=", 0))
_NONE: Final = (("==", 0), ("<", 1), ("<=", 0))
_EDGES: Final = ("begins", "ends", "previously")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each count since an event, or in a time, that is compared with the first number.

    What begins before the event and holds on has not begun since. There is none for `begins a`, for what changes
    against the step before, and for a rule that is such a comparison alone: TLT0466 has it.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("reach", "keep", "avoid", "require"):
            rules = {id(rule) for rule in _rules(clause, value)}
            for part in value.parts():
                tree = part.tree
                if isinstance(tree, BinaryExpr) and id(tree) not in rules and isinstance(tree.left, CallExpr):
                    finding = _finding(part, tree, tree.left)
                    if finding is not None and tree.left.name not in view.env.scope.names:
                        yield finding


def _rules(clause: Clause, value: ScopedExpression) -> list[Expr]:
    """Return what a clause asks for, or forbids, at every step."""
    return [without_brackets(value.tree)] if clause.kind == "avoid" else every_step(clause, value)


def _finding(comparison: ScopedExpression, tree: BinaryExpr, call: CallExpr) -> RuleFinding | None:
    number = without_brackets(tree.right)
    if (
        call.name not in ("times_since", "times_within")
        or not isinstance(number, NumberExpr)
        or len(call.arguments) < 2
    ):
        return None
    compared = (tree.op, int(number.value))
    event, start = (comparison.with_tree(argument.value) for argument in call.arguments[:2])
    if compared not in (*_ANY, *_NONE) or number.value != compared[1] or _is_edge(event.tree):
        return None
    presence = f"once within {start.text} {operand_text(event)}"
    if call.name == "times_since":
        presence = f"(not {operand_text(start)} since {operand_text(event)})"
    if compared in _NONE:
        presence = f"not {presence}" if presence.startswith("(") else f"not ({presence})"
    label = Label(comparison.source, tree.span, "what began earlier and goes on has not begun since")
    help_ = (
        f"if any step with `{event.text}` counts, write `{presence}`; if only its beginnings count, allow this with "
        "the comment `// tltlc: allow TLT0469`"
    )
    return RuleFinding(f"this counts where `{event.text}` begins", (label,), help_)


def _is_edge(tree: Expr) -> bool:
    """Whether a condition is about a change, and so begins at each of its steps or is about one step alone."""
    return any(
        (isinstance(part, Unary) and part.op in _EDGES) or (isinstance(part, CallExpr) and part.name == "previous")
        for part in parts(tree)
    )


RULE = LintRule("TLT0469", "note", check)
