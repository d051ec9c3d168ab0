"""From a syntax tree to a program: every name, type and unit settled."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tltlc.core.record import record, replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar.allow_index import unsilenced
from tltlc.grammar.parser import parse_formula
from tltlc.grammar.tree import ExclusiveDecl, Expr, Module, SpecDecl, TestDecl
from tltlc.logic.formula import Formula
from tltlc.resolve import formulas, predicates
from tltlc.resolve.checks import check_predicates
from tltlc.resolve.context import Context
from tltlc.resolve.declarations import declare
from tltlc.resolve.imports import Loaded, load
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.problem import Log, ResolutionError, problem
from tltlc.resolve.scope import Scope, build_scopes
from tltlc.resolve.spec import Program, Spec, Vocabulary
from tltlc.resolve.specs import spec, vocabulary
from tltlc.resolve.tests import resolved_test
from tltlc.resolve.values import Env

FormulaOf = Callable[[Expr], "Formula | None"]
"""The formula that an expression stands for, None where it stands for none."""


@record
class Resolution:
    """A program, what its module sees (``env``), the modules it is made of (itself last), and what is to be said."""

    program: Program
    env: Env
    modules: tuple[Loaded, ...]
    diagnostics: tuple[Diagnostic, ...]


def resolve(module: Module, options: ResolveOptions | None = None) -> tuple[Program, tuple[Diagnostic, ...]]:
    """The specs and tests of a module that resolve, and everything that is to be said about it.

    Reads the files that it imports.  Never raises on bad input: what is in error is reported and left out.
    """
    found = resolution(module, options)
    return found.program, found.diagnostics


def resolution(module: Module, options: ResolveOptions | None = None) -> Resolution:
    """As :func:`resolve`, with the scope and the modules, for tools that look at expressions and names themselves."""
    options = options or ResolveOptions()
    env, groups, modules = _declared(module, options)
    context, scope = env.context, env.scope
    specs = _specs(scope, groups, env)
    tests = [
        resolved_test(declaration, specs, env)
        for declaration in scope.module.declarations
        if isinstance(declaration, TestDecl)
    ]
    _check_unused(scope, env)
    if options.proofs:
        check_predicates(context)
    program = Program(
        tuple(found for found in specs.values() if found is not None),
        tuple(found for found in tests if found is not None),
        vocabulary([name for group in groups for name in group], groups, context),
    )
    return Resolution(program, env, modules, context.log.all())


def resolve_atoms(
    module: Module, written: Sequence[SourceFile], options: ResolveOptions | None = None
) -> tuple[Vocabulary | None, FormulaOf, tuple[Diagnostic, ...]]:
    """The atoms that texts elsewhere stand for, in the words of a module, and what is to be said and is not allowed.

    A text is a formula that is an atom, or the name that an atom of the module's own specs has, which says no units.
    None where the module or a text is in error, and where two are one atom.  Further formulas can be read, of which
    nothing is said.
    """
    env, groups, modules = _declared(module, options or ResolveOptions())
    context = env.context
    kept: list[Expr] = []

    def formula_of(expression: Expr) -> Formula | None:
        # The context knows expressions by their identity, so they must live as long as it does.
        kept.append(expression)
        try:
            return formulas.formula(expression, env)
        except ResolutionError:
            return None

    if context.log.all():
        return None, formula_of, context.log.all()
    own, context.log = context.log, Log()
    _specs(env.scope, groups, env)
    context.log = own
    found: dict[str, Label] = {}
    for source in written:
        try:
            name, here = _atom(source, env, kept)
            if name in found:
                title, advice = f"`{name}` stands here twice", "give each atom a predicate of its own"
                raise problem("TLT0655", title, source, here.span, advice=advice, other=(found[name],))
            found[name] = here
        except ResolutionError as failure:
            context.log.add(failure.diagnostic)
    check_predicates(context)
    said = unsilenced((loaded.module for loaded in modules), context.log.all())
    return vocabulary(found, groups, context) if len(found) == len(written) else None, formula_of, said


def _atom(source: SourceFile, env: Env, kept: list[Expr]) -> tuple[str, Label]:
    """The name of the atom that a text stands for, and where it stands; raises ResolutionError where it is none."""
    text = source.text.strip()
    start = source.text.find(text)
    here = Label(source, Span(start, start + len(text)))
    name = " ".join(text.split())
    if name in env.context.atoms:
        return name, here
    expression, problems = parse_formula(source)
    for each in problems:
        if each.severity == "error":
            raise ResolutionError(each)
        env.context.log.add(each)
    assert expression is not None
    kept.append(expression)
    found = formulas.formula(expression, replace(env, scope=replace(env.scope, module=Module(source, (), ()))))
    if found.op != "atom":
        title, advice = "this is no atom", "name a predicate, a `bool` signal or a comparison with `<` or `>`"
        raise problem("TLT0655", title, source, here.span, advice=advice)
    return found.name, here


def _declared(module: Module, options: ResolveOptions) -> tuple[Env, tuple[tuple[str, ...], ...], tuple[Loaded, ...]]:
    """What a module sees, itself and by its imports, the groups of ``exclusive``, and these modules."""
    context = Context()
    modules = load(module, options, context.log)
    scopes = build_scopes(modules, context.log)
    declare(scopes, options, context)
    return Env(context, scopes[-1]), tuple(group for each in scopes for group in _exclusive(each, context)), modules


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
