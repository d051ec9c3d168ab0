"""Turn the uses of params and signals in expressions into quantities: numbers with a range and a dimension."""

from __future__ import annotations

from math import inf

from tltlc.expression.tree import ParamValue as ParamNode
from tltlc.expression.tree import SignalValue as SignalNode
from tltlc.grammar.tree import CallExpr, NameExpr, ParamDecl, SignalDecl
from tltlc.resolve import units
from tltlc.resolve.arguments import match
from tltlc.resolve.kinds import entity
from tltlc.resolve.problem import ResolutionError
from tltlc.resolve.scope import Binding
from tltlc.resolve.spec import Signal
from tltlc.resolve.values import Env, Quantity


def param(binding: Binding, env: Env) -> Quantity:
    """Return the quantity for a use of a param: its value in an expression, with its range and dimension.

    Raises ResolutionError without a diagnostic if the declaration of the param is in error.
    """
    declaration = binding.declaration
    assert isinstance(declaration, ParamDecl)
    declared = env.context.params.get(declaration.name)
    if declared is None:
        raise ResolutionError(None)
    low = -inf if declared.low is None else declared.low
    high = inf if declared.high is None else declared.high
    return Quantity(
        ParamNode(declared.name), units.TYPES[declared.type], low, high, declared.name, is_whole=declared.type == "int"
    )


def signal(expr: NameExpr | CallExpr, binding: Binding, env: Env) -> Quantity:
    """Return the quantity for a use of a signal, such as ``health`` or ``distance(s1)``.

    Arguments must be entities (objects of the level). Raises ResolutionError if the arguments do not
    fit, and without a diagnostic if the declaration of the signal is in error.
    """
    declaration = binding.declaration
    assert isinstance(declaration, SignalDecl)
    pairs = match(expr, binding, declaration.parameters, env.scope)
    entities = tuple(entity(argument, env).name for _, argument in pairs if argument is not None)
    memo = (id(declaration), entities)
    if memo not in env.context.values:
        info = env.context.signal_infos.get(declaration.name)
        if info is None:
            raise ResolutionError(None)
        env.context.values[memo] = signal_value(env.context.signal(info, entities, env.scope.source, expr.span))
    value: Quantity = env.context.values[memo]
    return value


def signal_value(signal: Signal) -> Quantity:
    """Return a signal as a quantity: an expression that reads it, with its range and dimension."""
    low = -inf if signal.low is None else signal.low
    high = inf if signal.high is None else signal.high
    dimension = units.TYPES[signal.type]
    return Quantity(
        SignalNode(signal.name),
        dimension,
        low,
        high,
        signal.name,
        is_bool=signal.type == "bool",
        is_whole=signal.type == "int",
        call=(signal.base, signal.arguments),
    )
