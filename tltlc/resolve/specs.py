"""Resolve specs: turn clauses such as ``reach`` into one formula, and read settings such as ``limit``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Literal, cast

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label, replacement_fix
from tltlc.expression.tree import Expression, nodes
from tltlc.expression.tree import ParamValue as ParamNode
from tltlc.expression.tree import SignalValue as SignalNode
from tltlc.grammar.tree import Clause, Expr, NameExpr, NumberExpr, SpecDecl
from tltlc.grammar.walk import conjuncts, operands
from tltlc.logic.formula import Formula, always, and_, eventually, not_, then
from tltlc.resolve.constants import samples
from tltlc.resolve.context import Context
from tltlc.resolve.enums import exclusive_values
from tltlc.resolve.formulas import formula
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.spec import Conjunct, JudgeMode, Spec, Vocabulary
from tltlc.resolve.values import Env

_ONCE = ("level", "limit", "judge", "semantics")


def resolve_spec(declaration: SpecDecl, groups: tuple[tuple[str, ...], ...], env: Env) -> Spec | None:
    """Return the resolved spec, or None if a clause is in error or no clause has a formula.

    Every clause in error is reported to the log.

    ``groups`` has the names of the atoms of each ``exclusive`` declaration. The groups that share
    at least two atoms with the formula become part of the spec.
    """
    log, source = env.context.log, env.scope.source
    parts: list[Conjunct] = []
    metadata: dict[str, Clause] = {}
    tags: dict[str, None] = {}
    complete = True
    for clause in declaration.clauses:
        try:
            if clause.kind in _READERS:
                parts.extend(_conjuncts(clause, env))
            elif clause.kind == "tag":
                tags.update(dict.fromkeys(tag.name for tag in cast("tuple[NameExpr, ...]", clause.value)))
            else:
                _store_metadata(clause, metadata, env)
        except ResolutionError as failure:
            log.add(failure.diagnostic)
            complete = False
    limit = None
    try:
        limit = _limit(metadata.get("limit"), env)
    except ResolutionError as failure:
        log.add(failure.diagnostic)
        complete = False
    if not complete or not parts:
        return None
    conjunction = and_(*(part.formula for part in parts))
    words = vocabulary(conjunction.atoms(), groups, env.context)
    return Spec(
        name=declaration.name,
        doc=declaration.doc,
        formula=conjunction,
        parts=tuple(parts),
        atoms=words.atoms,
        signals=words.signals,
        params=words.params,
        exclusive=words.exclusive,
        level=_word(metadata.get("level")),
        limit_steps=limit,
        judge=cast("JudgeMode | None", _word(metadata.get("judge"))),
        semantics=cast(Literal["finite", "infinite"], _word(metadata.get("semantics")) or "finite"),
        tags=tuple(tags),
        clock_s=words.clock_s,
        source=source,
        name_span=declaration.name_span,
    )


def vocabulary(used: Iterable[str], groups: Iterable[Sequence[str]], context: Context) -> Vocabulary:
    """Return the atoms with the names ``used``, and the signals, params and groups that belong to them.

    ``groups`` has the names of the atoms of each ``exclusive`` declaration. A group belongs to the atoms
    if ``used`` names at least two of its atoms; then the others are returned, too. Atoms that compare
    one signal with different values, such as ``mode is idle`` and ``mode is alert``, are a group, too.
    """
    used = list(used)
    exclusive: list[Sequence[str]] = [group for group in groups if len(set(group).intersection(used)) > 1]
    names = list(dict.fromkeys([*used, *(name for group in exclusive for name in group)]))
    exclusive += exclusive_values(names, exclusive, context.values_of_signals)
    atoms = tuple(context.atoms[name] for name in names)
    variables = [node for atom in atoms for node in _variables(atom.expression)]
    return Vocabulary(
        atoms=atoms,
        signals=tuple(dict.fromkeys(context.signals[node.name] for node in variables if isinstance(node, SignalNode))),
        params=tuple(dict.fromkeys(context.params[node.name] for node in variables if isinstance(node, ParamNode))),
        exclusive=tuple(tuple(sorted(names.index(name) for name in group)) for group in exclusive),
        clock_s=context.clock_s,
    )


def _conjuncts(clause: Clause, env: Env) -> list[Conjunct]:
    """Return the conjuncts of a clause, each with the bounds in the clause and its formula without bounds."""
    read = _READERS[clause.kind]
    before = len(env.context.bounds)
    parts = read(clause, env)
    if not env.context.bounds:
        return parts
    bounds = tuple(env.context.bounds[before:])
    unbounded = [part.formula for part in read(clause, replace(env, unbounded=True))]
    return [
        replace(part, bounds=bounds, unbounded=unbounded_formula if unbounded_formula is not part.formula else None)
        for part, unbounded_formula in zip(parts, unbounded, strict=True)
    ]


def _reach(clause: Clause, env: Env) -> list[Conjunct]:
    # Resolve in the order written, so that the first error is the one reported.
    *before, result = [formula(operand, env) for operand in operands(_expression(clause), "then")]
    if not before:
        result = eventually(result)
    for goal in reversed(before):
        result = then(goal, result)
    return [_conjunct(result, clause, env)]


def _keep(clause: Clause, env: Env) -> list[Conjunct]:
    return [_conjunct(always(formula(_expression(clause), env)), clause, env)]


def _avoid(clause: Clause, env: Env) -> list[Conjunct]:
    return [_conjunct(always(not_(formula(_expression(clause), env))), clause, env)]


def _require(clause: Clause, env: Env) -> list[Conjunct]:
    return [Conjunct(formula(e, env), env.scope.source, e.span) for e in conjuncts(_expression(clause))]


_READERS: dict[str, Callable[[Clause, Env], list[Conjunct]]] = {
    "reach": _reach,
    "keep": _keep,
    "avoid": _avoid,
    "require": _require,
}


def _expression(clause: Clause) -> Expr:
    assert not isinstance(clause.value, tuple)
    return clause.value


def _conjunct(conjunct: Formula, clause: Clause, env: Env) -> Conjunct:
    return Conjunct(conjunct, env.scope.source, clause.span)


def _store_metadata(clause: Clause, metadata: dict[str, Clause], env: Env) -> None:
    """Store a clause that sets an option of the spec, such as ``limit``, in ``metadata`` under its keyword.

    Raises ResolutionError (TLT0214) if there is already a clause with this keyword.
    """
    source = env.scope.source
    if clause.kind in metadata:
        raise problem(
            "TLT0214",
            f"this spec has two `{clause.kind}` clauses",
            source,
            clause.span,
            advice="keep one of the two",
            related=(Label(source, metadata[clause.kind].span, "the first one"),),
        )
    metadata[clause.kind] = clause


def _limit(clause: Clause | None, env: Env) -> int | None:
    if clause is None:
        return None
    assert isinstance(clause.value, NumberExpr)
    if clause.value.unit is None:
        digits = env.scope.source.slice(clause.value.span)
        advice = f"write `{digits} steps` or, with a clock, `{digits} s`"
        units = ("steps",) if env.context.clock_s is None else ("steps", "s")
        fixes = tuple(replacement_fix(env.scope.source, clause.value.span, f"{digits} {unit}") for unit in units)
        title, place = "a limit needs a unit", clause.value.span
        raise problem("TLT0312", title, env.scope.source, place, advice=advice, fixes=fixes)
    steps = samples(clause.value, env)
    if steps < 1:
        title, advice = "a limit must be at least one step", "write e.g. `limit 400 steps`"
        raise problem("TLT0312", title, env.scope.source, clause.value.span, advice=advice)
    return steps


def _word(clause: Clause | None) -> str | None:
    return clause.value.name if clause is not None and isinstance(clause.value, NameExpr) else None


def _variables(expression: Expression) -> list[SignalNode | ParamNode]:
    """Return the signals and params of an expression, in order of appearance."""
    return [node for node in nodes(expression) if isinstance(node, (SignalNode, ParamNode))]
