"""Check units: numbers that are added, compared or passed must have one dimension (TLT0305)."""

from __future__ import annotations

from tltlc.diagnostics.diagnostic import replacement_fix
from tltlc.grammar.tree import (
    Declaration,
    Expr,
    GroupExpr,
    LetDecl,
    NameExpr,
    NumberExpr,
    ParamDecl,
    PredicateDecl,
    SignalDecl,
)
from tltlc.grammar.walk import expressions, parts
from tltlc.resolve import units
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.units import Dimension, SiUnit
from tltlc.resolve.values import Env, Quantity


def same_dimension(left: Quantity, right: Quantity, at: Expr, env: Env) -> Dimension | None:
    """Return the dimension of two quantities that are added or compared.

    A dimension that is None fits any other. Raises ResolutionError (TLT0305) at ``at`` if the
    dimensions differ.
    """
    if left.dimension is None or right.dimension is None or left.dimension == right.dimension:
        return left.dimension if left.dimension is not None else right.dimension
    raise mismatch(left.dimension, right.dimension, at, env, f"the left side is {units.dimension_text(left.dimension)}")


def _keeps_value(written_unit: str | None, expected_unit: SiUnit | None, actual: Dimension) -> bool:
    """Whether the fix for a wrong unit may keep the number and only change the unit after it.

    It may if no unit was written, or if the written unit is the numerator of the expected one, as
    ``m`` is that of ``m/s``. If no unit is expected, the written unit must be the SI unit.
    """
    if expected_unit is None:
        unit = units.si_unit(actual)
        return written_unit == (unit and str(unit))
    return written_unit is None or (expected_unit.denominator is not None and written_unit == expected_unit.numerator)


def _has_other_units(dimension: Dimension, unit: SiUnit, env: Env) -> bool:
    """Whether a visible declaration of this dimension uses units other than the SI unit.

    Looks at signals, params, and the parameters of lets and predicates.
    """
    usual = {unit.numerator, unit.denominator}
    for binding in env.scope.names.values():
        declaration = binding.declaration
        if not isinstance(declaration, NameExpr) and _has_dimension(dimension, declaration):
            range_parts = [part for expression in expressions(declaration) for part in parts(expression)]
            number_units = {part.unit for part in range_parts if isinstance(part, NumberExpr) and part.unit}
            if number_units and not number_units & usual:
                return True
            # The unit of time after the `/` of a speed is parsed as a name.
            names = {part.name for part in range_parts if isinstance(part, NameExpr)}
            if any(units.in_si(1.0, name) for name in names - usual):
                return True
    return False


def _has_dimension(dimension: Dimension, declaration: Declaration) -> bool:
    """Whether a declaration is a signal or param of this dimension, or has a parameter of it."""
    if isinstance(declaration, (SignalDecl, ParamDecl)):
        return units.TYPES.get(declaration.type or "") == dimension
    if isinstance(declaration, (LetDecl, PredicateDecl)):
        return any(units.TYPES.get(parameter.type or "") == dimension for parameter in declaration.parameters)
    return False


def mismatch(
    expected: Dimension, actual: Dimension, at: Expr, env: Env, why: str, *, help_is_in_why: bool = False
) -> ResolutionError:
    """Return the error for the expression ``at``, which has the wrong dimension.

    ``why`` says in the message where the expected dimension comes from. If it also says what to do
    (``help_is_in_why``), the error gets no help to divide by a unit.
    """
    while isinstance(at, GroupExpr):
        at = at.inner
    unit = units.si_unit(expected)
    advice, replacement = None, ""
    if isinstance(at, NumberExpr):
        digits = env.scope.source.text[at.span.start : at.span.end]
        if at.unit and digits.endswith(at.unit):
            digits = digits[: -len(at.unit)].rstrip()
        replacement = f"{digits} {unit}" if unit else digits if expected == units.PLAIN else ""
        why += f"; write `{replacement}`" if replacement else ""
        if expected == units.TYPES["angle"]:
            why, replacement = f"{why} or `{digits} deg`", ""
        elif not _keeps_value(at.unit, unit, actual) or (unit and _has_other_units(expected, unit, env)):
            replacement = ""
    elif unit:
        advice = f"write {units.dimension_text(expected)} here, e.g. `3 {unit}`"
    elif expected == units.PLAIN and not help_is_in_why:
        advice = f"divide it by {units.dimension_text(actual)} to get a number"
    title = f"expected {units.dimension_text(expected)}, found {units.dimension_text(actual)}"
    fixes = (replacement_fix(env.scope.source, at.span, replacement),) if replacement else ()
    return problem("TLT0305", title, env.scope.source, at.span, why, advice=advice, fixes=fixes)
