"""Resolve arithmetic to expressions over signals and params, and check units."""

from __future__ import annotations

from math import isinf
from typing import cast

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Fix, bracket_edits, replacement_fix
from tltlc.expression.tree import Condition, ConditionOp, Const, When
from tltlc.expression.tree import depth as depth_of
from tltlc.grammar import tree
from tltlc.grammar.tree import CallExpr, Expr, GroupExpr, NameExpr, NumberExpr
from tltlc.io.limits import ARITHMETIC
from tltlc.resolve import functions, units
from tltlc.resolve.arguments import match
from tltlc.resolve.counts_since import count_since_help, is_count_since
from tltlc.resolve.declared_values import param, signal, signal_value
from tltlc.resolve.dimensions import mismatch, same_dimension
from tltlc.resolve.enums import enum_as_number_error, enum_distance
from tltlc.resolve.kinds import check_let, entity_help, kind_in_words, kind_of, lookup
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.ranges import hull
from tltlc.resolve.recall import check_closed, saturate
from tltlc.resolve.scope import FUNCTIONS
from tltlc.resolve.spec import Signal
from tltlc.resolve.units import Dimension
from tltlc.resolve.values import LOOSEST, Env, Quantity, Unknown, apply, constant, number_text

_ARITHMETIC = ("+", "-", "*", "/", "^")
_COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")


def quantity(expr: Expr, env: Env, depth: int = 0) -> Quantity:
    """Resolve an arithmetic expression to a quantity: a number with a range and a dimension.

    ``depth`` is the number of operators around the expression. Raises ResolutionError if the
    expression is not a number, if its units do not fit, or if it has too many operators inside each
    other or too many arguments or cases.
    """
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    if depth > ARITHMETIC.depth:
        raise _too_deep_error(expr, env)
    result = _quantity(expr, env, depth + 1)
    if result.depth > ARITHMETIC.depth:
        raise _too_deep_error(expr, env)
    return result


def condition(expr: Expr, env: Env, depth: int = 0) -> tuple[Condition, str]:
    """Resolve the condition of a ``when``, and return it with its text.

    The text becomes a part of the name of an atom. ``depth`` is the number of operators around the
    expression. Raises ResolutionError (TLT0318) if the expression is no condition.
    """
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    if depth > ARITHMETIC.depth:
        raise _too_deep_error(expr, env)
    if isinstance(expr, tree.Unary) and expr.op == "not" and expr.bound is None:
        inner, text = condition(expr.operand, env, depth + 1)
        return Condition("not", (inner,)), f"not ({text})"
    if isinstance(expr, tree.BinaryExpr) and expr.op in ("and", "or"):
        left, left_text = condition(expr.left, env, depth + 1)
        right, right_text = condition(expr.right, env, depth + 1)
        op = cast(ConditionOp, expr.op)
        return Condition(op, (left, right)), f"({left_text}) {expr.op} ({right_text})"
    if isinstance(expr, tree.IsExpr) or (isinstance(expr, tree.BinaryExpr) and expr.op in ("==", "!=")):
        return _equality_condition(expr, env)
    if isinstance(expr, tree.BinaryExpr) and expr.op in _COMPARISONS:
        a, b = quantity(expr.left, env, depth), quantity(expr.right, env, depth)
        same_dimension(a, b, expr.right, env)
        a, b = saturate(a, b, expr.right, env), saturate(b, a, expr.left, env)
        a, b = check_closed(a, expr.left, env), check_closed(b, expr.right, env)
        op = cast(ConditionOp, expr.op)
        return Condition(op, (a.expression, b.expression)), f"{a.text} {expr.op} {b.text}"
    if isinstance(expr, (NameExpr, CallExpr)):
        value = quantity(expr, env, depth)
        if value.is_bool:
            return Condition(">", (value.expression, Const(0.5))), value.text
    raise problem(
        "TLT0318",
        "`when` needs a comparison",
        env.scope.source,
        expr.span,
        advice="compare two numbers, e.g. `when distance(target) < 2 m: …`, or use a `bool` signal",
    )


def _equality_condition(expr: tree.BinaryExpr | tree.IsExpr, env: Env) -> tuple[Condition, str]:
    from tltlc.resolve.equality import distance_of_sides

    if isinstance(expr, tree.IsExpr):
        distance, text = enum_distance(expr, env)
        is_equal = not expr.negated
    else:
        left, right, difference = distance_of_sides(expr, env)
        distance, text, is_equal = difference.expression, f"{left.text} {expr.op} {right.text}", expr.op == "=="
    return Condition("<" if is_equal else ">=", (distance, Const(0.5))), text


