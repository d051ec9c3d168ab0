"""Turn comparisons of numbers into atoms whose robustness is scaled to [-1, 1]."""

from __future__ import annotations

import sys
from math import inf

from tltlc.core.names import ComparisonName
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Edit, Fix, replacement_fix
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, NameExpr, NumberExpr, ParamDecl, SignalDecl
from tltlc.grammar.walk import expressions, parts
from tltlc.logic.formula import Formula, atom, not_
from tltlc.resolve import units
from tltlc.resolve.dimensions import same_dimension
from tltlc.resolve.enums import check_order
from tltlc.resolve.margins import robustness
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.quantities import check_steps
from tltlc.resolve.recall import check_closed, check_closed_pair, saturate, too_small_error, with_all_maxima
from tltlc.resolve.sums import sides
from tltlc.resolve.values import PRODUCT, Env, Quantity, apply, range_text

_MIRRORED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
_NEGATED = {"<=": ">", ">=": "<"}


def comparison(expr: BinaryExpr, env: Env) -> Formula:
    """Return the atom of a comparison such as ``health > 30``, or the negation of an atom.

    ``x >= c`` is ``not (x < c)``, and ``x <= c`` is ``not (x > c)``.

    The robustness of the atom says how clearly the comparison is true or false. For x in
    [low, high], the robustness of ``x > c`` is (x - c) / (high - c) where x is above c, and
    (x - c) / (c - low) where x is below c. So it is 1 at high and -1 at low, and it is above 0
    exactly where the comparison is true. The robustness of ``x < c`` is that of ``-x > -c``. If both
    sides vary, their difference is compared with 0.

    Raises ResolutionError if a side is no number or the units differ, if the ranges make the
    comparison always or never true (TLT0310), if a range that is needed for scaling has an infinite
    end (TLT0311), or if the arithmetic of a side may overflow (TLT0319).
    """
    levels = env.context.levels
    check_order(expr, env)
    check_steps(expr.left, expr.right, env)
    check_steps(expr.right, expr.left, env)
    try:
        left, right = sides(expr, env, levels)
    except ResolutionError as error:
        raise with_all_maxima(error, expr, env) from None
    same_dimension(left, right, expr.right, env)
    left, right = saturate(left, right, expr.right, env), saturate(right, left, expr.left, env)
    check_closed_pair(left, right, expr, env)
    left, right = check_closed(left, expr.left, env), check_closed(right, expr.right, env)
    op = expr.op
    if left.is_constant and not right.is_constant:
        op, left, right = _MIRRORED[op], right, left
    negated = op in _NEGATED
    strict = _NEGATED.get(op, op)
    if not right.is_constant and strict == "<":
        strict, left, right = ">", right, left
    name = ComparisonName(left.operand_text(PRODUCT - 1), strict, right.operand_text(PRODUCT - 1))
    if env.symbolic:
        return atom(name)
    _check_size(left, expr, env)
    _check_size(right, expr, env)
    _check_truth(left, strict, right, negated, expr, env)
    greater, less = (left, right) if strict == ">" else (right, left)
    formula = env.context.atom(name, robustness(greater, less), "", env.scope.source, expr.span)
    return not_(formula) if negated else formula


def _check_size(side: Quantity, expr: BinaryExpr, env: Env) -> None:
    """Raise ResolutionError (TLT0319) if the arithmetic of a side can overflow within its declared ranges."""
    if not side.overflows:
        return
    raise problem(
        "TLT0319",
        f"the result of `{side.text}` can be too large for a number",
        env.scope.source,
        expr.span,
        f"a number cannot be above {sys.float_info.max:.2e}",
        advice="declare smaller ranges for the signals and params that it is computed from",
    )


