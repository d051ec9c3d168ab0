"""The declarations that a library exports, and what its predicates mean."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import inf
from typing import Literal, cast

from tltlc.core.record import EMPTY, record, replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import SignalValue as SignalNode
from tltlc.grammar.tree import Argument, CallExpr, LetDecl, NameExpr, Parameter, PredicateDecl, SignalDecl
from tltlc.resolve import units
from tltlc.resolve.predicates import predicate
from tltlc.resolve.problem import ResolutionError
from tltlc.resolve.scope import Binding
from tltlc.resolve.spec import Param, Signal, ValueType
from tltlc.resolve.values import Entity, Env, Quantity, ResolvedValue
from tltlc.tools.diff.values import Meaning, meaning_of

ExportKind = Literal["signal", "param", "predicate", "let", "entity", "group"]


@record
class Export:
    """A name that a library exports, with its declaration.

    ``is_own`` is true if the library itself declares the name, and false if it imports the name.
    ``value`` is set for a signal or param.

    ``meanings`` is set for a predicate that the library itself declares. It maps each number of
    arguments that a use may have to the meaning of an example. For a predicate
    ``near(target: entity, close: length = 1 m)``, the examples are ``near(target)`` for 1 and
    ``near(target, close)`` for 2. Their arguments are an entity called ``target`` and a signal called
    ``close``.
    """

    name: str
    kind: ExportKind
    parameters: tuple[Parameter, ...]
    place: Label
    is_own: bool
    value: Signal | Param | None = None
    meanings: Mapping[int, Meaning] = EMPTY


def exports(env: Env) -> Mapping[str, Export]:
    """Return the exports of a module by name: what it declares, and what it imports.

    ``env`` is the environment in which the names of the module are resolved. The module must have
    been resolved without errors.
    """
    return {name: _export(name, binding, env) for name, binding in env.scope.names.items()}


def _export(name: str, binding: Binding, env: Env) -> Export:
    declaration, context = binding.declaration, env.context
    parameters = declaration.parameters if isinstance(declaration, (SignalDecl, PredicateDecl, LetDecl)) else ()
    place = Label(binding.scope.source, binding.span)
    export = Export(name, binding.kind, parameters, place, binding.scope is env.scope)
    if binding.kind == "signal":
        info = context.signal_infos[binding.name]
        return replace(export, value=info.signal_of(info.parameters))
    if binding.kind == "param":
        return replace(export, value=context.params[binding.name])
    if binding.kind == "predicate" and export.is_own:
        return replace(export, meanings=dict(_meanings(binding, parameters, env)))
    return export


def _meanings(binding: Binding, parameters: tuple[Parameter, ...], env: Env) -> Iterator[tuple[int, Meaning]]:
    required = max(
        (place for place, parameter in enumerate(parameters, start=1) if parameter.default is None), default=0
    )
    for count in range(required, len(parameters) + 1):
        meaning = _meaning(binding, parameters[:count], env)
        if meaning is not None:
            yield count, meaning


def _meaning(binding: Binding, open_parameters: tuple[Parameter, ...], env: Env) -> Meaning | None:
    """Return what an example use of a predicate means, for instance ``near(target, close)``.

    Only ``open_parameters`` get arguments; the other parameters have their defaults. Each argument is
    an entity or a signal with the name of its parameter. Return None if this use does not resolve,
    for example because of unknown units.
    """
    local: dict[str, ResolvedValue] = {}
    signals: list[Signal] = []
    for parameter in open_parameters:
        if parameter.type == "entity":
            local[parameter.name] = Entity(parameter.name)
            continue
        bounded = parameter.type in ("ratio", "bool")
        type_ = cast(ValueType, parameter.type or "number")
        signal = Signal(parameter.name, type_, 0.0 if bounded else None, 1.0 if bounded else None)
        signals.append(signal)
        # Without a type, the parameter accepts a number of any dimension.
        dimension = units.TYPES[type_] if parameter.type else None
        low, high = (0.0, 1.0) if bounded else (-inf, inf)
        local[parameter.name] = Quantity(
            SignalNode(signal.name),
            dimension,
            low,
            high,
            signal.name,
            is_bool=type_ == "bool",
            is_whole=type_ == "int" or parameter.type is None,
            call=(signal.base, ()),
        )
    span = binding.span
    arguments = tuple(Argument(parameter.name, NameExpr(parameter.name, span), span) for parameter in open_parameters)
    use = CallExpr(binding.name, arguments, span, span) if arguments else NameExpr(binding.name, span)
    try:
        value = predicate(use, binding, replace(env, local=local, symbolic=True)).value
    except ResolutionError:
        return None
    all_signals = (*signals, *env.context.signals.values())
    return meaning_of(value.expression, all_signals, tuple(env.context.params.values()))