def _quantity(expr: Expr, env: Env, depth: int) -> Quantity:
    if isinstance(expr, NumberExpr):
        return _number(expr, env)
    if isinstance(expr, NameExpr):
        return _resolve_name(expr, env, depth)
    if isinstance(expr, CallExpr):
        if expr.name in FUNCTIONS and expr.name not in env.local:
            functions.check_arguments(expr, env)
            if len(expr.arguments) > ARITHMETIC.parts:
                raise _too_wide_error(f"`{expr.name}` has more than {ARITHMETIC.parts} arguments here", expr, env)
            values = tuple(quantity(argument.value, env, depth) for argument in expr.arguments)
            return _apply_operator(expr.name, values, functions.dimension(expr, values, env), expr, env)
        from tltlc.resolve import memory

        if memory.is_memory(expr, env):
            if env.constant:
                raise _not_constant_error(expr, env)
            return memory.recall(expr, env, depth)
        return _resolve_name(expr, env, depth)
    if isinstance(expr, tree.Unary) and expr.op == "-":
        operand = quantity(expr.operand, env, depth)
        return _apply_operator("neg", (operand,), operand.dimension, expr, env)
    if isinstance(expr, tree.BinaryExpr) and expr.op in _ARITHMETIC:
        return _infix(expr, env, depth)
    if isinstance(expr, tree.WhenExpr):
        return _when(expr, env, depth)
    raise _not_a_number_error(expr, env)


def _number(expr: NumberExpr, env: Env) -> Quantity:
    in_si = units.in_si(expr.value, expr.unit)
    if in_si is None:
        raise problem(
            "TLT0304",
            f"`{expr.unit}` cannot be used in arithmetic",
            env.scope.source,
            expr.span,
            advice="steps count samples: use them only in bounds such as `within 20 steps` and in `limit`, and compare "
            f"times with seconds{_in_seconds(expr, env)}",
        )
    value, dimension = in_si
    if isinf(value):
        advice = "write a number that is finite in SI units"
        raise problem("TLT0109", "this number is too large", env.scope.source, expr.span, advice=advice)
    return constant(value, None if value == 0 and expr.unit is None else dimension)


def _in_seconds(steps: NumberExpr, env: Env) -> str:
    """Return how long a number of steps takes, for a help; "" if the clock does not say it."""
    seconds, is_exact = _seconds(steps, env)
    verb, about = "is" if steps.value == 1 else "are", "" if is_exact else "about "
    text = f"`{number_text(steps.value)} {steps.unit}` {verb} {about}`{seconds}` with this clock"
    return f": {text}" if seconds else ""


def _seconds(steps: NumberExpr, env: Env) -> tuple[str, bool]:
    """Return how long a number of steps takes, "" if the clock does not say it, and whether the text is exact."""
    clock_s = env.context.clock_s
    if not clock_s:
        return "", False
    seconds = f"{steps.value * clock_s:.6g}"
    return f"{seconds} s", abs(float(seconds) - steps.value * clock_s) < 1e-12


def check_steps(number: Expr, other: Expr, env: Env) -> None:
    """Raise ResolutionError (TLT0304) with a fix if a time is compared with a number of steps of known length."""
    if not isinstance(number, NumberExpr) or units.in_si(number.value, number.unit) is not None:
        return
    seconds, is_exact = _seconds(number, env)
    if is_exact and quantity(other, env, env.context.levels).dimension == units.TYPES["time"]:
        title, source = "a time is compared with seconds, not with steps", env.scope.source
        advice = f"write `{seconds}`{_in_seconds(number, env)}"
        fixes = (replacement_fix(source, number.span, seconds),)
        raise problem("TLT0304", title, source, number.span, advice=advice, fixes=fixes)


