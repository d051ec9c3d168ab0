"""TLT0442: `require always for 3 s a`, which is only about the first three seconds."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Unary
from tltlc.grammar.walk import conjuncts
from tltlc.resolve.units import time_units
from tltlc.tools.lint.file_view import FileView, without_brackets
from tltlc.tools.lint.goals import consists_of_implications
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each required `always for` a time, whose operand is about one step.

    TLT0441 reports implications. A spec of the form `spec NAME = FORMULA` gets no finding.
    """
    for spec in view.specs:
        for _, value in spec.clauses("require") if spec.declaration.block else ():
            for tree in map(without_brackets, conjuncts(value.tree)):
                if not isinstance(tree, Unary) or tree.op != "G" or tree.bound is None or not tree.bound.words:
                    continue
                lasting = value.with_tree(tree.operand)
                if lasting.depends_on_one_step() and not consists_of_implications(lasting):
                    time = " ".join(value.source.slice(tree.bound.high.span).split())
                    help_ = f"for every step, write `keep {lasting.text}`"
                    if tree.bound.high.unit in time_units():
                        help_ += f"; for {time} at some time, write `reach time_holding({lasting.text}) >= {time}`"
                    label = Label(value.source, tree.bound.span, "this time begins at the first step")
                    yield RuleFinding(f"this is only about the first {time} of play", (label,), help_)


RULE = LintRule("TLT0442", "note", check)
