"""TLT0421: an unused declaration in a file that has specs."""

from __future__ import annotations

from collections.abc import Container, Iterator, Sequence
from typing import Final, Union

from tltlc.core.record import replace
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.tree import EntityDecl, GroupDecl, LetDecl, ParamDecl, PredicateDecl, SignalDecl
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.listed_names import listed_names
from tltlc.tools.lint.removal import item_removal_spans, removal_span
from tltlc.tools.lint.rule import LintRule, RuleFinding, removal_fix

_KINDS: Final = {SignalDecl: "signal", ParamDecl: "param", PredicateDecl: "predicate", LetDecl: "let"}
_COLUMNS: Final = "a column of a recording needs no declaration"
_CheckedDeclaration = Union[SignalDecl, ParamDecl, PredicateDecl, LetDecl]


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each signal, param, entity, group, predicate and let that is not used.

    A name is used if an expression in this file, or a file that imports this file, mentions it.
    """
    if not view.specs:
        return
    used_names = view.used_names
    for declaration in view.module.declarations:
        if isinstance(declaration, EntityDecl):
            yield from _entities(declaration, used_names, view)
        elif isinstance(declaration, GroupDecl) and declaration.name not in used_names:
            yield _group_finding(declaration, view)
        elif isinstance(declaration, (SignalDecl, ParamDecl, PredicateDecl, LetDecl)) and not (
            declaration.name in used_names or _is_refined(declaration, view)
        ):
            removed = removal_span(view.source, declaration.span, view.module.comments)
            yield _finding(_KINDS[type(declaration)], declaration.name, declaration.name_span, (removed,), view)


def join(group: Sequence[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return one finding for those of a file that have a fix, if there are several, and the others unchanged."""
    fixable = [diagnostic for diagnostic in group if diagnostic.fixes]
    if len(fixable) < 2:
        return (*group,)
    first, others = fixable[0], [diagnostic for diagnostic in group if not diagnostic.fixes]
    title = f"nothing uses {len(fixable):,} declarations: {listed_names(fixable)}"
    help_ = "use them, or remove them with `tltlc lint --fix`"
    if any(_COLUMNS in (diagnostic.help or "") for diagnostic in fixable):
        help_ += f"; {_COLUMNS}"
    label = replace(first.labels[0], message="the first of them")
    return replace(first, title=title, labels=(label,), help=help_), *others


def _entities(declaration: EntityDecl, used_names: Container[str], view: FileView) -> Iterator[RuleFinding]:
    spans = [name.span for name in declaration.names]
    unused = [index for index, name in enumerate(declaration.names) if name.name not in used_names]
    for index in unused:
        if len(unused) == len(spans):
            removed: tuple[Span, ...] = (removal_span(view.source, declaration.span, view.module.comments),)
        else:
            removed = item_removal_spans(spans, index, view.module.comments)
        yield _finding("entity", declaration.names[index].name, spans[index], removed, view)


def _group_finding(declaration: GroupDecl, view: FileView) -> RuleFinding:
    # There is no fix: the group may be what declares its members.
    members = ", ".join(member.name for member in declaration.members)
    help_ = f"use it, as in `all x in {declaration.name}: …`, or declare its members alone: `entity {members}`"
    return RuleFinding(f"nothing uses the group `{declaration.name}`", (view.label(declaration.name_span),), help_)


def _finding(kind: str, name: str, place: Span, removed: tuple[Span, ...], view: FileView) -> RuleFinding:
    title = f"nothing uses the {kind} `{name}`"
    help_ = "remove it, or use it"
    if kind == "signal":
        help_ += f"; {_COLUMNS}"
    return RuleFinding(title, (view.label(place),), help_, removal_fix("Remove it", removed))


def _is_refined(declaration: _CheckedDeclaration, view: FileView) -> bool:
    """Whether an imported module declares a signal or param with the same name.

    Then the declaration narrows the range of the imported one, so it is not unused.
    """
    return any(
        isinstance(imported, (SignalDecl, ParamDecl)) and imported.name == declaration.name
        for loaded in view.modules[:-1]
        for imported in loaded.module.declarations
    )


RULE = LintRule("TLT0421", "warning", check, lint_only=True, join=join)
