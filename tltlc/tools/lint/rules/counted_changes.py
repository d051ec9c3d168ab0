"""TLT0465: `times(begins a or ends a)`, where changes at steps in a row count once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, Unary
from tltlc.grammar.walk import conjuncts, operands
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, edited_text, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_COMPARISONS: Final = ("<", "<=", ">", ">=", "==", "!=")
_COUNTS: Final = ("times", "times_since", "times_within")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each count of one event or another, both of which are `begins p` or `ends p`.

    Each of them is over at the next step, but the other one may be there: then the count does not rise.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("reach", "keep", "avoid", "require"):
            keyword = f"{clause.kind} " if spec.declaration.block else ""
            compared = {id(side) for side in _sides(value)}
            for part in value.parts():
                call = part.tree
                if isinstance(call, CallExpr) and call.name in _COUNTS and call.name not in view.env.scope.names:
                    counted = part.with_tree(without_brackets(call.arguments[0].value))
                    if (step := _step_text(part, spec)) and call.name == "times_within" and _is_move(counted):
                        yield _finding_of_move(part, step, value if id(call) in compared else None, keyword)
                    for kinds, rest in _changes(counted):
                        yield _finding(part, kinds, rest, value if id(call) in compared else None, keyword)


def _is_move(counted: ScopedExpression) -> bool:
    """Whether what is counted is `x > previous(x)`, or another comparison of a number with that of the step before."""
    tree = counted.tree
    if not isinstance(tree, BinaryExpr) or tree.op not in ("<", ">", "!="):
        return False
    sides = [without_brackets(side) for side in (tree.left, tree.right)]
    return any(isinstance(side, CallExpr) and side.name == "previous" and not side.arguments[1:] for side in sides)


def _step_text(part: ScopedExpression, spec: SpecView) -> str:
    """Return the length of a step in seconds; "" if it varies or has none."""
    step_s = spec.spec.clock_s
    return "" if spec.spec.clock_varies or not step_s else f"{step_s:.10g} s"


def _finding_of_move(count: ScopedExpression, step: str, whole: ScopedExpression | None, keyword: str) -> RuleFinding:
    """Return the finding for a count of changes of a number, of which those at steps in a row count once."""
    assert isinstance(count.tree, CallExpr)
    of, time = (count.with_tree(argument.value).text for argument in count.tree.arguments[:2])
    total = f"total_time_within({of}, {time}) / {step}"
    label = Label(count.source, count.tree.span, "changes at steps in a row count once")
    offered = f"`{total}`"
    if whole is not None:
        offered = f"`{keyword}{edited_text(whole, count.tree.span, total)}`"
    help_ = (
        f"to count each step with it, write {offered}; if there is always a step between them, allow this with the "
        "comment `// tltlc: allow TLT0465`"
    )
    return RuleFinding("events at steps in a row count once", (label,), help_)


def _changes(counted: ScopedExpression) -> Iterator[tuple[list[ScopedExpression], list[ScopedExpression]]]:
    """Yield the beginnings and ends of `(begins a or ends a) and b`, and the other conditions beside them."""
    sides = [counted.with_tree(without_brackets(side)) for side in conjuncts(counted.tree)]
    for side in sides:
        kinds = [side.with_tree(without_brackets(kind)) for kind in operands(side.tree, "or")]
        if len(kinds) > 1 and all(
            isinstance(kind.tree, Unary) and kind.tree.op in ("begins", "ends") for kind in kinds
        ):
            yield kinds, [other for other in sides if other is not side]


def _sides(value: ScopedExpression) -> Iterator[Expr]:
    """Yield the sides of the comparisons in a clause, without their brackets."""
    for part in value.parts():
        if isinstance(part.tree, BinaryExpr) and part.tree.op in _COMPARISONS:
            yield from (without_brackets(part.tree.left), without_brackets(part.tree.right))


def _finding(
    count: ScopedExpression,
    kinds: list[ScopedExpression],
    rest: list[ScopedExpression],
    whole: ScopedExpression | None,
    keyword: str,
) -> RuleFinding:
    """Return the finding for a count, with its whole clause if a side of a comparison is that count."""
    assert isinstance(count.tree, CallExpr)
    others = [count.with_tree(argument.value).text for argument in count.tree.arguments[1:]]
    events = [" and ".join((kind.text, *(operand_text(other) for other in rest))) for kind in kinds]
    calls = [f"{count.tree.name}({', '.join((event, *others))})" for event in events]
    label = Label(count.source, count.tree.span, "if they take turns at each step, this counts only the first")
    total = " + ".join(calls)
    offered = f"`({total})`, with a maximum in each"
    if whole is not None:
        offered = f"`{keyword}{edited_text(whole, count.tree.span, total)}`"
    help_ = (
        f"to count each of them, write {offered}; if there is always a step between them, allow this with the comment "
        "`// tltlc: allow TLT0465`"
    )
    return RuleFinding("events at steps in a row count once", (label,), help_)


RULE = LintRule("TLT0465", "note", check)
