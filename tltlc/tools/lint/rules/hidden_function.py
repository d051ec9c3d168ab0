"""TLT0436: a declaration with the name of a function about the trace so far."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.grammar.tree import LetDecl, ParamDecl, PredicateDecl, SignalDecl
from tltlc.resolve.scope import MEMORY_FUNCTIONS
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each declaration of the file that hides a function of the language."""
    for declaration in view.module.declarations:
        if isinstance(declaration, (SignalDecl, ParamDecl, PredicateDecl, LetDecl)):
            name = declaration.name
            if name in MEMORY_FUNCTIONS:
                label = view.label(declaration.name_span, f"in this file, `{name}` means this")
                help_ = f"choose another name, e.g. `{name}_`, so that `{name}(…)` keeps its meaning"
                yield RuleFinding(f"`{name}` hides a function of the language", (label,), help_)


RULE = LintRule("TLT0436", "warning", check)
