"""TLT0467: `require eventually always a`, where an episode ends at the first step with a."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Unary
from tltlc.tools.lint.file_view import FileView, ScopedExpression, without_brackets
from tltlc.tools.lint.goals import conjuncts
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `eventually always` of a spec that is judged at its goal.

    A recording that is judged whole meets it with its last step. An episode ends as soon as its spec is met.
    """
    for spec in view.specs:
        if spec.fspa.semantics == "finite" and spec.fspa.judge == "goal":
            for _, value in spec.clauses("require"):
                for part in conjuncts(value):
                    state = _state_at_end(part)
                    if state is not None:
                        yield _finding(part, state)


def _state_at_end(part: ScopedExpression) -> ScopedExpression | None:
    """Return a for `eventually always a`."""
    outer = without_brackets(part.tree)
    if not isinstance(outer, Unary) or outer.op != "F" or outer.bound is not None:
        return None
    inner = without_brackets(outer.operand)
    if not isinstance(inner, Unary) or inner.op != "G" or inner.bound is not None:
        return None
    return part.with_tree(without_brackets(inner.operand))


def _finding(part: ScopedExpression, state: ScopedExpression) -> RuleFinding:
    label = Label(part.source, part.tree.span, f"met at the first step with `{state.text}`: an episode may end there")
    help_ = (
        "a recording is judged to its last step; for the last step of an episode, too, add a limit, and write "
        "`judge at limit`; else allow this with the comment `// tltlc: allow TLT0467`"
    )
    return RuleFinding("an episode may end before this is decided", (label,), help_)


RULE = LintRule("TLT0467", "note", check)
