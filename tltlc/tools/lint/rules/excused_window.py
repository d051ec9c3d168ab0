"""TLT0486: `keep x >= highest_within(x, 2 s) - 5 or a`, where a excuses its own step, and not the 2 s."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, Unary
from tltlc.grammar.walk import operands, parts
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.scope import MEMORY_FUNCTIONS
from tltlc.tools.lint.asked_results import asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, edited_text, operand_text, without_brackets
from tltlc.tools.lint.names import mentioned_signals
from tltlc.tools.lint.rule import LintRule, RuleFinding

_WINDOWS: Final = ("highest_within", "lowest_within", "times_within", "total_time_within", "previous")
_EARLIER: Final = ("once", "historically", "previously", "since")
_COMPARISONS: Final = ("<", "<=", ">", ">=", "==", "!=")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each limit on the last seconds, or else a condition of the step itself.

    What that condition allows is still in the last seconds once it is over. There is none if it is about the number
    of the limit, or says itself what has been.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep"):
            results = [asked.part for asked in asked_results(clause, value) if not asked.steps]
            whole = value.with_tree(without_brackets(value.tree))
            for answer in results or [whole]:
                yield from _findings(answer, clause, value, is_block=bool(spec.declaration.block))


def _findings(
    answer: ScopedExpression, clause: Clause, value: ScopedExpression, *, is_block: bool
) -> Iterator[RuleFinding]:
    sides = operands(answer.tree, "or", through_brackets=True)
    limits = [
        (place, call) for place, tree in enumerate(sides) if (call := _window(without_brackets(tree))) is not None
    ]
    if len(sides) < 2 or len(limits) != 1:
        return
    ((place, call),) = limits
    excuses = [answer.with_tree(without_brackets(tree)) for tree in (*sides[:place], *sides[place + 1 :])]
    scope = answer.env.scope
    about = mentioned_signals(sides[place], scope)
    if call.name in scope.names or any(not _is_present(excuse) for excuse in excuses):
        return
    if any(mentioned_signals(excuse.tree, scope) & about for excuse in excuses):
        return
    length = answer.with_tree(call.arguments[1].value).text
    excuse = excuses[0].text if len(excuses) == 1 else f"({' or '.join(each.text for each in excuses)})"
    operand = operand_text(excuses[0]) if len(excuses) == 1 else excuse
    limit = answer.with_tree(without_brackets(sides[place]))
    meant = f"{limit.text} or once within {length} {operand}"
    keyword = f"{clause.kind} " if is_block else ""
    label = Label(limit.source, call.span, f"once `{excuse.strip('()')}` is over, this is still about the time with it")
    help_ = (
        f"if it excuses what comes up to {length} later, write "
        f"`{keyword}{edited_text(value, answer.tree.span, meant)}`; if it counts at its own step alone, allow this "
        "with the comment `// tltlc: allow TLT0486`"
    )
    yield RuleFinding(f"`{excuse.strip('()')}` does not excuse the last {length} once it is over", (label,), help_)


def _window(tree: Expr) -> CallExpr | None:
    """Return the only function of the past in a comparison, if it is about the last seconds; else None."""
    if not isinstance(tree, BinaryExpr) or tree.op not in _COMPARISONS:
        return None
    calls = [part for part in parts(tree) if isinstance(part, CallExpr) and part.name in MEMORY_FUNCTIONS]
    is_window = len(calls) == 1 and calls[0].name in _WINDOWS and len(calls[0].arguments) > 1
    return calls[0] if is_window else None


def _is_present(excuse: ScopedExpression) -> bool:
    """Whether a condition is about the step itself alone."""
    formula = excuse.formula()
    is_recalled = any(
        (isinstance(part, CallExpr) and part.name in MEMORY_FUNCTIONS)
        or (isinstance(part, (Unary, BinaryExpr)) and part.op in _EARLIER)
        for part in parts(excuse.tree)
    )
    return formula is not None and is_state(formula) and not is_recalled and excuse.depends_on_one_step()


RULE = LintRule("TLT0486", "note", check)
