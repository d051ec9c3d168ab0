"""Resolve formulas: turn predicates and comparisons into atoms, and expand lets, quantifiers and bounds.

A let is a named formula, perhaps with parameters. Each use is replaced by its body.

The functions that walk the tree are generators (:mod:`tltlc.resolve.trampoline`), so that neither a
long chain of operators nor deeply nested lets can exhaust Python's stack.
"""

from __future__ import annotations

from collections.abc import Callable

from tltlc.core.record import replace
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import Const, Expression, Op
from tltlc.grammar.mistakes.misused_operators import misused_operator
from tltlc.grammar.tree import (
    BinaryExpr,
    CallExpr,
    Constant,
    Expr,
    GroupExpr,
    IsExpr,
    LetDecl,
    NameExpr,
    NumberExpr,
    Quantified,
    SignalDecl,
    Unary,
)
from tltlc.grammar.walk import operands
from tltlc.logic import formula as logic
from tltlc.logic.formula import Formula
from tltlc.resolve import memory
from tltlc.resolve.arguments import match
from tltlc.resolve.bounds import bounded_operator, with_bound
from tltlc.resolve.comparisons import comparison
from tltlc.resolve.context import LARGEST_EXPANSION, MOST_EXPANSIONS, expansion_error, too_many_expansions_error
from tltlc.resolve.counts_since import check_no_count, check_not_compared
from tltlc.resolve.declared_values import signal
from tltlc.resolve.enums import is_value
from tltlc.resolve.equality import EQUALITIES, equality
from tltlc.resolve.groups import entities
from tltlc.resolve.kinds import check_let, kind_of, lookup, not_a_formula_error
from tltlc.resolve.predicates import argument_value, predicate
from tltlc.resolve.problem import ResolutionError
from tltlc.resolve.scope import FUNCTIONS, Binding
from tltlc.resolve.trampoline import FormulaGenerator, run_to_result
from tltlc.resolve.unfolding import bounded_parts, unfold
from tltlc.resolve.units import value_type
from tltlc.resolve.values import Entity, Env, Quantity, ResolvedValue, Unknown

_UNARY: dict[str, Callable[[Formula], Formula]] = {
    "not": logic.not_,
    "F": logic.eventually,
    "G": logic.always,
    "X": logic.next_,
    "N": logic.weak_next,
}
_BINARY: dict[str, Callable[[Formula, Formula], Formula]] = {
    "implies": logic.implies,
    "iff": logic.iff,
    "U": logic.until,
    "W": logic.weak_until,
    "R": logic.release,
    "M": logic.strong_release,
    "then": logic.then,
}
_COMPARISONS = ("<", "<=", ">", ">=", *EQUALITIES)
_NARY: dict[str, Callable[..., Formula]] = {"and": logic.and_, "or": logic.or_}


def formula(expr: Expr, env: Env) -> Formula:
    """Return the formula of an expression; raise ResolutionError if it is not a formula or too large."""
    return unfold(with_bounds(expr, env), env.context)


def known_formula(expr: Expr, env: Env) -> Formula | None:
    """Return the formula of an expression without bounds.

    Return None if the expression is not a formula or too large, or if it has a bound although the clock
    varies: then only a whole clause has timers in place of bounds.
    """
    try:
        known = formula(expr, env)
    except ResolutionError:
        return None
    return None if any(True for _ in bounded_parts(known)) else known


def with_bounds(expr: Expr, env: Env) -> Formula:
    """Return the formula of an expression with its bounded operators; raise ResolutionError if it is not a formula."""
    return run_to_result(_formula(expr, env))


def check_unused(binding: Binding, env: Env) -> None:
    """Check the body of a ``let`` definition, with placeholders as its arguments.

    This finds errors in a definition that nothing uses. Raises ResolutionError for the first error.
    """
    declaration = binding.declaration
    assert isinstance(declaration, LetDecl)
    values: dict[str, ResolvedValue] = {}
    for parameter in declaration.parameters:
        values[parameter.name] = Entity(parameter.name) if parameter.type == "entity" else Unknown(parameter.name)
    inside = Env(env.context, binding.scope, values, symbolic=bool(declaration.parameters))
    run_to_result(_expand_let(declaration, binding, inside, declaration.name_span, env))