def _resolve_name(expr: NameExpr | CallExpr, env: Env, depth: int) -> Quantity:
    local = env.local.get(expr.name)
    if local is not None:
        if isinstance(local, Quantity) and isinstance(expr, NameExpr):
            return local
        if isinstance(local, Unknown):
            placeholder = Signal(local.name, "number", None, None)
            env.context.signals.setdefault(placeholder.name, placeholder)
            return replace(signal_value(placeholder), dimension=None, is_whole=True)
        raise _not_a_number_error(expr, env)
    if env.constant:
        raise _not_constant_error(expr, env)
    if expr.name == "inf" and "inf" not in env.scope.names:
        title = "`inf` can only be used as an end of a range"
        raise problem("TLT0303", title, env.scope.source, expr.span, advice="write a number")
    binding = lookup(expr, env, ("signal", "param", "predicate"), "signal or param")
    if binding.kind == "param":
        match(expr, binding, (), env.scope)
        return param(binding, env)
    if binding.kind == "signal":
        if isinstance(binding.declaration, tree.SignalDecl) and binding.declaration.values:
            raise enum_as_number_error(expr, binding.declaration.values, env)
        return signal(expr, binding, env)
    if binding.kind == "predicate":
        from tltlc.resolve.predicates import predicate

        return predicate(expr, binding, env, depth).value
    if isinstance(binding.declaration, tree.LetDecl):
        # If the body is a number, the mistake is in the definition.
        check_let(binding.declaration, env.inside(binding.scope, {}))
    raise _not_a_number_error(expr, env)


def _infix(expr: tree.BinaryExpr, env: Env, depth: int) -> Quantity:
    left = quantity(expr.left, env, depth)
    if _is_per_time(expr, env):
        assert isinstance(expr.right, NameExpr)
        scale, dimension = units.in_si(1.0, expr.right.name) or (1.0, units.PLAIN)
        per = constant(scale, dimension)
        return _apply_operator("/", (left, per), units.product(left.dimension, dimension, -1.0), expr, env)
    _check_speed(expr, env)
    right = quantity(expr.right, env, depth)
    left, right = check_closed(left, expr.left, env), check_closed(right, expr.right, env)
    if expr.op in ("+", "-"):
        return _apply_operator(expr.op, (left, right), same_dimension(left, right, expr.right, env), expr, env)
    if expr.op == "^":
        return _power(expr, left, right, env)
    dimension_ = units.product(left.dimension, right.dimension, 1.0 if expr.op == "*" else -1.0)
    return _apply_operator(expr.op, (left, right), dimension_, expr, env)


def _is_per_time(expr: tree.BinaryExpr, env: Env) -> bool:
    """Whether a division is a literal speed such as ``3 m/s``.

    The lexer reads the ``s`` as a name. If a signal or param is called ``s``, the division is by it,
    except in a constant, which can contain neither.
    """
    left, per = expr.left, expr.right
    if isinstance(left, tree.Unary) and left.op == "-":
        left = left.operand
    if expr.op != "/" or not isinstance(left, NumberExpr) or left.unit is None:
        return False
    if not isinstance(per, NameExpr) or per.name not in units.time_units() or per.name in env.local:
        return False
    declared = env.scope.names.get(per.name)
    return env.constant or declared is None or declared.kind not in ("param", "signal")


def _check_speed(expr: tree.BinaryExpr, env: Env) -> None:
    """Raise ResolutionError (TLT0304) for ``a / 1 m/s`` without brackets around the speed.

    The parser reads this as ``(a / 1 m) / s``. There is no error if ``s`` is declared, since the
    author may mean this.
    """
    inner, per = expr.left, expr.right
    if (
        expr.op != "/"
        or not isinstance(inner, tree.BinaryExpr)
        or inner.op not in ("*", "/")
        or not isinstance(per, NameExpr)
    ):
        return
    speed = replace(expr, left=inner.right)
    if per.name not in env.scope.names and _is_per_time(speed, env):
        span = inner.right.span.to(per.span)
        text = f"({' '.join(env.scope.source.slice(span).split())})"
        raise problem(
            "TLT0304",
            "a speed needs brackets here",
            env.scope.source,
            span,
            f"write `{text}`",
            advice="`*` and `/` are read from left to right: `a / 1 m/s` means `(a / 1 m) / s`",
            fixes=(Fix(f"Write `{text}`", bracket_edits(span)),),
        )


