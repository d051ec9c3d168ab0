"""TLT0421: a declaration that nothing uses, in a file that has specs."""

from __future__ import annotations

from collections.abc import Container, Iterator
from typing import Final, Union

from tltlc.core.source import Span
from tltlc.grammar.tree import EntityDecl, LetDecl, ParamDecl, PredicateDecl, SignalDecl
from tltlc.tools.lint.file_view import View
from tltlc.tools.lint.removal import item, without
from tltlc.tools.lint.rule import LintRule, Remark, removal

_KINDS: Final = {SignalDecl: "signal", ParamDecl: "param", PredicateDecl: "predicate", LetDecl: "let"}
Declared = Union[SignalDecl, ParamDecl, PredicateDecl, LetDecl]


def check(view: View) -> Iterator[Remark]:
    """Yield a remark for each declaration that is named neither here nor in an importing file.

    This covers signals, params, entities, predicates and lets.
    """
    if not view.specs:
        return
    used = view.used
    for declaration in view.module.declarations:
        if isinstance(declaration, EntityDecl):
            yield from _entities(declaration, used, view)
        elif isinstance(declaration, (SignalDecl, ParamDecl, PredicateDecl, LetDecl)) and not (
            declaration.name in used or _is_refined(declaration, view)
        ):
            removed = without(view.source, declaration.span, view.module.comments)
            yield _remark(_KINDS[type(declaration)], declaration.name, declaration.name_span, (removed,), view)


def _entities(declaration: EntityDecl, used: Container[str], view: View) -> Iterator[Remark]:
    spans = [name.span for name in declaration.names]
    unused = [index for index, name in enumerate(declaration.names) if name.name not in used]
    for index in unused:
        if len(unused) == len(spans):
            removed: tuple[Span, ...] = (without(view.source, declaration.span, view.module.comments),)
        else:
            removed = item(spans, index, view.module.comments)
        yield _remark("entity", declaration.names[index].name, spans[index], removed, view)


def _remark(kind: str, name: str, place: Span, removed: tuple[Span, ...], view: View) -> Remark:
    title = f"nothing uses the {kind} `{name}`"
    return Remark(title, (view.label(place),), "remove it, or use it", removal("Remove it", removed))


def _is_refined(declaration: Declared, view: View) -> bool:
    """Whether an imported module declares the same signal or param.

    Then that module uses the declaration, with the range that is given here.
    """
    return any(
        isinstance(other, (SignalDecl, ParamDecl)) and other.name == declaration.name
        for loaded in view.modules[:-1]
        for other in loaded.module.declarations
    )


RULE = LintRule("TLT0421", "warning", check)