def _formula(expr: Expr, env: Env) -> FormulaGenerator:
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    if isinstance(expr, Constant):
        return logic.TRUE if expr.value else logic.FALSE
    if isinstance(expr, NameExpr):
        return (yield _resolve_name(expr, env))
    if isinstance(expr, CallExpr) and memory.is_memory(expr, env):
        return _recalled_bool(expr, env)
    if isinstance(expr, (CallExpr, IsExpr)) or (isinstance(expr, BinaryExpr) and expr.op in _COMPARISONS):
        return (yield _resolve_once(expr, env))
    if isinstance(expr, Unary) and expr.op in _UNARY:
        operand = yield _formula(expr.operand, _at(env, is_event=expr.op == "not"))
        return bounded_operator(expr, operand, env) if expr.bound else _UNARY[expr.op](operand)
    if isinstance(expr, Unary) and expr.op in memory.PAST:
        operand = yield _formula(expr.operand, _at(env, is_event=False))
        return memory.past(expr, operand, env)
    if isinstance(expr, BinaryExpr) and expr.op == "since":
        check_no_count(expr, env)
        left = yield _formula(expr.left, env)
        check_not_compared(expr, env)
        right = yield _formula(expr.right, env)
        return memory.since(expr, left, right, env)
    if isinstance(expr, Quantified):
        return (yield _expand_quantifier(expr, env))
    if isinstance(expr, BinaryExpr):
        if expr.op in _NARY:
            joined: list[Formula] = []
            for operand_expr in operands(expr, expr.op):
                operand = yield _formula(operand_expr, env)
                joined.append(operand)
            return _NARY[expr.op](*joined)
        if expr.op in _BINARY or expr.op == "within":
            if expr.op in ("U", "W") and isinstance(expr.right, NumberExpr) and expr.right.unit is not None:
                raise ResolutionError(misused_operator(env.scope.source, expr.right.span))
            is_rule = expr.op in ("implies", "within")
            left = yield _formula(expr.left, _at(env, is_event=is_rule or expr.op == "iff"))
            right = yield _formula(expr.right, _at(env, is_event=expr.op == "iff"))
            if expr.bound is not None:
                return with_bound(expr, left, right, env)
            return _BINARY[expr.op](left, right)
    raise not_a_formula_error(expr, env)


def _at(env: Env, *, is_event: bool) -> Env:
    """Return the environment of an operand, which stands in the condition of a rule or not."""
    return env if env.is_event == is_event else replace(env, is_event=is_event)


def _resolve_once(expr: CallExpr | BinaryExpr | IsExpr, env: Env) -> FormulaGenerator:
    """Resolve a call or comparison, or return the cached result.

    A result is cached with the values of the parameters and quantified variables in the expression,
    and is used again only for equal values.
    """
    values, names = env.context.values, env.context.names_in(expr)
    memo = (id(expr), env.symbolic, env.unbounded, tuple([env.local.get(name) for name in names]))
    if memo not in values:
        values[memo] = (yield _resolve_name(expr, env)) if isinstance(expr, CallExpr) else _comparison(expr, env)
    return values[memo]


def _comparison(expr: BinaryExpr | IsExpr, env: Env) -> Formula:
    if isinstance(expr, IsExpr):
        return is_value(expr, env)
    return equality(expr, env) if expr.op in EQUALITIES else comparison(expr, env)


def _resolve_name(expr: NameExpr | CallExpr, env: Env) -> FormulaGenerator:
    local = env.local.get(expr.name)
    if local is not None:
        if isinstance(local, Formula) and isinstance(expr, NameExpr):
            return local
        if isinstance(local, Unknown):
            return logic.atom(local.name)
        if isinstance(local, Quantity) and local.is_bool:
            return _bool_atom(local, "", expr, env)
        raise not_a_formula_error(expr, env)
    if isinstance(expr, CallExpr) and expr.name in FUNCTIONS and expr.name not in env.scope.names:
        raise not_a_formula_error(expr, env)
    binding = lookup(expr, env, ("predicate", "let", "signal"), "predicate")
    if binding.kind == "predicate":
        use = predicate(expr, binding, env, env.context.levels)
        if env.symbolic:
            return logic.atom(use.value.text)
        return _atom(use.value, use.value.expression, use.doc, expr, env)
    if binding.kind == "let":
        return (yield _use_let(expr, binding, env))
    declaration = binding.declaration
    if isinstance(declaration, SignalDecl) and declaration.type == "bool":
        return _bool_atom(signal(expr, binding, env), declaration.doc, expr, env)
    if isinstance(declaration, SignalDecl) and declaration.type is not None and value_type(declaration.type) is None:
        # The declaration has already been reported for its unknown type.
        raise ResolutionError(None)
    raise not_a_formula_error(expr, env)


def _recalled_bool(expr: CallExpr, env: Env) -> Formula:
    """Return the atom of a bool that is recalled, as in ``previous(alarm)``."""
    value = memory.recall(expr, env, env.context.levels)
    if not value.is_bool:
        raise not_a_formula_error(expr, env)
    return _bool_atom(value, "", expr, env)


