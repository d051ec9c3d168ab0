"""TLT0466: `keep times(a) == 1` and `keep once a`, which the first step breaks if it does not have a."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, NumberExpr, Unary
from tltlc.grammar.walk import parts
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.stretches import every_step

_COUNTS: Final = ("times", "times_since", "times_within")
_EARLIER: Final = ("ends", "previously")
"""What is about a step before, and so holds at no first step."""
_NEGATED: Final = {"<": ">=", "<=": ">", "==": "!=", "!=": "==", ">": "<=", ">=": "<"}
_MIRRORED: Final = {"<": ">", "<=": ">=", "==": "==", "!=": "!=", ">": "<", ">=": "<="}


@record
class _Comparison:
    """A function of the trace so far, compared with a number: ``times(a) >= 1``."""

    call: CallExpr
    sign: str
    number: ScopedExpression


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule for every step that says something has come already.

    At the first step, nothing has come yet but what holds there.
    """
    for spec in view.specs:
        if not spec.declaration.block:
            continue
        for clause, value in spec.clauses("keep", "avoid", "require"):
            is_avoided = clause.kind == "avoid"
            trees = [without_brackets(value.tree)] if is_avoided else every_step(clause, value)
            for part in map(value.with_tree, trees):
                finding = _finding(part, view, is_avoided=is_avoided)
                if finding is not None:
                    yield finding


def _finding(part: ScopedExpression, view: FileView, *, is_avoided: bool) -> RuleFinding | None:
    tree = part.tree
    if isinstance(tree, Unary):
        if tree.op == "not" and is_avoided:
            return _finding(part.with_tree(without_brackets(tree.operand)), view, is_avoided=False)
        if tree.op != "once" or is_avoided:
            return None
        event = part.with_tree(tree.operand)
        if any(isinstance(side, Unary) and side.op in _EARLIER for side in parts(event.tree)):
            return None
        if tree.bound is not None:
            return _finding_of(part, event, _without(event, part.with_tree(tree.bound.high).text))
        return _finding_of(part, event, f"if it must come at some time, write `reach {event.text}`")
    comparison = _comparison(part, view)
    if comparison is None or not isinstance(comparison.number.tree, NumberExpr):
        return None
    sign, call = comparison.sign, comparison.call
    if is_avoided:
        sign = ">" if sign == "==" and comparison.number.tree.value == 0 else _NEGATED[sign]
    event = part.with_tree(call.arguments[0].value)
    is_time = call.name == "time_since"
    if any(isinstance(side, Unary) and side.op in _EARLIER for side in parts(event.tree)):
        return None  # TLT0458 says that no first step has it
    if is_time and sign == "<=" and len(call.arguments) == 1:
        return _finding_of(part, event, _without(event, comparison.number.text))
    least = comparison.number.tree.value + (sign == ">")
    if is_time or sign not in (">=", ">", "==") or least < 1 or (sign == "==" and call.name != "times"):
        return None
    if least > 1:
        return _twice_within(part) if call.name == "times_within" else None  # TLT0458 has the others
    if call.name == "times_within":
        return _finding_of(part, event, _without(event, part.with_tree(call.arguments[1].value).text))
    if call.name == "times_since":
        help_ = f"if it must come at some time, write `reach {part.with_tree(call).text} >= 1`"
    elif sign == "==":
        help_ = f"if it must come once in all, write `reach {event.text}` and `keep {part.with_tree(call).text} <= 1`"
    else:
        help_ = f"if it must come at some time, write `reach {event.text}`"
    return _finding_of(part, event, help_)


def _twice_within(part: ScopedExpression) -> RuleFinding:
    label = Label(part.source, part.tree.span, "nothing has come twice at the first step")
    help_ = f"if it must come at some time, write `reach {part.text}`"
    return RuleFinding("the first step always breaks this rule", (label,), help_)


def _finding_of(part: ScopedExpression, event: ScopedExpression, help_: str) -> RuleFinding:
    label = Label(part.source, part.tree.span, "asked for at every step, the first one among them")
    allowing = "if the first step has it, allow this with the comment `// tltlc: allow TLT0466`"
    return RuleFinding(f"the first step must already have `{event.text}`", (label,), f"{help_}; {allowing}")


def _without(event: ScopedExpression, time: str) -> str:
    """Return how to say that p never stays away for longer than a time, also at the start."""
    return (
        f"if at most {time} may pass without it, also at the start, write "
        f"`keep time_holding(not {operand_text(event)}) < {time}`"
    )


def _comparison(part: ScopedExpression, view: FileView) -> _Comparison | None:
    tree = part.tree
    if not isinstance(tree, BinaryExpr) or tree.op not in _NEGATED:
        return None
    sign, (call, number) = tree.op, (without_brackets(tree.left), without_brackets(tree.right))
    if isinstance(number, CallExpr):
        sign, call, number = _MIRRORED[sign], number, call
    if not isinstance(call, CallExpr) or call.name not in (*_COUNTS, "time_since"):
        return None
    return None if call.name in view.env.scope.names else _Comparison(call, sign, part.with_tree(number))


RULE = LintRule("TLT0466", "warning", check)
