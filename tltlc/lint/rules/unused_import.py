"""TLT0422: an import of which nothing is used, in a file that has specs."""

from __future__ import annotations

from collections.abc import Container, Iterator

from tltlc.grammar.tree import ClockDecl, ExclusiveDecl, Import
from tltlc.lint.removal import item, without
from tltlc.lint.rule import Remark, Rule, removal
from tltlc.lint.view import View
from tltlc.resolve.imports import Loaded


def check(view: View) -> Iterator[Remark]:
    """A remark for each import that brings no name that the file mentions, and for each name chosen in vain."""
    if not view.specs:
        return
    used = view.used
    for declaration, loaded in view.modules[-1].imports:
        if _counts_unnamed(loaded):
            continue
        if not any(name in used for name in _brought(declaration, view)):
            gone = without(view.source, declaration.span, view.module.comments)
            title = f"nothing of `{declaration.target}` is used"
            remark = view.label(declaration.target_span)
            yield Remark(title, (remark,), "remove the import, or use it", removal("Remove the import", (gone,)))
        else:
            yield from _names(declaration, used, view)


def _names(declaration: Import, used: Container[str], view: View) -> Iterator[Remark]:
    names = declaration.names or ()
    for index, name in enumerate(names):
        if f"{_prefix(declaration)}{name.name}" not in used:
            gone = item([each.span for each in names], index, view.module.comments)
            title = f"`{name.name}` of `{declaration.target}` is not used"
            fix = removal("Remove it from the import", gone)
            yield Remark(title, (view.label(name.span),), "remove it from the import, or use it", fix)


def _brought(declaration: Import, view: View) -> set[str]:
    """The names that an import makes visible; a name that an earlier one brings as well is counted there."""
    prefix = _prefix(declaration)
    names = [name for name, binding in view.env.scope.names.items() if binding.via == declaration.target]
    chosen = {f"{prefix}{name.name}" for name in declaration.names or ()}
    return {name for name in names if name in chosen or (declaration.names is None and name.startswith(prefix))}


def _prefix(declaration: Import) -> str:
    return f"{declaration.alias}." if declaration.alias else ""


def _counts_unnamed(loaded: Loaded) -> bool:
    """Whether a module, or one that it imports, says what counts without being named: a clock, or what is exclusive."""
    own = any(isinstance(each, (ClockDecl, ExclusiveDecl)) for each in loaded.module.declarations)
    return own or any(_counts_unnamed(other) for _, other in loaded.imports)


RULE = Rule("TLT0422", "warning", check)
