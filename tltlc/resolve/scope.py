"""Find the names that are visible in a module: its own and those of its imports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Literal, Union

from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, replacement_fix
from tltlc.grammar.module import Module
from tltlc.grammar.tree import EntityDecl, GroupDecl, Import, LetDecl, NameExpr, ParamDecl, PredicateDecl, SignalDecl
from tltlc.grammar.typos import likely_name
from tltlc.io.limits import IMPORTED
from tltlc.resolve.imports import LoadedModule
from tltlc.resolve.problem import Log, problem

BindingKind = Literal["signal", "param", "predicate", "let", "entity", "group"]
NamedDeclaration = Union[SignalDecl, ParamDecl, PredicateDecl, LetDecl, GroupDecl, NameExpr]
FUNCTIONS = ("min", "max", "abs", "clamp", "sqrt", "exp", "tanh")
MEMORY_FUNCTIONS = (
    "times",
    "times_since",
    "times_within",
    "time_since",
    "time_holding",
    "total_time",
    "total_time_since",
    "total_time_within",
    "previous",
    "initial",
    "highest",
    "lowest",
    "highest_since",
    "lowest_since",
    "highest_within",
    "lowest_within",
    "value_at",
)
"""The functions of the trace so far. A declaration may take the name of one: then the name means the declaration."""
_MERGED = ("signal", "param", "entity")


@record
class Binding:
    """What a name means: its declaration, and the scope of the module that declares it.

    ``via`` is the library or file from which the name is imported; None for a name that the module
    declares itself.
    """

    kind: BindingKind
    declaration: NamedDeclaration
    scope: Scope
    via: str | None = None

    @property
    def name(self) -> str:
        """The declared name, without any alias."""
        return self.declaration.name

    @property
    def span(self) -> Span:
        """The place of the declared name in ``scope.source``."""
        return self.declaration.span if isinstance(self.declaration, NameExpr) else self.declaration.name_span


@record
class Scope:
    """A module and the names that are visible in it, each with its binding.

    ``title`` is the name of the module in messages.
    """

    module: Module
    title: str
    incomplete: bool
    """Whether names may be missing because an import failed, here or in an imported module."""
    names: dict[str, Binding]

    @property
    def source(self) -> SourceFile:
        """The text that the spans of this scope's declarations refer to."""
        return self.module.source


def build_scopes(modules: Iterable[LoadedModule], log: Log) -> tuple[Scope, ...]:
    """Return one scope per module, in the order of ``modules``, which has imported modules first.

    Conflicts of names are logged. All imports together may make a limited number of names visible.
    The import that exceeds the limit is an error (TLT0012); this import and all later ones are left
    out.
    """
    scopes: dict[int, Scope] = {}
    budget = _NameBudget()
    for loaded in modules:
        imports = [(declaration, scopes[id(target)]) for declaration, target in loaded.imports]
        covered = [pair for pair in imports if budget.covers(*pair, loaded.module.source, log)]
        incomplete = (
            not loaded.complete or len(covered) < len(imports) or any(target.incomplete for _, target in covered)
        )
        scope = Scope(loaded.module, loaded.title, incomplete, {})
        scopes[id(loaded)] = scope
        for binding in _own_bindings(scope):
            log.add(_declare(scope, binding))
        for declaration, target in covered:
            _import(declaration, target.names, scope, log)
    return tuple(scopes.values())


def closest_name(name: str, scope: Scope, kinds: Iterable[BindingKind], local: Iterable[str] = ()) -> str | None:
    """Return the visible name that an unknown name most likely misspells, or None if no name is close.

    Only names of one of ``kinds``, and the names in ``local``, count.
    """
    allowed_kinds = set(kinds)
    return likely_name(name, [*local, *(n for n, binding in scope.names.items() if binding.kind in allowed_kinds)])


class _NameBudget:
    """Counts down how many names, and how many letters in prefixed names, imports may still make visible."""

    def __init__(self) -> None:
        self._names: int = IMPORTED.values or 0
        self._letters = IMPORTED.size
        self._is_over = False

    def covers(self, declaration: Import, target: Scope, source: SourceFile, log: Log) -> bool:
        """Subtract the names of an import from the budget, and return whether the budget covers them.

        Log an error for the first import that exceeds the budget, and return False for it and all
        later ones.
        """
        if self._is_over:
            return False
        chosen = target.names if declaration.names is None else [name_expr.name for name_expr in declaration.names]
        self._names -= len(chosen)
        if declaration.alias and self._names >= 0:
            self._letters -= (len(declaration.alias) + 1) * len(chosen) + sum(map(len, chosen))
        self._is_over = self._names < 0 or self._letters < 0
        if self._is_over:
            title = f"the imports of all files offer more than {IMPORTED.values:,} names"
            advice = "import each file under one name only, or list in brackets only the names that you use"
            if self._names >= 0:
                title = f"the names that all files import with `as` have more than {IMPORTED.size:,} letters in total"
                advice = "choose a shorter name after `as`"
            brings = f"this one brings {len(chosen):,} name{'' if len(chosen) == 1 else 's'}"
            log.add(problem("TLT0012", title, source, declaration.span, brings, advice=advice).diagnostic)
        return not self._is_over


