"""TLT0444: a time that no episode lasts for, because the limit ends it before."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, NumberExpr, Unary
from tltlc.resolve.constants import samples
from tltlc.tools.lint.file_view import FileView, ScopedExpression
from tltlc.tools.lint.rule import LintRule, RuleFinding

_SOME: Final = ("F", "once", "then", "within")
_ALL: Final = ("G", "historically")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each bound that ends after the last step of the longest episode.

    On such episodes, the clause means the same without the bound. Only specs over finite traces with a fixed
    clock are checked: where the clock varies, a limit says nothing about time.
    """
    if view.env.context.clock_varies:
        return
    for spec in view.specs:
        limit = spec.spec.limit_steps
        if limit is None or spec.spec.semantics != "finite":
            continue
        (clause,) = (clause for clause in spec.declaration.clauses if clause.kind == "limit")
        assert isinstance(clause.value, NumberExpr)
        end = Label(spec.spec.source, clause.span, "the last step comes before")
        for formula in spec.formulas():
            for part in formula.parts():
                label = _beyond(part, limit)
                if label is not None:
                    help_ = (
                        "leave the time out, make it shorter, or allow more with `limit`; if whole recordings are "
                        "judged by it, which may be longer, allow this with the comment `// tltlc: allow TLT0444`"
                    )
                    yield RuleFinding("the limit ends play before this time is over", (label, end), help_)


def _beyond(part: ScopedExpression, limit: int) -> Label | None:
    """Return a label on the bound of an operator if no episode of ``limit`` steps has a step after the bound."""
    tree = part.tree
    if not isinstance(tree, (Unary, BinaryExpr)) or tree.bound is None or tree.op not in (*_SOME, *_ALL):
        return None
    if tree.bound.low is not None and samples(tree.bound.low, part.env) >= limit:
        return None  # The bound begins after the limit, too.
    last = samples(tree.bound.high, part.env)
    if tree.op in _ALL and tree.bound.words:
        last -= 1
    if last < limit - 1:
        return None
    word = part.source.slice(tree.op_span)
    return Label(part.source, tree.bound.span, f"so this `{word}` needs no time")


RULE = LintRule("TLT0444", "note", check, supersedes=("TLT0442",))
