"""TLT0483: `once a implies (b until c)`, which is asked for again at every step after the first a."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule with the condition `once p` whose result is `q until r` or `q weak_until r`."""
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                past, until = asked.condition.tree, asked.part.tree
                is_past = isinstance(past, Unary) and past.op == "once" and past.bound is None
                if is_past and isinstance(until, BinaryExpr) and until.op in ("U", "W") and not asked.steps:
                    yield _finding(asked, "keep " if asked.is_all_of(clause, value) else "")


def _finding(asked: AskedResult, keyword: str) -> RuleFinding:
    """Return the finding for a rule; ``keyword`` is that of its clause, if the rule is all of it."""
    past, until = asked.condition, asked.part
    assert isinstance(past.tree, Unary) and isinstance(until.tree, BinaryExpr)
    event = past.with_tree(without_brackets(past.tree.operand))
    state, end = (until.with_tree(without_brackets(side)) for side in (until.tree.left, until.tree.right))
    word = until.source.slice(until.tree.op_span)
    label = Label(
        past.source, past.tree.span.to(until.tree.span), f"asked at each step from the first `{event.text}` on"
    )
    help_ = (
        f"if `{end.text}` ends it until the next `{event.text}`, write "
        f"`{keyword}{event.text} implies ({operand_text(state)} {word} {operand_text(end)})`; if it must hold again "
        f"after each `{end.text}`, allow this with the comment `// tltlc: allow TLT0483`"
    )
    return RuleFinding(f"this asks for `{state.text}` again after `{end.text}`", (label,), help_)


RULE = LintRule("TLT0483", "note", check)
