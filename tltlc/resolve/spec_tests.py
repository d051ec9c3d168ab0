"""Resolve ``test`` blocks: traces of truth values of atoms and of numbers, and what a spec must say of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, cast

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import replacement_fix
from tltlc.grammar.builder import MOST_REPETITIONS
from tltlc.grammar.tree import Expr, GroupExpr, TestDecl, TestExpect, TestStep, Unary
from tltlc.grammar.typos import likely_name
from tltlc.grammar.walk import conjuncts
from tltlc.resolve.constants import samples, seconds
from tltlc.resolve.formulas import formula
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.registers import following_atoms
from tltlc.resolve.set_numbers import is_setting, settings_of
from tltlc.resolve.sources import sources
from tltlc.resolve.spec import Expect, RepeatedSample, Spec, Test
from tltlc.resolve.values import Env


def resolve_test(declaration: TestDecl, specs: dict[str, Spec | None], env: Env) -> Test | None:
    """Return the resolved test, or None if the test or its spec is in error.

    ``specs`` maps the name of every spec of the file to the spec, or to None if it is in error. Errors
    of the test are logged.
    """
    context, source = env.context, env.scope.source
    name = declaration.spec.name
    if name not in specs:
        suggestion = likely_name(name, specs)
        hint = f"did you mean `{suggestion}`?" if suggestion else ""
        listed = ", ".join(f"`{spec_name}`" for spec_name in specs)
        known = f"the {'specs are' if len(specs) > 1 else 'only spec is'} {listed}"
        advice = None if suggestion else known if specs else f"declare it: `spec {name} {{ … }}`"
        title, place = f"no spec `{name}` here", declaration.spec.span
        fixes = (replacement_fix(source, place, suggestion),) if suggestion else ()
        context.log.add(problem("TLT0208", title, source, place, hint, advice=advice, fixes=fixes).diagnostic)
        return None
    spec = specs[name]
    if spec is None:
        return None
    items: list[RepeatedSample | Expect] = []
    complete = True
    try:
        settings = settings_of(declaration, spec, env)
    except ResolutionError as failure:
        context.log.add(failure.diagnostic)
        return None
    numbers: dict[str, float] = {}
    for item in declaration.items:
        try:
            if isinstance(item, TestStep):
                numbers |= settings.values[item]
                items.append(_step(item, dict(numbers), settings.computed, spec, env))
            else:
                items.append(_expect(item, env))
        except ResolutionError as failure:
            context.log.add(failure.diagnostic)
            complete = False
    if complete and not any(isinstance(item, Expect) for item in items):
        advice = "add an `expect`, e.g. `expect satisfied`: without one, the test cannot fail"
        where = declaration.spec.span
        context.log.add(problem("TLT0217", "this test expects nothing", source, where, advice=advice).diagnostic)
        return None
    return Test(declaration.title, name, tuple(items), source, declaration.span) if complete else None


def _step(
    item: TestStep, numbers: Mapping[str, float], computed: frozenset[str], spec: Spec, env: Env
) -> RepeatedSample:
    source = env.scope.source
    names = {_without_spaces(atom.name): atom.name for atom in spec.atoms}
    following = following_atoms(spec.atoms, spec.registers)
    values: dict[str, bool] = {}
    for literal_expr in (part for atom in item.atoms if not is_setting(atom) for part in conjuncts(atom)):
        name, holds = _literal(literal_expr, names, env)
        if _without_spaces(name) not in names:
            given = [f"`{atom.name}`" for atom in spec.atoms if atom.name not in following]
            known = ", ".join(given) or "no atoms"
            verb = "has" if not given else "has the atoms" if len(given) > 1 else "has only the atom"
            title = f"the spec `{spec.name}` does not use `{name}`"
            advice = f"the spec {verb} {known}"
            if any(signal.name == name for signal in spec.signals):
                advice = f"predicates read it: write `{name} = {str(holds).lower()}`"
            raise problem("TLT0209", title, source, literal_expr.span, advice=advice)
        if name in computed:
            title = f"`{name}` follows from the numbers of this test: a step cannot choose it"
            raise problem("TLT0218", title, source, literal_expr.span, advice="leave it out")
        if name in following:
            raise _following_atom_error(name, spec, source, literal_expr.span)
        if values.setdefault(name, holds) != holds:
            raise problem(
                "TLT0217",
                f"`{name}` cannot hold and not hold in the same step",
                source,
                literal_expr.span,
                advice="leave one out",
            )
    times, dt_s = _length(item, env)
    return RepeatedSample(times, frozenset(name for name, holds in values.items() if holds), numbers, dt_s)


def _length(item: TestStep, env: Env) -> tuple[int, float]:
    """Return how many samples a ``step`` takes, and the seconds before each of them, 0 on a fixed clock.

    On a fixed clock, ``step for 2 s a`` takes as many samples as the game takes in 2 s. On a clock that
    varies, it takes one sample, 2 s after the sample before. Raises ResolutionError: TLT0312, TLT0313
    or TLT0323 the length is no time, or has no clock; TLT0217 it takes too many samples.
    """
    length = item.length
    if length is None:
        return item.times, 0.0
    if env.context.clock_varies:
        return item.times, seconds(length, "for 2 s", env)
    times = item.times * samples(length, env)
    if not 0 < times <= MOST_REPETITIONS:
        title = f"this step would take {times:,} samples"
        advice = "write a time above 0" if times == 0 else "write a shorter time"
        raise problem("TLT0217", title, env.scope.source, length.span, advice=advice)
    return times, 0.0


def _following_atom_error(name: str, spec: Spec, source: SourceFile, span: Span) -> ResolutionError:
    """Return the error for a ``step`` that names an atom which the monitor computes from others."""
    given = [f"`{atom}`" for atom in sources(name, spec.atoms, spec.registers)]
    title = f"`{name}` follows from the steps so far: a test cannot choose it"
    advice = f"leave it out, and say in each step whether {' and '.join(given)} hold{'s' * (len(given) == 1)}"
    return problem("TLT0218", title, source, span, advice=advice if given else "leave it out")


def _literal(literal_expr: Expr, names: Mapping[str, str], env: Env) -> tuple[str, bool]:
    """Return the name of the atom in a literal, and whether the literal says that the atom holds.

    ``not near(s1)`` gives ``("near(s1)", False)``. The atom may be written as a formula
    (``near(s1, close = 3 m)``) or by its name (``near(s1, close=3)``). ``names`` maps the names of the
    spec's atoms, without spaces, to the names. Raises ResolutionError (TLT0316) if it is no literal.
    """
    holds, inner = True, literal_expr
    while isinstance(inner, GroupExpr) or (isinstance(inner, Unary) and inner.op == "not"):
        inner, holds = (inner.inner, holds) if isinstance(inner, GroupExpr) else (inner.operand, not holds)
    name = names.get(_without_spaces(env.scope.source.text[inner.span.start : inner.span.end]))
    if name is not None:
        return name, holds
    literal = formula(inner, env)
    while literal.op == "not":
        literal, holds = literal.args[0], not holds
    if literal.op != "atom":
        advice = "use predicates, `bool` signals or comparisons, each with or without `not`"
        raise problem("TLT0316", "a `step` can contain only atoms", env.scope.source, literal_expr.span, advice=advice)
    return literal.name, holds


def _without_spaces(text: str) -> str:
    return "".join(text.split())


def _expect(item: TestExpect, env: Env) -> Expect:
    source = env.scope.source
    if item.kind == "progress" and not (isinstance(item.value, (int, float)) and 0 <= item.value <= 1):
        advice = "write a number from 0 to 1, or a percentage such as `50 %`"
        raise problem("TLT0217", "progress lies in [0, 1]", source, item.span, advice=advice)
    kind = cast(Literal["verdict", "progress", "state"], item.kind)
    return Expect(kind, item.value, item.comparison, source, item.span)
