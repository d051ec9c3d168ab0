"""Resolve the uses of predicates: check their arguments, and compute their values and the names of their atoms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from tltlc.core.names import full_name
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import Const
from tltlc.grammar import tree
from tltlc.grammar.tree import CallExpr, Expr, GroupExpr, NameExpr, Parameter, PredicateDecl
from tltlc.resolve import units
from tltlc.resolve.arguments import match
from tltlc.resolve.constants import interval
from tltlc.resolve.context import Instance
from tltlc.resolve.declared_values import signal_value
from tltlc.resolve.dimensions import mismatch
from tltlc.resolve.kinds import entity, kind_of
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.quantities import quantity
from tltlc.resolve.scope import Binding, Scope
from tltlc.resolve.spec import Signal, ValueType
from tltlc.resolve.unknown_types import unknown_type_error
from tltlc.resolve.values import Entity, Env, Quantity, ResolvedValue, Unknown, constant


@record
class PredicateUse:
    """One use of a predicate, such as ``near(s1)``: its value, and the documentation of the predicate.

    The text of ``value`` is the name of the atom, and its range is the declared range.
    """

    value: Quantity
    doc: str


def predicate(use: NameExpr | CallExpr, binding: Binding, env: Env, depth: int = 0) -> PredicateUse:
    """Return a use of a predicate, with the arguments in place of the parameters.

    The text of its value is the name of the atom, e.g. ``near(s1, close=3)``. ``depth`` is the
    number of operators around the use. Raises ResolutionError if an argument or the body is in error.
    """
    declaration = binding.declaration
    assert isinstance(declaration, PredicateDecl)
    values: dict[str, ResolvedValue] = {}
    argument_texts: list[str] = []
    place = None
    is_settled = True
    for parameter, argument in match(use, binding, declaration.parameters, env.scope):
        inside = env.inside(binding.scope, dict(values))
        default = argument_value(parameter, parameter.default, inside, binding, depth) if parameter.default else None
        value = default if argument is None else argument_value(parameter, argument, env, binding, depth)
        assert value is not None
        values[parameter.name] = value
        if default is None:
            argument_texts.append(_text(value))
        elif _text(value) != _text(default):
            argument_texts.append(f"{parameter.name}={_text(value)}")
        else:
            continue
        if isinstance(value, Quantity):
            place = Label(env.scope.source, use.span)
            # A symbolic number gets its value where the enclosing definition is used; the range is checked there.
            is_settled = is_settled and (value.is_constant or not env.symbolic)
    try:
        value = _instantiate(tuple(argument_texts), declaration, binding.scope, values, env, depth, place, is_settled)
    except ResolutionError as failure:
        if place:
            failure.add_use(place, binding.scope.source, declaration.body.span)
        raise
    return PredicateUse(value, declaration.doc)


def check_unused(binding: Binding, env: Env) -> None:
    """Check the body of a predicate that nothing uses, with placeholders as its arguments.

    Do nothing if a use of the predicate has been recorded. The range of the value is checked only if
    each parameter is an entity or has a default: with a placeholder for a number, the range is
    unknown. Raises ResolutionError if the body or a default is in error.
    """
    declaration = binding.declaration
    assert isinstance(declaration, PredicateDecl)
    if any(key[0] == id(declaration) for key in env.context.instances):
        return
    values: dict[str, ResolvedValue] = {}
    needs_numbers = False
    for parameter in declaration.parameters:
        if parameter.default is not None:
            inside = env.inside(binding.scope, dict(values))
            values[parameter.name] = argument_value(parameter, parameter.default, inside, binding, 0)
        else:
            values[parameter.name] = _symbolic_value(parameter, binding, env)
            needs_numbers = needs_numbers or parameter.type != "entity"
    if needs_numbers:
        declared_range(declaration, binding.scope, env)
        _body(declaration, binding.scope, values, replace(env, symbolic=True), 0)
    else:
        _instantiate((), declaration, binding.scope, values, env, 0)


def argument_value(parameter: Parameter, argument: Expr, env: Env, binding: Binding, depth: int) -> ResolvedValue:
    """Return the value of an argument of a predicate, or of an argument of a ``let`` definition that is no formula.

    The value is an entity or a quantity. ``depth`` is the number of operators around the use. Raises
    ResolutionError if the argument does not fit the parameter.
    """
    while isinstance(argument, GroupExpr):
        argument = argument.inner
    if parameter.type == "entity" or (parameter.type is None and kind_of(argument, env) == "entity"):
        return entity(argument, env)
    type_ = parameter_type(parameter, binding)
    if type_ and kind_of(argument, env) == "entity":
        title = f"`{parameter.name}` of `{binding.name}` is {'an' if type_[0] in 'ai' else 'a'} {type_}, not an entity"
        name = env.scope.source.slice(argument.span)
        advice = f"for `{name}`, write another `{binding.name}(…)`, and join the two with `and`, `or` or `then`"
        raise problem("TLT0302", title, env.scope.source, argument.span, advice=advice)
    if type_ == "bool" and isinstance(argument, tree.Constant):
        return constant(float(argument.value), units.PLAIN)
    value = quantity(argument, env, depth)
    env.context.count_arithmetic(value.expression, env.scope.source, argument.span)
    if type_ is None or value.dimension is None:
        return value
    dimension = units.TYPES[type_]
    if value.dimension != dimension:
        article = "an" if type_[0] in "ai" else "a"
        raise mismatch(dimension, value.dimension, argument, env, f"`{parameter.name}` is {article} {type_}")
    if type_ == "int" and not value.is_whole:
        raise problem(
            "TLT0307",
            f"`{parameter.name}` is an int: it must be a whole number",
            env.scope.source,
            argument.span,
            advice="write a whole number, or a signal or param of the type `int`",
        )
    if type_ == "ratio" and isinstance(value.expression, Const) and not 0 <= value.expression.value <= 1:
        raise problem(
            "TLT0307",
            f"`{parameter.name}` is a ratio: it must lie in [0, 1]",
            env.scope.source,
            argument.span,
            advice="write a number between 0 and 1, or a percentage up to `100 %`",
        )
    return value


def parameter_type(parameter: Parameter, binding: Binding) -> str | None:
    """Return the declared type of a parameter, or None if no type is declared, so that any number fits.

    Raises ResolutionError (TLT0211) for an unknown type.
    """
    if parameter.type is None or parameter.type in units.TYPES:
        return parameter.type
    raise unknown_type_error(parameter.type, parameter, binding.scope.source)


def _symbolic_value(parameter: Parameter, binding: Binding, env: Env) -> ResolvedValue:
    """Return a placeholder for the argument of a parameter, to check a predicate that nothing uses.

    For an entity, this is an entity with the parameter's name; for a parameter with another type, a
    signal with this name; without a type, an Unknown.
    """
    if parameter.type == "entity":
        return Entity(parameter.name)
    type_ = parameter_type(parameter, binding)
    if type_ is None:
        return Unknown(parameter.name)
    low, high = (0.0, 1.0) if type_ in ("ratio", "bool") else (None, None)
    signal = Signal(parameter.name, cast(ValueType, type_), low, high)
    env.context.signals.setdefault(signal.name, signal)
    return signal_value(signal)


def _text(value: ResolvedValue) -> str:
    return value.name if isinstance(value, (Entity, Unknown)) else value.text if isinstance(value, Quantity) else ""


def _instantiate(
    arguments: tuple[str, ...],
    declaration: PredicateDecl,
    scope: Scope,
    values: Mapping[str, ResolvedValue],
    env: Env,
    depth: int,
    place: Label | None = None,
    is_settled: bool = True,
) -> Quantity:
    context = env.context
    memo = (id(declaration), tuple(values.values()))
    if memo in context.values:
        known: Quantity = context.values[memo]
        return known
    if id(declaration) in context.broken:
        raise ResolutionError(None)
    is_settled = is_settled and not any(isinstance(value, Unknown) for value in values.values())
    low, high = declared_range(declaration, scope, env)
    env = replace(env, symbolic=not is_settled)
    body = _body(declaration, scope, values, env, depth)
    name = full_name(declaration.name, arguments)
    call = (declaration.name, arguments)
    result = Quantity(body.expression, units.PLAIN, low, high, name, depth=body.depth, call=call)
    if is_settled:
        _note_instance(declaration, scope, values, (low, high), env, depth, place)
        context.values[memo] = result
    return result


def declared_range(declaration: PredicateDecl, scope: Scope, env: Env) -> tuple[float, float]:
    """Return the declared range of a predicate, or [-1, 1] if there is none.

    Raises ResolutionError (TLT0303) if the range does not lie in [-1, 1].
    """
    if declaration.interval is None:
        return -1.0, 1.0
    low, high = interval(declaration.interval, units.PLAIN, env.inside(scope, {}))
    if low is None or high is None or not -1 <= low <= high <= 1:
        raise problem(
            "TLT0303",
            "the range of a predicate must lie in [-1, 1]",
            scope.source,
            declaration.interval.span,
            advice="scale the value, or use `clamp(…, -1, 1)`, and declare `in [-1, 1]`",
        )
    return low, high


def _body(
    declaration: PredicateDecl, scope: Scope, values: Mapping[str, ResolvedValue], env: Env, depth: int
) -> Quantity:
    context = env.context
    if id(declaration) in context.expanding:
        raise context.recursion_error(id(declaration), scope.source, declaration.name_span)
    context.expanding[id(declaration)] = declaration.name
    try:
        body = quantity(declaration.body, env.inside(scope, values), depth)
    finally:
        context.expanding.pop(id(declaration), None)
    if body.dimension not in (None, units.PLAIN):
        why = "divide it by a quantity of the same kind: a predicate is a number in [-1, 1]"
        raise mismatch(
            units.PLAIN, body.dimension, declaration.body, env.inside(scope, values), why, help_is_in_why=True
        )
    return body


def _note_instance(
    declaration: PredicateDecl,
    scope: Scope,
    values: Mapping[str, ResolvedValue],
    declared: tuple[float, float],
    env: Env,
    depth: int,
    place: Label | None,
) -> None:
    """Record a predicate with its arguments in ``env.context``, so that its range and continuity will be checked.

    The names of parameters replace entities, so uses that differ only in entities, such as
    ``near(s1)`` and ``near(s2)``, are checked once. ``declared`` is the declared range.
    """
    general: dict[str, ResolvedValue] = {}
    names: dict[str, str] = {}
    for name, value in values.items():
        if isinstance(value, Entity):
            value = Entity(names.setdefault(value.name, name))
        general[name] = value
    key = (id(declaration), tuple(general.values()))
    if key not in env.context.instances:
        body = _body(declaration, scope, general, env, depth)
        span = declaration.interval.span if declaration.interval else declaration.name_span
        env.context.instances[key] = Instance(declaration.name, body.expression, *declared, scope.source, span, place)
