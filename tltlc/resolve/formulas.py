"""Formulas: from syntax to logic, with predicates, comparisons, lets, quantifiers and bounds settled.

The functions that walk the tree are generators run by :func:`_run`, which keeps their stack on the
heap: neither a long chain of operators nor a deep nest of lets can exhaust Python's own.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any

from tltlc.grammar.tree import Binary, Call, Constant, Expr, Group, LetDecl, Name, Quantified, SignalDecl, Unary
from tltlc.logic import formula as logic
from tltlc.logic.formula import Formula
from tltlc.resolve import units
from tltlc.resolve.arguments import match
from tltlc.resolve.bounds import bounded
from tltlc.resolve.comparisons import comparison
from tltlc.resolve.context import MOST_EXPANSIONS, too_large
from tltlc.resolve.kinds import entity, kind_of, lookup, not_a_formula
from tltlc.resolve.predicates import argument_value, predicate
from tltlc.resolve.problem import ResolutionError
from tltlc.resolve.quantities import signal
from tltlc.resolve.scope import Binding
from tltlc.resolve.values import Entity, Env, Quantity, Unknown, Value, apply, constant
from tltlc.source import Span

Steps = Generator[Any, Any, Any]
"""Yields the generators it waits for; returns a formula."""

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
_NARY: dict[str, Callable[..., Formula]] = {"and": logic.and_, "or": logic.or_}


def formula(expr: Expr, env: Env) -> Formula:
    """The formula that an expression stands for; raises ResolutionError where it is none."""
    try:
        return _run(_formula(expr, env))
    except ResolutionError:
        env.context.expanding.clear()
        raise


def conjuncts(expr: Expr) -> list[Expr]:
    """The operands of the outermost conjunction as written, in order; the expression itself if it is none."""
    result: list[Expr] = []
    stack = [expr]
    while stack:
        node = stack.pop()
        inner = node
        while isinstance(inner, Group):
            inner = inner.inner
        if isinstance(inner, Binary) and inner.op == "and":
            stack += (inner.right, inner.left)
        else:
            result.append(node)
    return result


def check_unused(binding: Binding, env: Env) -> None:
    """Expands a let with symbolic arguments, so that its body is checked even if nothing uses it."""
    declaration = binding.declaration
    assert isinstance(declaration, LetDecl)
    values: dict[str, Value] = {}
    for parameter in declaration.parameters:
        values[parameter.name] = Entity(parameter.name) if parameter.type == "entity" else Unknown(parameter.name)
    inside = Env(env.context, binding.scope, values, symbolic=bool(declaration.parameters))
    try:
        _run(_expand(declaration, binding, inside, declaration.name_span, env))
    except ResolutionError:
        env.context.expanding.clear()
        raise


def _run(steps: Steps) -> Formula:
    """The result of a generator that yields the generators whose results it waits for."""
    stack = [steps]
    value: Formula | None = None
    while True:
        try:
            child = stack[-1].send(value)
        except StopIteration as finished:
            stack.pop()
            value = finished.value
            if not stack:
                assert value is not None
                return value
        else:
            stack.append(child)
            value = None


def _formula(expr: Expr, env: Env) -> Steps:
    while isinstance(expr, Group):
        expr = expr.inner
    if isinstance(expr, Constant):
        return logic.TRUE if expr.value else logic.FALSE
    if isinstance(expr, (Name, Call)):
        return (yield _named(expr, env))
    if isinstance(expr, Unary) and expr.op in _UNARY:
        operand = yield _formula(expr.operand, env)
        return bounded(expr, operand, env) if expr.bound else _UNARY[expr.op](operand)
    if isinstance(expr, Quantified):
        return (yield _quantified(expr, env))
    if isinstance(expr, Binary):
        if expr.op in ("<", "<=", ">", ">="):
            return comparison(expr, env)
        if expr.op in _NARY:
            operands: list[Formula] = []
            for written in _chain(expr):
                operand = yield _formula(written, env)
                operands.append(operand)
            return _NARY[expr.op](*operands)
        if expr.op in _BINARY:
            left = yield _formula(expr.left, env)
            right = yield _formula(expr.right, env)
            return _BINARY[expr.op](left, right)
    raise not_a_formula(expr, env)


def _chain(expr: Binary) -> list[Expr]:
    """The operands of ``a & b & c`` in order, so that a long chain is joined at once."""
    operands: list[Expr] = []
    node: Expr = expr
    while isinstance(node, Binary) and node.op == expr.op:
        operands.append(node.right)
        node = node.left
    operands.append(node)
    return operands[::-1]


def _named(expr: Name | Call, env: Env) -> Steps:
    local = env.local.get(expr.name)
    if local is not None:
        if isinstance(local, Formula) and isinstance(expr, Name):
            return local
        if isinstance(local, Unknown):
            return logic.atom(local.name)
        if isinstance(local, Quantity) and local.is_bool:
            return _bool_atom(local, "", expr, env)
        raise not_a_formula(expr, env)
    binding = lookup(expr, env, ("predicate", "let", "signal"), "predicate")
    if binding.kind == "predicate":
        use = predicate(expr, binding, env)
        if env.symbolic:
            return logic.atom(use.value.text)
        return env.context.atom(use.value.text, use.value.expression, use.doc, env.scope.source, expr.span)
    if binding.kind == "let":
        return (yield _let(expr, binding, env))
    declaration = binding.declaration
    if isinstance(declaration, SignalDecl) and declaration.type == "bool":
        return _bool_atom(signal(expr, binding, env), declaration.doc, expr, env)
    raise not_a_formula(expr, env)


def _bool_atom(value: Quantity, doc: str, expr: Name | Call, env: Env) -> Formula:
    """A bool as an atom: robustness 1 where it is true, -1 where it is false."""
    if value.is_constant:
        return logic.TRUE if value.low else logic.FALSE
    doubled = apply("*", (constant(2.0, units.PLAIN), value), units.PLAIN)
    scaled = apply("-", (doubled, constant(1.0, units.PLAIN)), units.PLAIN) if doubled else None
    assert scaled is not None, "not a constant"
    if env.symbolic:
        return logic.atom(value.text)
    return env.context.atom(value.text, scaled.expression, doc, env.scope.source, expr.span)


def _let(expr: Name | Call, binding: Binding, env: Env) -> Steps:
    declaration = binding.declaration
    assert isinstance(declaration, LetDecl)
    values: dict[str, Value] = {}
    for parameter, argument in match(expr, binding, declaration.parameters, env.scope):
        where = env if argument is not None else env.within(binding.scope, dict(values))
        given = argument if argument is not None else parameter.default
        assert given is not None
        if parameter.type == "formula" or (parameter.type is None and kind_of(given, where) == "formula"):
            values[parameter.name] = yield _formula(given, where)
        else:
            values[parameter.name] = argument_value(parameter, given, where, binding, 0)
    return (yield _expand(declaration, binding, env.within(binding.scope, values), expr.span, env))


def _expand(declaration: LetDecl, binding: Binding, inside: Env, span: Span, user: Env) -> Steps:
    """The body of a let with its parameters' values, each combination once."""
    context, source = inside.context, user.scope.source
    key = id(declaration)
    if key in context.broken:
        raise ResolutionError(None)
    if key in context.expanding:
        raise context.recursion(key, binding.scope.source, declaration.name_span)
    memo = (key, inside.symbolic, tuple(inside.local.values()))
    if memo not in context.values:
        _count(f"the let `{declaration.name}`", span, user)
        context.expanding[key] = declaration.name
        body = yield _formula(declaration.body, inside)
        del context.expanding[key]
        try:
            context.values[memo] = context.checked_size(body, f"the let `{declaration.name}`", source, span)
        except ResolutionError:
            context.broken.add(key)
            raise
    found: Formula = context.values[memo]
    return found


def _quantified(expr: Quantified, env: Env) -> Steps:
    what = f"`{'all' if expr.all else 'any'} {expr.variable}`"
    parts = []
    for name in expr.entities:
        _count(what, expr.span, env)
        parts.append((yield _formula(expr.body, env.also(expr.variable, entity(name, env)))))
    joined = logic.and_(*parts) if expr.all else logic.or_(*parts)
    return env.context.checked_size(joined, what, env.scope.source, expr.span)


def _count(what: str, span: Span, env: Env) -> None:
    env.context.expansions += 1
    if env.context.expansions > MOST_EXPANSIONS:
        env.context.broken.update(env.context.expanding)
        first = env.context.expansions == MOST_EXPANSIONS + 1
        raise too_large(what, env.scope.source, span) if first else ResolutionError(None)
