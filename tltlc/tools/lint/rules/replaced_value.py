"""TLT0464: `eventually x <= value_at(x, begins a)`, where a later `begins a` replaces the value."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.past_words import OF_EVENTS
from tltlc.grammar.tree import BinaryExpr, CallExpr, Unary
from tltlc.tools.lint.asked_results import asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_LATER: Final = ("F", "X", "N", "G", "U", "W", "R", "M", "then")
"""The operators whose operands may be about later steps."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each value since an event that an answer asks for at a later step."""
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                for call, event in _later_values(asked.part):
                    if call.tree.name not in view.env.scope.names:  # type: ignore[union-attr]
                        yield _finding(call, event)


def _later_values(answer: ScopedExpression) -> Iterator[tuple[ScopedExpression, ScopedExpression]]:
    """Yield each function of an event that an operator about later steps contains, and its event."""
    pending = [(answer, False)]
    while pending:
        part, is_later = pending.pop()
        tree = part.tree
        is_later = is_later or (isinstance(tree, (Unary, BinaryExpr)) and tree.op in _LATER)
        if is_later and isinstance(tree, CallExpr) and tree.name in OF_EVENTS and len(tree.arguments) > 1:
            yield part, part.with_tree(without_brackets(tree.arguments[1].value))
        else:
            pending += [(child, is_later) for child in reversed(part.children())]


def _finding(call: ScopedExpression, event: ScopedExpression) -> RuleFinding:
    label = Label(call.source, call.tree.span, f"at that step, this is about the last `{event.text}` up to it")
    help_ = (
        f"if `{event.text}` may come again before the answer, let the game keep the value, and compare with that; "
        "if it cannot, or if its last one is meant, allow this with the comment `// tltlc: allow TLT0464`"
    )
    return RuleFinding(f"a later `{event.text}` replaces what this remembers", (label,), help_)


RULE = LintRule("TLT0464", "note", check)
