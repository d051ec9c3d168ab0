"""TLT0422: an import of which nothing is used, in a file that has specs."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Sequence

from tltlc.grammar.tree import ClockDecl, ExclusiveDecl, Import, ParamDecl, SignalDecl
from tltlc.resolve.imports import Loaded
from tltlc.tools.lint.file_view import View
from tltlc.tools.lint.removal import item, without
from tltlc.tools.lint.rule import Remark, Rule, removal


def check(view: View) -> Iterator[Remark]:
    """A remark for each import that brings no name that the file mentions, and for each name chosen in vain."""
    if not view.specs:
        return
    used = view.used
    brought, unnamed = _brought(used, view), _count_unnamed(view.modules)
    for declaration, loaded in view.modules[-1].imports:
        if id(loaded) in unnamed:
            continue
        if not _brings_any(declaration, brought.get(declaration.target, [])):
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


def _brought(used: Container[str], view: View) -> dict[str, list[str]]:
    """The names that are used, by the target of the import that makes them visible, in sorted order.

    A name that an earlier import brings as well is counted there.
    """
    found: dict[str, list[str]] = {}
    for name, binding in view.env.scope.names.items():
        if binding.via is not None and name in used:
            found.setdefault(binding.via, []).append(name)
    return {target: sorted(names) for target, names in found.items()}


def _brings_any(declaration: Import, names: Sequence[str]) -> bool:
    """Whether an import makes any of these sorted names visible."""
    if declaration.names is not None:
        return any(_first(names, each.name) == each.name for each in declaration.names)
    prefix = _prefix(declaration)
    return bool(names) and _first(names, prefix).startswith(prefix)


def _first(names: Sequence[str], start: str) -> str:
    """The first of these names, which are sorted, that is not below a text; empty where there is none."""
    place = bisect_left(names, start)
    return names[place] if place < len(names) else ""


def _prefix(declaration: Import) -> str:
    return f"{declaration.alias}." if declaration.alias else ""


def _count_unnamed(modules: Iterable[Loaded]) -> set[int]:
    """The modules, by identity, that say what counts without being named: a clock, what is exclusive, or the range of
    a signal or a param that another module declares as well.

    They may say it by what they import, which stands before them.
    """
    found: set[int] = set()
    modules = tuple(modules)
    declaring = Counter(
        name
        for loaded in modules
        for name in {each.name for each in loaded.module.declarations if isinstance(each, (SignalDecl, ParamDecl))}
    )
    for loaded in modules:
        own = any(
            isinstance(each, (ClockDecl, ExclusiveDecl))
            or (isinstance(each, (SignalDecl, ParamDecl)) and declaring[each.name] > 1)
            for each in loaded.module.declarations
        )
        if own or any(id(other) in found for _, other in loaded.imports):
            found.add(id(loaded))
    return found


RULE = Rule("TLT0422", "warning", check)