def _check_truth(left: Quantity, op: str, right: Quantity, negated: bool, expr: BinaryExpr, env: Env) -> None:
    """Raise ResolutionError if a comparison is always or never true, or cannot be scaled.

    The codes are TLT0310 for a comparison that is always or never true, and TLT0311 for one whose
    sides have no upper or lower end to scale by. ``op`` is ``<`` or ``>``. ``negated`` is true if the
    source text has the opposite of ``op``, that is, ``>=`` or ``<=``.
    """
    source = env.scope.source
    x, c = left, right.low
    if not right.is_constant:
        difference = apply("-", (left, right), left.dimension)
        assert difference is not None, "not all constant"
        x, c = difference, 0.0
    always = x.low > c if op == ">" else x.high < c
    never = x.high <= c if op == ">" else x.low >= c
    if always or never:
        if x.recall is not None and x.recall.limit is not None and x.high <= c:
            raise too_small_error(x, x.recall.limit, c)
        holds = always != negated
        message = f"`{x.text}` lies in {range_text(x.low, x.high, x.dimension)}"
        constant = "true" if holds else "false"
        advice = f"compare with a value inside that range, or write `{constant}`"
        fix: Fix | None = replacement_fix(source, expr.span, constant, "safe")
        if x.is_constant:
            message, advice = "both sides are constant", f"compare a signal, or write `{constant}`"
        elif _is_bool(expr.left, env) or _is_bool(expr.right, env):
            message = f"`{x.text}` is true or false"
            sign = source.slice(Span(expr.left.span.end, expr.span.end)) if _is_bool(expr.left, env) else "> 3"
            count = f"times({x.text}) {' '.join(sign.split())}"
            advice = f"write `{x.text}` or `not {x.text}`, or count how often it has begun, as in `{count}`"
            fix = _count_fix(expr, env)
        elif _is_percentage(x, c, op, expr, env):
            text, end = f"{' '.join(source.slice(expr.span).split())} %", expr.span.end
            advice = f"write `{text}`: a ratio is a number in [0, 1]"
            fix = Fix(f"Write `{text}`", (Edit(Span(end, end), " %"),))
        fixes = () if fix is None else (fix,)
        if source.text[expr.left.span.end :].lstrip().startswith("<-"):
            # This was most likely meant as an arrow that points to the left.
            fixes, advice = (), f"{advice}; write an implication as `b implies a`"
        title = f"this comparison {'always' if holds else 'never'} holds"
        raise problem("TLT0310", title, source, expr.span, message, advice=advice, fixes=fixes)
    missing_ends = [inf in (left.high, -right.low), inf in (-left.low, right.high)]
    if any(missing_ends):
        without_range = [side.text for side in (left, right) if inf in (side.high, -side.low)]
        raise _missing_range_error(x, missing_ends, without_range, expr, env)


def _is_percentage(x: Quantity, c: float, op: str, expr: BinaryExpr, env: Env) -> bool:
    """Whether a ratio is compared with a number that was probably meant in percent, as in ``health > 50``."""
    is_plain = isinstance(expr.right, NumberExpr) and expr.right.unit is None
    is_percentage = is_plain and (2 <= c < 100 or (c == 100 and op == "<"))
    return is_percentage and (x.low, x.high) == (0, 1) and _is_ratio(expr.left, env)


def _is_bool(expr: Expr, env: Env) -> bool:
    """Whether an expression is a signal that is true or false."""
    binding = env.scope.names.get(expr.name) if isinstance(expr, (NameExpr, CallExpr)) else None
    declaration = binding.declaration if binding else None
    return isinstance(declaration, SignalDecl) and declaration.type == "bool"


def _count_fix(expr: BinaryExpr, env: Env) -> Fix | None:
    """Return the fix that counts how often a bool has begun, as in `died > 3`; None for numbers below 2."""
    if not (isinstance(expr.right, NumberExpr) and expr.right.unit is None and expr.right.value >= 2):
        return None
    text = " ".join(env.scope.source.slice(expr.left.span).split())
    return replacement_fix(env.scope.source, expr.left.span, f"times({text})")


def _is_ratio(expr: Expr, env: Env) -> bool:
    """Whether an expression is a signal or param of type ``ratio``, or one with a range in percent."""
    binding = env.scope.names.get(expr.name) if isinstance(expr, NameExpr) else None
    declaration = binding.declaration if binding else None
    if not isinstance(declaration, (SignalDecl, ParamDecl)):
        return False
    range_parts = (part for expression in expressions(declaration) for part in parts(expression))
    return declaration.type == "ratio" or any(isinstance(part, NumberExpr) and part.unit == "%" for part in range_parts)


def _missing_range_error(
    x: Quantity, missing_ends: list[bool], without_range: list[str], expr: BinaryExpr, env: Env
) -> ResolutionError:
    unit = f" {units.si_unit(x.dimension)}" if x.dimension and units.si_unit(x.dimension) else ""
    ends = " and ".join(word for word, missing in zip(("upper", "lower"), missing_ends, strict=True) if missing)
    named = " and ".join(f"`{text}`" for text in without_range)
    return problem(
        "TLT0311",
        f"`{x.text}` has no {ends} bound to scale this comparison by",
        env.scope.source,
        expr.span,
        advice=f"declare a range with two ends for {named}, e.g. `in [0{unit}, 100{unit}]`, or use a predicate",
    )
