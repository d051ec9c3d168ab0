"""Checks of units: what is added, compared or handed over must have one dimension (TLT0305)."""

from __future__ import annotations

from tltlc.diagnostics.diagnostic import instead
from tltlc.grammar.tree import Declaration, Expr, Group, LetDecl, Name, Number, ParamDecl, PredicateDecl, SignalDecl
from tltlc.grammar.walk import expressions, parts
from tltlc.resolve import units
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.units import Dimension
from tltlc.resolve.values import Env, Quantity


def same_dimension(left: Quantity, right: Quantity, at: Expr, env: Env) -> Dimension | None:
    """The dimension of two quantities that are added or compared; raises ResolutionError (TLT0305) if they differ."""
    if left.dimension is None or right.dimension is None or left.dimension == right.dimension:
        return left.dimension if left.dimension is not None else right.dimension
    raise mismatch(left.dimension, right.dimension, at, env, f"the left side is {units.described(left.dimension)}")


def _goes_on(written: str | None, wanted: str | None, found: Dimension) -> bool:
    """Whether the number keeps its value with the unit that is wanted: none was written, or one that this begins with.

    A number is wanted without the unit that was written, if it is that of SI.
    """
    if wanted is None:
        return written == units.si_unit(found)
    return written is None or wanted.startswith(f"{written}/")


def _has_other_units(dimension: Dimension, unit: str, env: Env) -> bool:
    """Whether a visible signal, param or parameter of this dimension is declared in other units than that of SI."""
    usual = {unit, *unit.split("/")}
    for binding in env.scope.names.values():
        declaration = binding.declaration
        if not isinstance(declaration, Name) and _is_of(dimension, declaration):
            written = [part for whole in expressions(declaration) for part in parts(whole)]
            of_numbers = {part.unit for part in written if isinstance(part, Number) and part.unit}
            if of_numbers and not of_numbers & usual:
                return True
            # The unit of time behind the `/` of a speed is read as a name.
            names = {part.name for part in written if isinstance(part, Name)}
            if any(units.in_si(1.0, name) for name in names - usual):
                return True
    return False


def _is_of(dimension: Dimension, declaration: Declaration) -> bool:
    """Whether a declaration is of a signal or a param of this dimension, or has a parameter that is."""
    if isinstance(declaration, (SignalDecl, ParamDecl)):
        return units.TYPES.get(declaration.type or "") == dimension
    if isinstance(declaration, (LetDecl, PredicateDecl)):
        return any(units.TYPES.get(each.type or "") == dimension for each in declaration.parameters)
    return False


def mismatch(expected: Dimension, found: Dimension, at: Expr, env: Env, why: str) -> ResolutionError:
    """The problem of a quantity of the wrong dimension at ``at``."""
    while isinstance(at, Group):
        at = at.inner
    unit = units.si_unit(expected)
    advice, meant = None, ""
    if isinstance(at, Number):
        digits = env.scope.source.text[at.span.start : at.span.end]
        if at.unit and digits.endswith(at.unit):
            digits = digits[: -len(at.unit)].rstrip()
        meant = f"{digits} {unit}" if unit else digits if expected == units.PLAIN else ""
        why += f"; write `{meant}`" if meant else ""
        if expected == units.TYPES["angle"]:
            why, meant = f"{why} or `{digits} deg`", ""
        elif not _goes_on(at.unit, unit, found) or (unit and _has_other_units(expected, unit, env)):
            meant = ""
    elif unit:
        advice = f"give {units.described(expected)} there, e.g. `3 {unit}`"
    elif expected == units.PLAIN and "divide" not in why:
        advice = f"divide it by {units.described(found)} to get a number"
    title = f"expected {units.described(expected)}, found {units.described(found)}"
    fixes = (instead(env.scope.source, at.span, meant),) if meant else ()
    return problem("TLT0305", title, env.scope.source, at.span, why, advice=advice, fixes=fixes)
