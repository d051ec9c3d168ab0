"""TLT0454: `a since b`, for which a must have held at every step since b."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, CallExpr, IsExpr, LetDecl, NameExpr, SpecDecl
from tltlc.tools.lint.file_view import FileView, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `since` after a plain name or a test of an enum, which may be meant as an event.

    After a comparison or a negation, which say how things are, there is none.
    """
    for declaration in view.module.declarations:
        if not isinstance(declaration, (LetDecl, SpecDecl)):
            continue
        for expression in walk.expressions(declaration):
            for part in walk.parts(expression):
                if isinstance(part, BinaryExpr) and part.op == "since":
                    yield from _finding(part, view)


def _finding(part: BinaryExpr, view: FileView) -> Iterator[RuleFinding]:
    held = without_brackets(part.left)
    if not isinstance(held, (NameExpr, CallExpr, IsExpr)) or getattr(held, "negated", False):
        return
    state, event = (" ".join(view.source.slice(side.span).split()) for side in (held, part.right))
    label = Label(view.source, part.span, f"`{state}` must have held at every step since `{event}`")
    absent = f"not {event}" if event.isidentifier() or event.startswith("(") else f"not ({event})"
    help_ = (
        f"write `(({absent}) since {state})` if once since then is enough; "
        "if you mean this, allow it with the comment `// tltlc: allow TLT0454`"
    )
    yield RuleFinding("`since` asks for every step", (label,), help_)


RULE = LintRule("TLT0454", "note", check)