def _import(declaration: Import, offered: Mapping[str, Binding], scope: Scope, log: Log) -> None:
    """Make the imported names of a module visible in ``scope``; log an error for each conflict."""
    chosen = dict(offered) if declaration.names is None else {}
    for imported_name in declaration.names or ():
        if imported_name.name in offered:
            chosen[imported_name.name] = offered[imported_name.name]
        else:
            log.add(_not_offered_error(scope, imported_name, declaration.target, offered))
    prefix = f"{declaration.alias}." if declaration.alias else ""
    for name, binding in chosen.items():
        log.add(_add_imported_name(scope, prefix + name, replace(binding, via=declaration.target), declaration.span))


def _own_bindings(scope: Scope) -> Iterator[Binding]:
    """Yield the bindings of a module's own names; a group declares those of its members that nothing else declares."""
    declared = {name.name for name in _listed_entities(scope.module)}
    declared.update(declaration.name for declaration in scope.module.declarations if isinstance(declaration, GroupDecl))
    for declaration in scope.module.declarations:
        if isinstance(declaration, SignalDecl):
            yield Binding("signal", declaration, scope)
        elif isinstance(declaration, ParamDecl):
            yield Binding("param", declaration, scope)
        elif isinstance(declaration, PredicateDecl):
            yield Binding("predicate", declaration, scope)
        elif isinstance(declaration, LetDecl):
            yield Binding("let", declaration, scope)
        elif isinstance(declaration, EntityDecl):
            for name in declaration.names:
                yield Binding("entity", name, scope)
        elif isinstance(declaration, GroupDecl):
            yield Binding("group", declaration, scope)
            for member in declaration.members:
                # A name with a point, such as `st.guard`, is that of an import.
                if member.name not in declared and "." not in member.name:
                    declared.add(member.name)
                    yield Binding("entity", member, scope)


def _listed_entities(module: Module) -> Iterator[NameExpr]:
    """Yield the names in the declarations ``entity a, b`` of a module."""
    for declaration in module.declarations:
        if isinstance(declaration, EntityDecl):
            yield from declaration.names


def _declare(scope: Scope, binding: Binding) -> Diagnostic | None:
    name = binding.name
    if (
        name in FUNCTIONS
        and isinstance(binding.declaration, (SignalDecl, PredicateDecl, LetDecl))
        and binding.declaration.parameters
    ):
        return problem(
            "TLT0212",
            f"`{name}` is a function of the language",
            scope.source,
            binding.span,
            advice=f"choose another name, e.g. `{name}_of`",
        ).diagnostic
    known = scope.names.get(name)
    if known and not (known.kind == binding.kind and binding.kind in ("signal", "param")):
        return problem(
            "TLT0202",
            f"`{name}` is declared twice",
            scope.source,
            binding.span,
            "declared again here",
            advice="remove one of the two, or rename it",
            related=(Label(scope.source, known.span, "first declared here"),),
        ).diagnostic
    scope.names.setdefault(name, binding)
    return None


def _add_imported_name(scope: Scope, name: str, binding: Binding, span: Span) -> Diagnostic | None:
    known = scope.names.setdefault(name, binding)
    if known.declaration is binding.declaration or (known.kind == binding.kind and binding.kind in _MERGED):
        return None
    if known.via is None:
        return problem(
            "TLT0202",
            f"`{name}` is declared twice",
            scope.source,
            known.span,
            "declared here",
            advice=f"rename it, or give the other one a prefix: `{_aliased_import(binding.via)}`",
            related=(Label(binding.scope.source, binding.span, f"also declared in {binding.via}"),),
        ).diagnostic
    return problem(
        "TLT0203",
        f"both {known.via} and {binding.via} offer `{name}`",
        scope.source,
        span,
        advice=f"give the names of one import a prefix, e.g. `{_aliased_import(binding.via)}`",
        related=(
            Label(known.scope.source, known.span, f"the one from {known.via}"),
            Label(binding.scope.source, binding.span, f"the one from {binding.via}"),
        ),
    ).diagnostic


def _not_offered_error(
    scope: Scope, imported_name: NameExpr, library: str, offered: Mapping[str, Binding]
) -> Diagnostic | None:
    suggestion = likely_name(imported_name.name, offered)
    hint = f"did you mean `{suggestion}`?" if suggestion else ""
    fixes = (replacement_fix(scope.source, imported_name.span, suggestion),) if suggestion else ()
    title = f"{library} does not offer `{imported_name.name}`"
    return problem("TLT0205", title, scope.source, imported_name.span, hint, fixes=fixes).diagnostic


def _aliased_import(target: str | None) -> str:
    """Return an import statement with a short alias: ``import stealth as st`` for ``stealth``."""
    target = target or ""
    letters = "".join(c for c in target.rsplit("/", 1)[-1] if c.isascii() and c.isalpha())[:2].lower()
    target_text = f'"{target}"' if "/" in target or target.endswith(".tltl") else target
    # `or` is the only reserved word of two letters.
    return f"import {target_text} as {letters if len(letters) == 2 and letters != 'or' else 'lib'}"
