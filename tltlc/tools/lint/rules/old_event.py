"""TLT0489: `keep begins a implies once begins b`, where one b is enough for every later a."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Unary
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.edges import edge_of
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.names import mentioned_signals
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule about an event that asks for another event at some earlier step.

    There is none for `once within 2 s b`, nor if the other event is one of the first, or is no beginning or end:
    `begins a implies once has_key` may well ask for a key that is found once.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                event, earlier = edge_of(asked.condition), _asked_event(asked.part)
                if event is None or earlier is None or asked.steps:
                    continue
                scope = asked.part.env.scope
                if not mentioned_signals(earlier.tree, scope) & mentioned_signals(event.tree, scope):
                    yield _finding(asked, event, earlier, is_whole=asked.is_all_of(clause, value))


def _asked_event(answer: ScopedExpression) -> ScopedExpression | None:
    """Return the event of `once begins b`, perhaps with other conditions; None for other answers."""
    tree = without_brackets(answer.tree)
    if not isinstance(tree, Unary) or tree.op != "once" or tree.bound is not None:
        return None
    inner = answer.with_tree(without_brackets(tree.operand))
    return inner if edge_of(inner) is not None else None


def _finding(asked: AskedResult, event: ScopedExpression, earlier: ScopedExpression, *, is_whole: bool) -> RuleFinding:
    label = Label(earlier.source, asked.part.tree.span, f"one of these is enough for every later `{event.text}`")
    since = f"{operand_text(earlier)} or previously (not {event.text} since {operand_text(earlier)})"
    offered = f"keep {asked.condition.text} implies {since}" if is_whole else f"({since})"
    help_ = (
        f"if each `{event.text}` needs one since the last, write `{offered}`; if one is enough for all, allow this "
        "with the comment `// tltlc: allow TLT0489`"
    )
    return RuleFinding(f"`{earlier.text}` may have been before the last `{event.text}`", (label,), help_)


RULE = LintRule("TLT0489", "note", check)
