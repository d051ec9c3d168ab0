"""TLT0451: `times(p) <= 3 since q`, read as `(times(p) <= 3) since q`, where the count begins at the first step."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar import walk
from tltlc.grammar.past_words import SINCE
from tltlc.grammar.tree import BinaryExpr, CallExpr, LetDecl, SpecDecl
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rule import LintRule, RuleFinding

_COMPARISONS: Final = ("<", "<=", ">", ">=", "==", "!=")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each comparison of `times` and its like that stands before `since` without brackets."""
    for declaration in view.module.declarations:
        if isinstance(declaration, (LetDecl, SpecDecl)):
            for expression in walk.expressions(declaration):
                for part in walk.parts(expression):
                    if isinstance(part, BinaryExpr) and part.op == "since":
                        yield from _findings(part, view.source)


def _findings(part: BinaryExpr, source: SourceFile) -> Iterator[RuleFinding]:
    compared = part.left
    if not isinstance(compared, BinaryExpr) or compared.op not in _COMPARISONS:
        return
    count = compared.left
    if not isinstance(count, CallExpr) or count.name not in SINCE or len(count.arguments) != 1:
        return
    counted, event = _text(count.arguments[0].value.span, source), _text(part.right.span, source)
    comparison, rest = _text(compared.span, source), _text(Span(count.span.end, compared.span.end), source)
    label = Label(source, part.span, f"read as `({comparison}) since {event}`")
    help_ = (
        f"write `{SINCE[count.name]}({counted}, {event}) {rest}` for what has been since `{event}`, "
        f"or `({comparison}) since {event}` if you mean this"
    )
    yield RuleFinding(f"`{_text(count.span, source)}` begins at the first step", (label,), help_)


def _text(span: Span, source: SourceFile) -> str:
    return " ".join(source.slice(span).split())


RULE = LintRule("TLT0451", "warning", check)
