"""From a syntax tree to a program: every name, type and unit settled."""

from __future__ import annotations

from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar.tree import ExclusiveDecl, Module, SpecDecl, TestDecl
from tltlc.record import replace
from tltlc.resolve import formulas, predicates
from tltlc.resolve.checks import check_predicates
from tltlc.resolve.context import Context
from tltlc.resolve.declarations import declare
from tltlc.resolve.imports import load
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.scope import Scope, build_scopes
from tltlc.resolve.spec import Program, Spec
from tltlc.resolve.specs import spec
from tltlc.resolve.tests import resolved_test
from tltlc.resolve.values import Env


def resolve(module: Module, options: ResolveOptions | None = None) -> tuple[Program, tuple[Diagnostic, ...]]:
    """The specs and tests of a module that resolve, and everything that is to be said about it.

    Reads the files that it imports.  Never raises on bad input: what is in error is reported and left out.
    """
    options = options or ResolveOptions()
    context = Context()
    loaded = load(module, options, context.log)
    scopes = build_scopes(loaded, context.log)
    declare(scopes, options, context)
    scope = scopes[-1]
    env = Env(context, scope)
    groups = tuple(group for each in scopes for group in _exclusive(each, context))
    specs = _specs(scope, groups, env)
    tests = [
        resolved_test(declaration, specs, env)
        for declaration in scope.module.declarations
        if isinstance(declaration, TestDecl)
    ]
    _check_unused(scope, env)
    check_predicates(context)
    program = Program(
        tuple(found for found in specs.values() if found is not None),
        tuple(found for found in tests if found is not None),
    )
    return program, context.log.all()


def _exclusive(scope: Scope, context: Context) -> list[tuple[str, ...]]:
    """The names of the atoms of each ``exclusive`` of a module."""
    env = Env(context, scope)
    groups = []
    for declaration in scope.module.declarations:
        if isinstance(declaration, ExclusiveDecl):
            try:
                groups.append(_group(declaration, env))
            except ResolutionError as failure:
                context.log.add(failure.diagnostic)
    return groups


def _group(declaration: ExclusiveDecl, env: Env) -> tuple[str, ...]:
    names: dict[str, None] = {}
    for written in declaration.atoms:
        found = formulas.formula(written, env)
        if found.op != "atom":
            title = "`exclusive` lists atoms"
            advice = "name predicates, `bool` signals or comparisons with `<` or `>`"
            raise problem("TLT0316", title, env.scope.source, written.span, advice=advice)
        names[found.name] = None
    if len(names) < 2:
        title = "`exclusive` needs at least two different atoms"
        raise problem("TLT0316", title, env.scope.source, declaration.span, advice="name another one, or leave it out")
    return tuple(names)


def _specs(scope: Scope, groups: tuple[tuple[str, ...], ...], env: Env) -> dict[str, Spec | None]:
    found: dict[str, Spec | None] = {}
    places: dict[str, SpecDecl] = {}
    for declaration in scope.module.declarations:
        if not isinstance(declaration, SpecDecl):
            continue
        name = declaration.name
        resolved = spec(declaration, groups, env)
        # The names of specs are names of files, and some file systems do not tell capitals apart.
        earlier = places.setdefault(name.lower(), declaration)
        if earlier is declaration:
            found[name] = resolved
            continue
        title = f"`{earlier.name}` and `{name}` would share their files"
        remarks = ("differs in capitals only", "the other spec")
        if earlier.name == name:
            title = f"the spec `{name}` is declared twice"
            remarks = ("declared again here", "first declared here")
        twice = problem(
            "TLT0202",
            title,
            scope.source,
            declaration.name_span,
            remarks[0],
            advice="rename one of the two",
            other=(Label(scope.source, earlier.name_span, remarks[1]),),
        )
        env.context.log.add(twice.diagnostic)
    return found


def _check_unused(scope: Scope, env: Env) -> None:
    """The module's own predicates and lets that nothing has used must be right as well."""
    for binding in scope.names.values():
        if binding.scope is not scope:
            continue
        try:
            if binding.kind == "predicate":
                predicates.check_unused(binding, env)
            elif binding.kind == "let":
                formulas.check_unused(binding, replace(env, local={}))
        except ResolutionError as failure:
            env.context.log.add(failure.diagnostic)
