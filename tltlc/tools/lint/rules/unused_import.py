"""TLT0422: an unused import in a file that has specs."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Sequence

from tltlc.grammar.tree import ClockDecl, ExclusiveDecl, Import, ParamDecl, SignalDecl
from tltlc.resolve.imports import LoadedModule
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.removal import item_removal_spans, removal_span
from tltlc.tools.lint.rule import LintRule, RuleFinding, removal_fix


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each unused import, and for each unused name in an import list."""
    if not view.specs:
        return
    used_names = view.used_names
    used_by_target, effective = _used_by_target(used_names, view), _effective_modules(view.modules)
    for declaration, loaded in view.modules[-1].imports:
        if id(loaded) in effective:
            continue
        if not _provides_any(declaration, used_by_target.get(declaration.target, [])):
            removed = removal_span(view.source, declaration.span, view.module.comments)
            title = f"nothing from `{declaration.target}` is used"
            label = view.label(declaration.target_span)
            yield RuleFinding(
                title, (label,), "remove the import, or use it", removal_fix("Remove the import", (removed,))
            )
        else:
            yield from _unused_names(declaration, used_names, view)


def _unused_names(declaration: Import, used_names: Container[str], view: FileView) -> Iterator[RuleFinding]:
    names = declaration.names or ()
    for index, name in enumerate(names):
        if f"{_prefix(declaration)}{name.name}" not in used_names:
            removed = item_removal_spans([entry.span for entry in names], index, view.module.comments)
            title = f"`{name.name}` from `{declaration.target}` is not used"
            fix = removal_fix("Remove it from the import", removed)
            yield RuleFinding(title, (view.label(name.span),), "remove it from the import, or use it", fix)


def _used_by_target(used_names: Container[str], view: FileView) -> dict[str, list[str]]:
    """Map the target of each import to the names that come from it and are used, sorted.

    If several imports provide a name, it counts only for the first of them.
    """
    by_target: dict[str, list[str]] = {}
    for name, binding in view.env.scope.names.items():
        if binding.via is not None and name in used_names:
            by_target.setdefault(binding.via, []).append(name)
    return {target: sorted(names) for target, names in by_target.items()}


def _provides_any(declaration: Import, names: Sequence[str]) -> bool:
    """Whether an import provides any of ``names``, a sorted list of used names from its target."""
    if declaration.names is not None:
        return any(_first(names, entry.name) == entry.name for entry in declaration.names)
    prefix = _prefix(declaration)
    return bool(names) and _first(names, prefix).startswith(prefix)


def _first(names: Sequence[str], start: str) -> str:
    """Return the first name in the sorted ``names`` that is ``start`` or comes after it; ``""`` if there is none."""
    place = bisect_left(names, start)
    return names[place] if place < len(names) else ""


def _prefix(declaration: Import) -> str:
    return f"{declaration.alias}." if declaration.alias else ""


def _effective_modules(modules: Iterable[LoadedModule]) -> set[int]:
    """Return the ids of the modules that have an effect even if none of their names is used.

    Such a module declares a clock or exclusive atoms, or narrows the range of a signal or param that
    another module declares. A module that imports such a module has an effect, too. In ``modules``,
    imported modules must come before the modules that import them.
    """
    effective: set[int] = set()
    modules = tuple(modules)
    declaring = Counter(
        name
        for loaded in modules
        for name in {
            declaration.name
            for declaration in loaded.module.declarations
            if isinstance(declaration, (SignalDecl, ParamDecl))
        }
    )
    for loaded in modules:
        own = any(
            isinstance(declaration, (ClockDecl, ExclusiveDecl))
            or (isinstance(declaration, (SignalDecl, ParamDecl)) and declaring[declaration.name] > 1)
            for declaration in loaded.module.declarations
        )
        if own or any(id(imported) in effective for _, imported in loaded.imports):
            effective.add(id(loaded))
    return effective


RULE = LintRule("TLT0422", "warning", check, lint_only=True)
