"""TLT0428: a limit that ends the episode before the goal can be reached."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each spec whose goal needs more steps than its limit allows."""
    for spec in view.specs:
        limit, least = spec.spec.limit_steps, spec.fspa.states[0].distance
        if limit is not None and least is not None and least > limit:
            clause = next(clause for clause in spec.declaration.clauses if clause.kind == "limit")
            label = view.label(clause.span, f"the goal takes at least {least} steps, and this is {limit}")
            title = f"`{spec.spec.name}` cannot be met within its limit"
            yield RuleFinding(title, (label,), f"allow more: at least `limit {least} steps`")


RULE = LintRule("TLT0428", "warning", check)