def _power(expr: tree.BinaryExpr, base: Quantity, exponent: Quantity, env: Env) -> Quantity:
    if exponent.dimension not in (None, units.PLAIN):
        raise mismatch(units.PLAIN, exponent.dimension, expr.right, env, "an exponent is a number")
    if base.dimension in (None, units.PLAIN):
        return _apply_operator("^", (base, exponent), units.PLAIN, expr, env)
    if not isinstance(exponent.expression, Const):
        raise problem(
            "TLT0305",
            f"{units.dimension_text(base.dimension)} needs a constant exponent",
            env.scope.source,
            expr.right.span,
            advice="write a number here, or first divide the base by a quantity of the same kind",
        )
    return _apply_operator("^", (base, exponent), units.power(base.dimension, exponent.expression.value), expr, env)


def _when(expr: tree.WhenExpr, env: Env, depth: int) -> Quantity:
    if len(expr.cases) > ARITHMETIC.parts:
        raise _too_wide_error(f"this `when` has more than {ARITHMETIC.parts} cases", expr, env)
    tests: list[tuple[Condition, str]] = []
    values: list[Quantity] = []
    for case in expr.cases:
        tests.append(condition(case.condition, env, depth))
        values.append(check_closed(quantity(case.value, env, depth), case.value, env))
    otherwise = check_closed(quantity(expr.otherwise, env, depth), expr.otherwise, env)
    values.append(otherwise)
    # A test may compare a value that was computed earlier, whose expression may be deep.
    deepest = max([*(value.depth for value in values), *(depth_of(test) for test, _ in tests)])
    typical = next((value for value in values if value.dimension is not None), otherwise)
    for value, at in zip(values, [*(case.value for case in expr.cases), expr.otherwise], strict=True):
        same_dimension(typical, value, at, env)
    # The last value, `otherwise`, has no test.
    cases = tuple((test, value.expression) for (test, _), value in zip(tests, values, strict=False))
    texts = [f"when {text}: {value.text}" for (_, text), value in zip(tests, values, strict=False)]
    return Quantity(
        When(cases, otherwise.expression),
        typical.dimension,
        *hull(tuple((value.low, value.high) for value in values)),
        " ".join([*texts, f"otherwise: {otherwise.text}"]),
        LOOSEST,
        1 + deepest,
        overflows=any(value.overflows for value in values),
        is_whole=all(value.is_whole for value in values),
    )


def _apply_operator(op: str, args: tuple[Quantity, ...], dimension: Dimension | None, expr: Expr, env: Env) -> Quantity:
    args = tuple(check_closed(arg, expr, env) for arg in args)
    result = apply(op, args, dimension)
    if result is None:
        text = f"{args[0].text} {op} {args[1].text}" if op in _ARITHMETIC else f"{op}({args[0].text})"
        advice = "write numbers that give a finite value"
        raise problem("TLT0309", f"`{text}` has no value", env.scope.source, expr.span, advice=advice)
    return result


def _not_constant_error(expr: NameExpr | CallExpr, env: Env) -> ResolutionError:
    return problem(
        "TLT0302",
        "expected a constant here",
        env.scope.source,
        expr.span,
        "only numbers and arithmetic with numbers are allowed here",
        advice=f"write a number in place of `{expr.name}`",
    )


def _not_a_number_error(expr: Expr, env: Env) -> ResolutionError:
    advice = "arithmetic takes numbers: signals, params and predicates"
    if isinstance(expr, tree.IsExpr) or (isinstance(expr, tree.BinaryExpr) and expr.op in _COMPARISONS):
        advice = "a comparison is a formula: name one with `let rich = coins > 30`, and join two with `and`"
    elif is_count_since(expr, env):
        advice = count_since_help(expr, env)
    elif kind_of(expr, env) == "entity":
        advice = entity_help(env.scope.source.slice(expr.span), env, number=True)
    title = f"expected a number, found {kind_in_words(expr, env)}"
    return problem("TLT0302", title, env.scope.source, expr.span, advice=advice)


def _too_deep_error(expr: Expr, env: Env) -> ResolutionError:
    # Report this once for all predicates being expanded. Otherwise a chain of n predicates is followed n times.
    env.context.broken.update(env.context.expanding)
    return problem(
        "TLT0317",
        f"this arithmetic is more than {ARITHMETIC.depth} operators deep",
        env.scope.source,
        expr.span,
        advice="let the game compute the value and supply it as a signal",
    )


def _too_wide_error(title: str, expr: Expr, env: Env) -> ResolutionError:
    advice = "let the game compute the value and supply it as a signal"
    return problem("TLT0317", title, env.scope.source, expr.span, advice=advice)
