"""TLT0448: `keep a implies (b until c)`, which also asks that c comes."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.grammar.walk import conjuncts
from tltlc.tools.lint.asked_results import AskedResult, Rewriting, asked_results
from tltlc.tools.lint.file_view import FileView, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each goal of an `until` in what a rule for every step asks for after its condition.

    There is none if the rest of the spec asks for the goal, too, or if the `until` is within an `or`. Over infinite
    traces, no trace ends before the goal.
    """
    for spec in view.specs:
        if spec.spec.semantics != "finite":
            continue
        for clause, value in spec.clauses("keep", "require"):
            by_goal: dict[str, list[AskedResult]] = {}
            for asked in asked_results(clause, value):
                for result in _with_later_parts(asked):
                    tree = result.part.tree
                    if isinstance(tree, BinaryExpr) and tree.op == "U":
                        by_goal.setdefault(result.part.with_tree(tree.right).text, []).append(result)
            rewriting = Rewriting(clause, value, spec)
            for goal, untils in by_goal.items():
                others = [result.part for same in by_goal.values() if same is not untils for result in same]
                others += [step for same in by_goal.values() for result in same for step in result.next_steps]
                if rewriting.differs([result.part for result in untils], others):
                    yield _finding(rewriting, goal, untils)


def _with_later_parts(asked: AskedResult) -> Iterator[AskedResult]:
    """Yield a result, and what `eventually (a and (b until c))` asks for in it."""
    yield asked
    tree = asked.part.tree
    if isinstance(tree, Unary) and tree.op == "F":
        for part in conjuncts(without_brackets(tree.operand)):
            yield replace(asked, part=asked.part.with_tree(without_brackets(part)))


def _finding(rewriting: Rewriting, goal: str, untils: list[AskedResult]) -> RuleFinding:
    labels = tuple(
        Label(result.part.source, result.part.tree.span, f"so play must not end before `{goal}` comes")
        for result in untils
    )
    until = untils[0].part
    assert isinstance(until.tree, BinaryExpr)
    # If play may end before the goal, it may also end before the step of a `next` in front of the `until`.
    weak = [operator for result in untils for operator in (result.part, *result.next_steps)]
    help_ = (
        f"if `{goal}` need not come, write `{rewriting.text(weak)}`; "
        "if it must come, allow it with the comment `// tltlc: allow TLT0448`"
    )
    word = until.source.slice(until.tree.op_span)
    return RuleFinding(f"this `{word}` also asks that `{goal}` comes", labels, help_)


RULE = LintRule("TLT0448", "note", check)
