"""TLT0452: `previous(p)` of a bool, which is p itself at the first step, where `previously p` is false."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.grammar import walk
from tltlc.grammar.tree import CallExpr, Expr, LetDecl, NameExpr, SpecDecl
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `previous` of a bool signal in a formula, whose value at the first step may surprise."""
    for declaration in view.module.declarations:
        if isinstance(declaration, (LetDecl, SpecDecl)):
            for expression in walk.expressions(declaration):
                for part in walk.parts(expression):
                    if isinstance(part, CallExpr) and part.name == "previous" and len(part.arguments) == 1:
                        yield from _finding(part, part.arguments[0].value, view)


def _finding(call: CallExpr, argument: Expr, view: FileView) -> Iterator[RuleFinding]:
    if not isinstance(argument, (NameExpr, CallExpr)) or not _is_bool(argument.name, view):
        return
    if call.name in view.env.scope.names:
        return
    text = " ".join(view.source.slice(argument.span).split())
    title = f"`previous({text})` is `{text}` itself at the first step"
    help_ = (
        f"write `previously {text}`, which is false there; "
        "if you mean the value at the first step, allow it with the comment `// tltlc: allow TLT0452`"
    )
    yield RuleFinding(title, (view.label(call.span),), help_)


def _is_bool(name: str, view: FileView) -> bool:
    binding = view.env.scope.names.get(name)
    if binding is None or binding.kind != "signal":
        return False
    known = view.env.context.signal_infos.get(binding.name)
    return known is not None and known.type == "bool"


RULE = LintRule("TLT0452", "note", check)
