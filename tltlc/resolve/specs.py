"""Resolve specs: turn clauses such as ``reach`` into one formula, and read settings such as ``limit``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import prod
from typing import Final, Literal, cast

from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Label, replacement_fix
from tltlc.expression.tree import Expression, nodes
from tltlc.expression.tree import ParamValue as ParamNode
from tltlc.expression.tree import SignalValue as SignalNode
from tltlc.grammar.tree import BinaryExpr, Clause, Expr, NameExpr, NumberExpr, SpecDecl
from tltlc.grammar.walk import conjuncts
from tltlc.grammar.whole_clauses import showing_clause
from tltlc.logic.formula import Formula, always, and_, bound_of, eventually, not_
from tltlc.logic.text.one_line import OneLinePrinter
from tltlc.logic.text.style import STYLES
from tltlc.resolve.bounds import no_timer_error
from tltlc.resolve.breaches import with_breaches
from tltlc.resolve.constants import samples
from tltlc.resolve.context import Context
from tltlc.resolve.deadlines import rules_from_start, with_timers
from tltlc.resolve.elapsed import ElapsedTimers
from tltlc.resolve.enums import exclusive_values
from tltlc.resolve.formulas import with_bounds
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.registers import memory_of
from tltlc.resolve.spec import Atom, Conjunct, JudgeMode, Spec, Vocabulary
from tltlc.resolve.timed_deadlines import with_elapsed_timers
from tltlc.resolve.timers import Timers
from tltlc.resolve.unfolding import bounded_parts, unfold
from tltlc.resolve.values import Env

_MOST_HINTS: Final = 20
"""The most errors of which the whole clause is read again."""
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
    env.context.limit_text = _time_limit(declaration, source)
    for clause in declaration.clauses:
        try:
            if clause.kind in _READERS:
                parts.extend(_conjuncts(clause, env))
            elif clause.kind == "tag":
                tags.update(dict.fromkeys(tag.name for tag in cast("tuple[NameExpr, ...]", clause.value)))
            else:
                _store_metadata(clause, metadata, env)
        except ResolutionError as failure:
            log.add(_in_whole(failure.diagnostic, clause, source) if len(log) < _MOST_HINTS else failure.diagnostic)
            complete = False
    limit = None
    try:
        limit = _limit(metadata.get("limit"), env)
    except ResolutionError as failure:
        log.add(failure.diagnostic)
        complete = False
    if not complete or not parts:
        return None
    try:
        parts = _without_bounds(parts, env, unfolds=declaration.name in env.context.unfolded)
    except ResolutionError as failure:
        log.add(failure.diagnostic)
        return None
    conjunction = and_(*(part.formula for part in parts))
    words = vocabulary(conjunction.atoms(), groups, env.context)
    if words.registers:
        parts = with_breaches(parts, env.context)
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
        registers=words.registers,
        clock_varies=words.clock_varies,
    )


def vocabulary(used: Iterable[str], groups: Iterable[Sequence[str]], context: Context) -> Vocabulary:
    """Return the atoms with the names ``used``, and the signals, params and groups that belong to them.

    ``groups`` has the names of the atoms of each ``exclusive`` declaration. A group belongs to the atoms
    if ``used`` or the registers name at least two of its atoms; then the others are returned, too. Atoms
    that compare one signal with different values, such as ``mode is idle`` and ``mode is alert``, are a
    group, too.
    """
    used = list(used)
    used += (atom.name for atom in memory_of(_atoms(used, context), context.registers, context.atoms).atoms)
    exclusive: list[Sequence[str]] = [group for group in groups if len(set(group).intersection(used)) > 1]
    names = list(dict.fromkeys([*used, *(name for group in exclusive for name in group)]))
    memory = memory_of(_atoms(names, context), context.registers, context.atoms)
    names = list(dict.fromkeys([*names, *(atom.name for atom in memory.atoms)]))
    exclusive += exclusive_values(names, exclusive, context.values_of_signals)
    atoms = _atoms(names, context)
    read = [*(atom.expression for atom in atoms), *(register.update for register in memory.registers)]
    variables = [node for expression in read for node in _variables(expression)]
    signals = [node.name for node in variables if isinstance(node, SignalNode) and node.name not in context.registers]
    return Vocabulary(
        atoms=atoms,
        signals=tuple(dict.fromkeys(context.signals[name] for name in signals)),
        params=tuple(dict.fromkeys(context.params[node.name] for node in variables if isinstance(node, ParamNode))),
        exclusive=tuple(tuple(sorted(names.index(name) for name in group)) for group in exclusive),
        clock_s=context.clock_s,
        registers=memory.registers,
        clock_varies=context.clock_varies,
    )


def _atoms(names: Iterable[str], context: Context) -> tuple[Atom, ...]:
    return tuple(context.atoms[name] for name in names)


def _in_whole(diagnostic: Diagnostic | None, clause: Clause, source: SourceFile) -> Diagnostic | None:
    """Return an error with a fix for the whole clause, if one for the part in error would lead to the next error.

    Its help shows the whole clause, too.
    """
    from tltlc.grammar.english.clauses import with_whole_clause

    if diagnostic is None:
        return None
    return showing_clause(with_whole_clause(diagnostic, source, clause.span), source, clause.span)


def _conjuncts(clause: Clause, env: Env) -> list[Conjunct]:
    """Return the conjuncts of a clause, with their bounded operators, and each also without bounds."""
    read = _READERS[clause.kind]
    parts = read(clause, env)
    if not env.context.bounds:
        return parts
    unbounded = [part.formula for part in read(clause, replace(env, unbounded=True))]
    return [
        replace(part, unbounded=unbounded_formula if unbounded_formula is not part.formula else None)
        for part, unbounded_formula in zip(parts, unbounded, strict=True)
    ]


MOST_UNFOLDED: Final = 64
"""Bounds are unfolded to states if all bounds of a spec together need at most about this many."""


def _without_bounds(parts: list[Conjunct], env: Env, *, unfolds: bool) -> list[Conjunct]:
    """Return the conjuncts without bounded operators.

    A spec whose bounds need few states gets these states: then it needs no memory, and its verdicts
    come as early as possible. In all other specs, timers replace the bounds that have a rule
    (:mod:`tltlc.resolve.deadlines`), and the others become states. If ``unfolds``, all become states.
    """
    context = env.context
    if context.clock_varies:
        return _without_time_bounds(parts, context)
    many_rules = sum(rules_from_start(part.formula) for part in parts) > 1
    few = prod(_states(node) for part in parts for node in bounded_parts(part.formula)) <= MOST_UNFOLDED
    timed = not (few or unfolds)
    result = []
    for part in parts:
        timers = Timers(context, part.source, part.span)
        formula = with_timers(part.formula, timers, many_rules=many_rules) if timed else part.formula
        bounds = tuple(dict.fromkeys(context.bound_of[node] for node in bounded_parts(formula)))
        result.append(replace(part, formula=unfold(formula, context), bounds=bounds))
    return result


def _without_time_bounds(parts: list[Conjunct], context: Context) -> list[Conjunct]:
    """Return the conjuncts with timers in place of bounded operators, where the clock varies.

    Raises ResolutionError (TLT0323) for a bound that has no timer.
    """
    many_rules = sum(rules_from_start(part.formula) for part in parts) > 1
    result = []
    for part in parts:
        timers = ElapsedTimers(context, part.source, part.span)
        formula = with_elapsed_timers(part.formula, timers, many_rules=many_rules)
        for node in bounded_parts(formula):
            raise no_timer_error(context.bound_of[node])
        result.append(replace(part, formula=formula, bounds=()))
    return result


def _states(node: Formula) -> int:
    """Return about how many states a bounded operator becomes if it is unfolded."""
    bound = bound_of(node)
    return 1 if bound is None else bound.high + 2


def _reach(clause: Clause, env: Env) -> list[Conjunct]:
    expression = _expression(clause)
    result = with_bounds(expression, env)
    is_sequence = isinstance(expression, BinaryExpr) and expression.op == "then"
    return [_conjunct(result if is_sequence else eventually(result), clause, env)]


def _keep(clause: Clause, env: Env) -> list[Conjunct]:
    return [_conjunct(always(with_bounds(_expression(clause), env)), clause, env)]


def _avoid(clause: Clause, env: Env) -> list[Conjunct]:
    return [_conjunct(always(not_(with_bounds(_expression(clause), env))), clause, env)]


def _require(clause: Clause, env: Env) -> list[Conjunct]:
    source = env.scope.source
    return [Conjunct(with_bounds(e, env), source, e.span, _text(e, source)) for e in conjuncts(_expression(clause))]


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
    source = env.scope.source
    return Conjunct(conjunct, source, clause.span, f"{clause.kind} {_text(_expression(clause), source)}")


def _text(expression: Expr, source: SourceFile) -> str:
    """Return an expression on one line, with operators as words; one that nests very deep, as it stands."""
    try:
        text = OneLinePrinter(source, STYLES["words"]).text(expression)
    except RecursionError:
        text = " ".join(source.slice(expression.span).split())
    assert text is not None, "there is room for every text"
    return text


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


def _time_limit(declaration: SpecDecl, source: SourceFile) -> str:
    """Return the limit of a spec as it is written, if it is a time; else ""."""
    for clause in declaration.clauses:
        if clause.kind == "limit" and isinstance(clause.value, NumberExpr) and clause.value.unit not in (None, "steps"):
            return source.slice(clause.value.span)
    return ""


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
