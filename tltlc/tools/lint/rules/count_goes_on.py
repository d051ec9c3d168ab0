"""TLT0470: `times_since(a, begins b) <= 3`, which also counts after b has ended, and before its first beginning."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, NameExpr, Unary
from tltlc.grammar.walk import parts
from tltlc.tools.lint.file_view import FileView, ScopedExpression, negated_text, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.stretches import every_step

_SINCE: Final = ("times_since", "total_time_since")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each limit at every step of what is counted since a condition began that may end.

    There is none if the counted condition mentions the condition, which then may hold where it counts.
    """
    for spec in view.specs:
        if not spec.declaration.block:
            continue
        for clause, value in spec.clauses("keep"):
            for tree in every_step(clause, value):
                if isinstance(tree, BinaryExpr) and tree.op in ("<", "<="):
                    call = tree.left
                    if isinstance(call, CallExpr) and call.name in _SINCE and call.name not in view.env.scope.names:
                        yield from _findings(value.with_tree(tree), call)


def _findings(limit: ScopedExpression, call: CallExpr) -> Iterator[RuleFinding]:
    counted, start = (without_brackets(argument.value) for argument in call.arguments[:2])
    if not isinstance(start, Unary) or start.op not in ("begins", "ends") or _names(start) & _names(counted):
        return
    state, start_text = limit.with_tree(without_brackets(start.operand)), limit.with_tree(start).text
    where, title = operand_text(state), f"this also counts where `{state.text}` does not hold"
    goes_on = f"this goes on after `{state.text}` ends, and counts before its first beginning"
    if start.op == "ends":
        where, title = negated_text(state), f"this also counts where `{state.text}` holds"
        goes_on = f"this goes on when `{state.text}` begins again, and counts before its first end"
    once = operand_text(limit.with_tree(start))
    help_ = (
        f"if it counts until `{start_text}` comes again, allow this with the comment `// tltlc: allow TLT0470`; "
        f"if it does not count before the first, write `keep once {once} implies {limit.text}`; "
        f"if only steps {'with' if start.op == 'begins' else 'without'} `{state.text}` count, write "
        f"`keep {where} implies {limit.text}`"
    )
    yield RuleFinding(title, (Label(limit.source, call.span, goes_on),), help_)


def _names(tree: Expr) -> set[str]:
    return {part.name for part in parts(tree) if isinstance(part, (NameExpr, CallExpr))}


RULE = LintRule("TLT0470", "note", check)
