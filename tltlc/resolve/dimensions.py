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
    """Return the common dimension of two quantities that are added or compared.

    A quantity without a dimension (None), such as 0, fits any other; the result is None if both have
    none. Raises ResolutionError (TLT0305) at ``at`` if the dimensions differ.
    """
    if left.dimension is None or right.dimension is None or left.dimension == right.dimension:
        return left.dimension if left.dimension is not None else right.dimension
    raise mismatch(left.dimension, right.dimension, at, env, f"the left side is {units.dimension_text(left.dimension)}")


def _keeps_value(written_unit: str | None, expected_unit: SiUnit | None, actual: Dimension) -> bool:
    """Whether the fix for a wrong unit may keep the number and only change the unit after it.

    If a unit is expected, the fix may add it to a plain number (``3`` to ``3 m``), or complete a
    speed (``3 m`` to ``3 m/s``). If a plain number is expected, the fix may drop the SI unit of the
    dimension ``actual`` (``3 m`` to ``3``), but no other unit: 3 km are not 3.
    """
    if expected_unit is None:
        unit = units.si_unit(actual)
        return written_unit == (unit and str(unit))
    return written_unit is None or (expected_unit.denominator is not None and written_unit == expected_unit.numerator)


def _has_other_units(dimension: Dimension, unit: SiUnit, env: Env) -> bool:
    """Whether some visible declaration of this dimension is written in units other than the SI unit.

    An example is ``signal depth: length in [0 cm, 50 cm]``. Looks at signals and params, and at
    predicates and ``let`` definitions with a parameter of this dimension.
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
    """Whether a declaration is a signal or param of this dimension, or has a parameter of this dimension."""
    if isinstance(declaration, (SignalDecl, ParamDecl)):
        return units.TYPES.get(declaration.type or "") == dimension
    if isinstance(declaration, (LetDecl, PredicateDecl)):
        return any(units.TYPES.get(parameter.type or "") == dimension for parameter in declaration.parameters)
    return False


def mismatch(
    expected: Dimension, actual: Dimension, at: Expr, env: Env, why: str, *, help_is_in_why: bool = False
) -> ResolutionError:
    """Return the error (TLT0305) for the expression ``at``, which has the wrong dimension.

    ``why`` is a text for the message that says where the expected dimension comes from. Set
    ``help_is_in_why`` if the text also says what to do; then the error does not advise to divide.
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
