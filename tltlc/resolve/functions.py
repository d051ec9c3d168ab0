"""Check calls of built-in functions: their number of arguments and the dimension of their value."""

from __future__ import annotations

from tltlc.grammar.tree import CallExpr
from tltlc.resolve import units
from tltlc.resolve.dimensions import mismatch, same_dimension
from tltlc.resolve.problem import problem
from tltlc.resolve.units import Dimension
from tltlc.resolve.values import Env, Quantity

_FORMS = {
    1: ("one argument", "(x)"),
    3: ("three arguments: the value, its lower limit and its upper limit", "(x, 0, 1)"),
    None: ("at least two arguments", "(x, y)"),
}
_ARGUMENTS = {"abs": 1, "sqrt": 1, "exp": 1, "tanh": 1, "clamp": 3, "min": None, "max": None}


def check_arguments(call: CallExpr, env: Env) -> None:
    """Raise ResolutionError (TLT0210) if a built-in function gets a wrong number of arguments, or one by name."""
    name, source, count = call.name, env.scope.source, len(call.arguments)
    named = next((argument for argument in call.arguments if argument.name is not None), None)
    if named is not None:
        title, advice = f"`{name}` takes its arguments by position", f"leave out `{named.name} =`"
        raise problem("TLT0210", title, source, named.span, advice=advice)
    arity = _ARGUMENTS[name]
    if count < 2 if arity is None else count != arity:
        text, example = _FORMS[arity]
        raise problem("TLT0210", f"`{name}` takes {text}", source, call.span, advice=f"write e.g. `{name}{example}`")


def dimension(call: CallExpr, values: tuple[Quantity, ...], env: Env) -> Dimension | None:
    """Return the dimension of the value of a call: a length for ``max(3 m, x)``, a plain number for ``exp(x)``.

    ``values`` are the arguments of the call. The result is None if it fits any dimension, as for
    ``max(0, 0)``. Raises ResolutionError (TLT0305) if the dimensions of the arguments do not fit.
    """
    first, rest = values[0], values[1:]
    if call.name in ("exp", "tanh"):
        if first.dimension not in (None, units.PLAIN):
            why = f"`{call.name}` takes a number; divide by a quantity of the same kind"
            raise mismatch(units.PLAIN, first.dimension, call.arguments[0].value, env, why, help_is_in_why=True)
        return units.PLAIN
    if call.name == "sqrt":
        return units.power(first.dimension, 0.5)
    common = first.dimension
    for argument, value in zip(call.arguments[1:], rest, strict=True):
        common = same_dimension(first, value, argument.value, env)
        first = value if first.dimension is None else first
    return common
