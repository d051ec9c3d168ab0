"""TLT0421: an unused declaration in a file that has specs."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from typing import Final, Union

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Severity
from tltlc.grammar.tree import EntityDecl, GroupDecl, LetDecl, ParamDecl, PredicateDecl, SignalDecl
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.removal import item_removal_spans, removal_span
from tltlc.tools.lint.rule import LintRule, RuleFinding, removal_fix

_KINDS: Final = {SignalDecl: "signal", ParamDecl: "param", PredicateDecl: "predicate", LetDecl: "let"}
_COLUMNS: Final = "a column of a recording needs no declaration"
_MOST_NAMES: Final = 20
"""The most names in the title of a finding that stands for several."""
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


def joined(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Replace the findings of this rule that have a fix by one, if there are several in a file.

    It is at the place of the first one, and lists the names. The other diagnostics stay as they are.
    """
    by_file: dict[tuple[SourceFile, Severity], list[Diagnostic]] = {}
    for diagnostic in (kept := [*diagnostics]):
        if diagnostic.code == RULE.code and diagnostic.fixes:
            by_file.setdefault((diagnostic.labels[0].source, diagnostic.severity), []).append(diagnostic)
    several = {group[0]: group for group in by_file.values() if len(group) > 1}
    left_out = {diagnostic for first, group in several.items() for diagnostic in group if diagnostic != first}
    return tuple(
        _for_all(several[diagnostic]) if diagnostic in several else diagnostic
        for diagnostic in kept
        if diagnostic not in left_out
    )


def _for_all(group: list[Diagnostic]) -> Diagnostic:
    """Return one finding for several unused declarations of a file."""
    first = group[0]
    labels = [diagnostic.labels[0] for diagnostic in group]
    names = [f"`{label.source.slice(label.span)}`" for label in labels[:_MOST_NAMES]]
    more = f" and {len(group) - _MOST_NAMES:,} more" if len(group) > _MOST_NAMES else ""
    title = f"nothing uses {len(group):,} declarations: {', '.join(names)}{more}"
    help_ = "use them, or remove them with `tltlc lint --fix`"
    if any(_COLUMNS in (diagnostic.help or "") for diagnostic in group):
        help_ += f"; {_COLUMNS}"
    return replace(first, title=title, labels=(replace(labels[0], message="the first of them"),), help=help_)


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


RULE = LintRule("TLT0421", "warning", check, lint_only=True)
