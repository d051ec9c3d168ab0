"""Resolve a syntax tree: find out what every name, type and unit in it means."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar.allow_index import drop_silenced
from tltlc.grammar.module import Module
from tltlc.grammar.parser import parse_formula
from tltlc.grammar.tree import ExclusiveDecl, Expr, SpecDecl, TestDecl
from tltlc.logic.formula import Formula
from tltlc.resolve import formulas, predicates
from tltlc.resolve.context import Context
from tltlc.resolve.declarations import declare
from tltlc.resolve.groups import check_group
from tltlc.resolve.imports import LoadedModule, load
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.predicate_checks import check_predicates
from tltlc.resolve.problem import Log, ResolutionError, problem
from tltlc.resolve.scope import Scope, build_scopes
from tltlc.resolve.spec import ResolvedFile, Spec, Vocabulary
from tltlc.resolve.spec_tests import resolve_test
from tltlc.resolve.specs import resolve_spec, vocabulary
from tltlc.resolve.unknown_types import with_meant_types
from tltlc.resolve.values import Env

FormulaOf = Callable[[Expr], "Formula | None"]
"""A function that returns the formula of an expression, or None if it is not a formula."""


@record
class Resolution:
    """The result of resolution: the program, its environment, its modules and the diagnostics.

    ``env`` holds all declarations that are visible in the module. ``modules`` has the imported
    modules before the modules that import them, and the module itself last.
    """

    program: ResolvedFile
    env: Env
    modules: tuple[LoadedModule, ...]
    diagnostics: tuple[Diagnostic, ...]


def resolve(module: Module, options: ResolveOptions | None = None) -> Resolution:
    """Return what a module resolves to: its specs and tests, names, modules and diagnostics.

    Reads the files that the module imports. Never raises on bad input: everything in error is
    reported and left out.
    """
    options = options or ResolveOptions()
    env, groups, modules = _declare_names(module, options)
    context, scope = env.context, env.scope
    specs = _specs(scope, groups, env)
    tests = [
        resolve_test(declaration, specs, env)
        for declaration in scope.module.declarations
        if isinstance(declaration, TestDecl)
    ]
    _check_unused(scope, env)
    if options.proofs:
        check_predicates(context)
    program = ResolvedFile(
        tuple(resolved for resolved in specs.values() if resolved is not None),
        tuple(test for test in tests if test is not None),
        vocabulary([name for group in groups for name in group], groups, context),
    )
    return Resolution(program, env, modules, context.log.diagnostics())


def resolve_atoms(
    module: Module, texts: Sequence[SourceFile], options: ResolveOptions | None = None
) -> tuple[Vocabulary | None, FormulaOf, tuple[Diagnostic, ...]]:
    """Find the atoms of a module that texts from elsewhere name, such as the labels of an imported automaton.

    Each of the ``texts`` is a formula of one atom, such as ``near(s1, close = 3 m)``, or the name of an
    atom that the module's specs use: ``near(s1, close=3)``. Returns three things:

    - the atoms with the signals and params that they use; None if the module or a text is in error,
      or if two texts name the same atom;
    - a function that resolves further formulas without reporting anything;
    - the diagnostics, without those that an ``allow`` comment silences.
    """
    env, groups, modules = _declare_names(module, options or ResolveOptions())
    context = env.context
    expressions: list[Expr] = []

    def formula_of(expression: Expr) -> Formula | None:
        # The context refers to expressions by identity, so they must live as long as the context.
        expressions.append(expression)
        return formulas.known_formula(expression, env)

    if context.log.diagnostics():
        return None, formula_of, context.log.diagnostics()
    own_log, context.log = context.log, Log()
    _specs(env.scope, groups, env)
    context.log = own_log
    places: dict[str, Label] = {}
    for source in texts:
        try:
            name, here = _atom(source, env, expressions)
            if name in places:
                title, advice = f"`{name}` is used twice", "give each atom a predicate of its own"
                raise problem("TLT0655", title, source, here.span, advice=advice, related=(places[name],))
            places[name] = here
        except ResolutionError as failure:
            context.log.add(failure.diagnostic)
    check_predicates(context)
    diagnostics = drop_silenced((loaded.module for loaded in modules), context.log.diagnostics())
    return vocabulary(places, groups, context) if len(places) == len(texts) else None, formula_of, diagnostics


def _atom(source: SourceFile, env: Env, expressions: list[Expr]) -> tuple[str, Label]:
    """Return the name of the atom that a text stands for, and a label for its place in the text.

    The parsed text is added to ``expressions``. Raises ResolutionError if the text is no atom.
    """
    text = source.text.strip()
    start = source.text.find(text)
    here = Label(source, Span(start, start + len(text)))
    name = " ".join(text.split())
    if name in env.context.atoms:
        return name, here
    expression, problems = parse_formula(source)
    for diagnostic in problems:
        if diagnostic.severity == "error":
            raise ResolutionError(diagnostic)
        env.context.log.add(diagnostic)
    assert expression is not None
    expressions.append(expression)
    atom = formulas.formula(expression, replace(env, scope=replace(env.scope, module=Module(source, (), ()))))
    if atom.op != "atom":
        title, advice = "this is not an atom", "use a predicate, a `bool` signal or a comparison with `<` or `>`"
        raise problem("TLT0655", title, source, here.span, advice=advice)
    return atom.name, here


def _declare_names(
    module: Module, options: ResolveOptions
) -> tuple[Env, tuple[tuple[str, ...], ...], tuple[LoadedModule, ...]]:
    """Load a module with its imports, and enter all declarations.

    Return the environment of the module, the groups of atoms that it and its imports declare
    ``exclusive``, and all loaded modules. The context of the environment has the diagnostics.
    """
    context = Context(unfolded=options.unfolded)
    module = with_meant_types(module, context.log)
    modules = load(module, options, context.log)
    scopes = build_scopes(modules, context.log)
    declare(scopes, options, context)
    return Env(context, scopes[-1]), tuple(group for scope in scopes for group in _exclusive(scope, context)), modules


def _exclusive(scope: Scope, context: Context) -> list[tuple[str, ...]]:
    """Return, for each ``exclusive`` declaration of a module, the names of its atoms; log errors."""
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
    for atom_expr in declaration.atoms:
        atom = formulas.formula(atom_expr, env)
        if atom.op != "atom":
            title = "`exclusive` can list only atoms"
            advice = "use predicates, `bool` signals or comparisons with `<` or `>`"
            raise problem("TLT0316", title, env.scope.source, atom_expr.span, advice=advice)
        names[atom.name] = None
    if len(names) < 2:
        title = "`exclusive` needs at least two different atoms"
        raise problem(
            "TLT0316", title, env.scope.source, declaration.span, advice="add another atom, or leave out `exclusive`"
        )
    return tuple(names)


def _specs(scope: Scope, groups: tuple[tuple[str, ...], ...], env: Env) -> dict[str, Spec | None]:
    specs: dict[str, Spec | None] = {}
    places: dict[str, SpecDecl] = {}
    for declaration in scope.module.declarations:
        if not isinstance(declaration, SpecDecl):
            continue
        name = declaration.name
        resolved = resolve_spec(declaration, groups, env)
        # Spec names become file names, and some file systems ignore case.
        earlier = places.setdefault(name.lower(), declaration)
        if earlier is declaration:
            specs[name] = resolved
            continue
        title = f"the specs `{earlier.name}` and `{name}` would have the same file names"
        messages = ("differs only in capital letters", "the other spec")
        if earlier.name == name:
            title = f"the spec `{name}` is declared twice"
            messages = ("declared again here", "first declared here")
        error = problem(
            "TLT0202",
            title,
            scope.source,
            declaration.name_span,
            messages[0],
            advice="rename one of the two",
            related=(Label(scope.source, earlier.name_span, messages[1]),),
        )
        env.context.log.add(error.diagnostic)
    return specs


def _check_unused(scope: Scope, env: Env) -> None:
    """Check the module's own predicates, ``let`` definitions and groups, used or not; log errors."""
    for binding in scope.names.values():
        if binding.scope is not scope:
            continue
        try:
            if binding.kind == "predicate":
                predicates.check_unused(binding, env)
            elif binding.kind == "let":
                formulas.check_unused(binding, replace(env, local={}))
            elif binding.kind == "group":
                check_group(binding, env)
        except ResolutionError as failure:
            env.context.log.add(failure.diagnostic)
