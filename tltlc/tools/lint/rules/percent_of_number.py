"""TLT0438: a percentage beside a number that counts to 100: in `health > 40%`, the percentage is 0.4."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, NameExpr, NumberExpr
from tltlc.grammar.walk import expressions, parts
from tltlc.resolve.context import SignalInfo
from tltlc.resolve.spec import Param
from tltlc.resolve.values import number_text, range_text
from tltlc.tools.lint.file_view import FileView, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_OPERATORS: Final = ("<", "<=", ">", ">=", "==", "!=", "=")
_LEAST_TOP: Final = 10.0
"""The least upper end of a range whose values are surely no shares: a share may be 200 %."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each comparison, and each step of a test, with a percentage and a number in a wide range."""
    for declaration in view.module.declarations:
        for expression in expressions(declaration):
            for part in parts(expression):
                if isinstance(part, BinaryExpr) and part.op in _OPERATORS:
                    yield from _finding(part.left, part.right, view)
                    yield from _finding(part.right, part.left, view)


def _finding(value: Expr, percentage: Expr, view: FileView) -> Iterator[RuleFinding]:
    named, number = without_brackets(value), without_brackets(percentage)
    known = _declared(named, view) if isinstance(named, (NameExpr, CallExpr)) else None
    if known is None or not isinstance(number, NumberExpr) or number.unit != "%":
        return
    low, high = known.low, known.high
    if known.type not in ("number", "int") or low is None or high is None or low < 0 or high < _LEAST_TOP:
        return
    text, share = " ".join(view.source.slice(number.span).split()), number_text(number.value / 100)
    meant = number_text(round(number.value * high / 100, 9))
    reason = "" if high == 100 else f", which is {text} of {number_text(high)}"
    message = f"this is {share}, and `{known.name}` lies in {range_text(low, high, None)}"
    help_ = f"write `{meant}`{reason}, or `{share}` if that is meant"
    yield RuleFinding("a percentage is a share of 1", (view.label(number.span, message),), help_)


def _declared(named: NameExpr | CallExpr, view: FileView) -> SignalInfo | Param | None:
    """Return the signal or param that a name means; None if it means something else."""
    binding = view.env.scope.names.get(named.name)
    if binding is None or binding.kind not in ("signal", "param"):
        return None
    context = view.env.context
    return context.signal_infos.get(binding.name) or context.params.get(binding.name)


RULE = LintRule("TLT0438", "warning", check)
