"""The values of declared params and signals where they are used."""

from __future__ import annotations

from math import inf

from tltlc.expression.tree import Param as ParamNode
from tltlc.expression.tree import Signal as SignalNode
from tltlc.grammar.tree import Call, Name, ParamDecl, SignalDecl
from tltlc.resolve import units
from tltlc.resolve.arguments import match
from tltlc.resolve.kinds import entity
from tltlc.resolve.problem import ResolutionError
from tltlc.resolve.scope import Binding
from tltlc.resolve.spec import Signal
from tltlc.resolve.values import Env, Quantity


def param(binding: Binding, env: Env) -> Quantity:
    """The value of a declared param."""
    declaration = binding.declaration
    assert isinstance(declaration, ParamDecl)
    found = env.context.params.get(declaration.name)
    if found is None:
        raise ResolutionError(None)
    low = -inf if found.low is None else found.low
    high = inf if found.high is None else found.high
    return Quantity(ParamNode(found.name), units.TYPES[found.type], low, high, found.name)


def signal(expr: Name | Call, binding: Binding, env: Env) -> Quantity:
    """The value of a declared signal, of the entities given."""
    declaration = binding.declaration
    assert isinstance(declaration, SignalDecl)
    pairs = match(expr, binding, declaration.parameters, env.scope)
    entities = tuple(entity(argument, env).name for _, argument in pairs if argument is not None)
    memo = (id(declaration), entities)
    if memo not in env.context.values:
        info = env.context.signal_infos.get(declaration.name)
        if info is None:
            raise ResolutionError(None)
        env.context.values[memo] = of_signal(env.context.signal(info, entities))
    found: Quantity = env.context.values[memo]
    return found


def of_signal(found: Signal) -> Quantity:
    """A signal's value."""
    low = -inf if found.low is None else found.low
    high = inf if found.high is None else found.high
    dimension = units.TYPES[found.type]
    return Quantity(SignalNode(found.name), dimension, low, high, found.name, is_bool=found.type == "bool")
