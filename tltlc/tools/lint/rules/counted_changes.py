"""TLT0465: `times(begins a or ends a)`, where changes at steps in a row count once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Unary
from tltlc.grammar.walk import operands
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_COUNTS: Final = ("times", "times_since", "times_within")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each count of one event or another, both of which are `begins p` or `ends p`.

    Each of them is over at the next step, but the other one may be there: then the count does not rise.
    """
    for spec in view.specs:
        for _, value in spec.clauses("reach", "keep", "avoid", "require"):
            for part in value.parts():
                call = part.tree
                if isinstance(call, CallExpr) and call.name in _COUNTS and call.name not in view.env.scope.names:
                    counted = part.with_tree(without_brackets(call.arguments[0].value))
                    if isinstance(counted.tree, BinaryExpr) and counted.tree.op == "or":
                        kinds = [counted.with_tree(without_brackets(side)) for side in operands(counted.tree, "or")]
                        if all(isinstance(kind.tree, Unary) and kind.tree.op in ("begins", "ends") for kind in kinds):
                            yield _finding(part, kinds)


def _finding(count: ScopedExpression, kinds: list[ScopedExpression]) -> RuleFinding:
    assert isinstance(count.tree, CallExpr)
    others = [count.with_tree(argument.value).text for argument in count.tree.arguments[1:]]
    calls = [f"{count.tree.name}({', '.join((kind.text, *others))})" for kind in kinds]
    label = Label(count.source, count.tree.span, "if they take turns at each step, this counts only the first")
    help_ = (
        f"to count each of them, write `{' + '.join(calls)}`, with a maximum in each; if there is always a step "
        "between them, allow this with the comment `// tltlc: allow TLT0465`"
    )
    return RuleFinding("events at steps in a row count once", (label,), help_)


RULE = LintRule("TLT0465", "note", check)