def _bool_atom(value: Quantity, doc: str, expr: NameExpr | CallExpr, env: Env) -> Formula:
    """Return the atom of a bool signal or argument. Its robustness is 1 where the bool is true, else -1.

    A constant gives the formula ``true`` or ``false``.
    """
    if value.is_constant:
        return logic.TRUE if value.low else logic.FALSE
    if env.symbolic:
        return logic.atom(value.text)
    scaled = Op("-", (Op("*", (Const(2.0), value.expression)), Const(1.0)))
    return _atom(value, scaled, doc, expr, env)


def _atom(value: Quantity, robustness: Expression, doc: str, expr: NameExpr | CallExpr, env: Env) -> Formula:
    """Return the atom with the name of ``value`` and the expression ``robustness``."""
    base, arguments = value.call or (value.text, ())
    return env.context.atom(base, robustness, doc, env.scope.source, expr.span, arguments)


def _use_let(expr: NameExpr | CallExpr, binding: Binding, env: Env) -> FormulaGenerator:
    declaration = binding.declaration
    assert isinstance(declaration, LetDecl)
    values: dict[str, ResolvedValue] = {}
    for parameter, argument in match(expr, binding, declaration.parameters, env.scope):
        argument_env = env if argument is not None else env.inside(binding.scope, dict(values))
        expression = argument if argument is not None else parameter.default
        assert expression is not None
        local = argument_env.local.get(expression.name) if isinstance(expression, NameExpr) else None
        if isinstance(local, Unknown):
            values[parameter.name] = local
        elif parameter.type == "formula" or (parameter.type is None and kind_of(expression, argument_env) == "formula"):
            formula = yield _formula(expression, argument_env)
            if not env.unbounded:
                # A default may use earlier parameters, so its size may double with each of them.
                subject = f"`{parameter.name}` of `{declaration.name}`"
                env.context.check_size(formula, subject, argument_env.scope.source, expression.span)
            values[parameter.name] = formula
        else:
            values[parameter.name] = argument_value(parameter, expression, argument_env, binding, env.context.levels)
    try:
        return (yield _expand_let(declaration, binding, env.inside(binding.scope, values), expr.span, env))
    except ResolutionError as failure:
        if not all(isinstance(value, Entity) for value in values.values()):
            failure.add_use(Label(env.scope.source, expr.span), binding.scope.source, declaration.body.span)
        raise


def _expand_let(declaration: LetDecl, binding: Binding, inside: Env, span: Span, user: Env) -> FormulaGenerator:
    """Return the formula that a use of a ``let`` definition stands for.

    The parameters have the values in ``inside.local``. The formula is cached for each combination of
    values. ``span`` is the place of the use, in the source of ``user``. Raises ResolutionError if the
    definition uses itself, or if the formula is too large.
    """
    context, source = inside.context, user.scope.source
    key = id(declaration)
    if key in context.broken:
        raise ResolutionError(None)
    if key in context.expanding:
        raise context.recursion_error(key, binding.scope.source, declaration.name_span)
    memo = (key, inside.symbolic, inside.unbounded, tuple(inside.local.values()))
    if memo not in context.values:
        _count_expansion(span, user)
        context.expanding[key] = declaration.name
        try:
            check_let(declaration, inside)
            body = yield _formula(declaration.body, inside)
        finally:
            del context.expanding[key]
        if inside.unbounded:
            context.values[memo] = body
            return body
        try:
            context.values[memo] = context.check_size(body, f"the let `{declaration.name}`", source, span)
        except ResolutionError:
            context.broken.add(key)
            raise
    expansion: Formula = context.values[memo]
    return expansion


def _expand_quantifier(expr: Quantified, env: Env) -> FormulaGenerator:
    subject = f"`{'all' if expr.all else 'any'} {expr.variable}`"
    parts: list[Formula] = []
    size = 0
    for member in entities(expr.entities, env, brackets=expr.brackets):
        _count_expansion(expr.span, env)
        part = yield _formula(expr.body, env.with_local(expr.variable, member))
        parts.append(part)
        size += env.context.tree_size(part)
        if size > LARGEST_EXPANSION and not env.unbounded:
            raise expansion_error(subject, env.scope.source, expr.span)
    return logic.and_(*parts) if expr.all else logic.or_(*parts)


def _count_expansion(span: Span, env: Env) -> None:
    if env.unbounded:
        return
    env.context.expansions += 1
    if env.context.expansions > MOST_EXPANSIONS:
        env.context.broken.update(env.context.expanding)
        first = env.context.expansions == MOST_EXPANSIONS + 1
        raise too_many_expansions_error(env.scope.source, span) if first else ResolutionError(None)
