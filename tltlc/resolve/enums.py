"""Resolve enums: ``signal mode: (idle, alert)`` is an integer whose values have names, 0 and 1 in order."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from tltlc.core.names import ComparisonName
from tltlc.diagnostics.diagnostic import Label, replacement_fix
from tltlc.expression.tree import Const, Expression, Op
from tltlc.grammar.mistakes.misused_operators import misused_operator
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, GroupExpr, IsExpr, NameExpr, NumberExpr, SignalDecl
from tltlc.grammar.typos import likely_name
from tltlc.logic.formula import Formula, atom, not_
from tltlc.resolve.context import SignalInfo
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.scope import Binding, Scope
from tltlc.resolve.values import Env, Quantity

_MOST_NAMES = 8
"""The most values that a message lists."""
_NUMBERS = ("true", "false", "inf", "infinity", "nan")
"""Words that traces read as numbers, in any capitals."""


def is_value(expr: IsExpr, env: Env) -> Formula:
    """Return the atom of a test for a value of an enum, such as ``mode(g1) is alert``, or its negation.

    The robustness of the atom is 1 at the value and -1 at every other value. In between, for numbers
    that are not whole, it is ``1 - 2 * abs(mode - value)``.

    Raises ResolutionError if the left side is no enum (TLT0101), or has no such value (TLT0201).
    """
    signal, place = enum_test(expr, env)
    name = ComparisonName(signal.text, "is", expr.value)
    if env.symbolic:
        return atom(name)
    robustness = Op("max", (Op("-", (Const(1.0), Op("*", (Const(2.0), _distance(signal, place))))), Const(-1.0)))
    formula = env.context.atom(name, robustness, "", env.scope.source, expr.span)
    env.context.values_of_signals[name] = signal.text
    return not_(formula) if expr.negated else formula


def enum_test(expr: IsExpr, env: Env) -> tuple[Quantity, int]:
    """Return the enum signal of a test, as a quantity, and the place of the value among its values.

    Raises ResolutionError if the left side is no enum (TLT0101), or has no such value (TLT0201).
    """
    from tltlc.resolve.declared_values import signal

    operand = _without_brackets(expr.operand)
    binding = _enum_binding(operand, env)
    if binding is None:
        _check_reported(operand, env)
        raise ResolutionError(misused_operator(env.scope.source, expr.is_span))
    assert isinstance(operand, (NameExpr, CallExpr))
    enum = signal(operand, binding, env)
    names = _info(binding, env).values
    if expr.value not in names:
        raise _unknown_value(expr, binding.name, names, env)
    return enum, names.index(expr.value)


def enum_distance(expr: IsExpr, env: Env) -> tuple[Expression, str]:
    """Return the distance between an enum signal and a value, as an expression, and the test as a text."""
    signal, place = enum_test(expr, env)
    return _distance(signal, place), f"{signal.text} is {'not ' * expr.negated}{expr.value}"


def enum_of(expr: Expr, env: Env) -> SignalInfo | None:
    """Return the declaration of the enum signal that an expression is, or None if it is something else."""
    binding = _enum_binding(_without_brackets(expr), env)
    return None if binding is None else _info(binding, env)


def value_names(declaration: SignalDecl, scope: Scope) -> tuple[str, ...]:
    """Return the names of the values of an enum that a declaration lists; empty if the signal is no enum.

    Raises ResolutionError: TLT0202 a name is listed twice, TLT0303 there is only one, TLT0101 a name
    has dots, or is a number in traces.
    """
    first: dict[str, Label] = {}
    for value in declaration.values:
        place = Label(scope.source, value.span, "first listed here")
        if "." in value.name:
            title, advice = "a value of an enum cannot contain dots", f"write `{value.name.replace('.', '_')}`"
            raise problem("TLT0101", title, scope.source, value.span, advice=advice)
        if value.name.lower() in _NUMBERS:
            title, advice = (
                f"a value of an enum cannot be called `{value.name}`",
                "traces read it as a number: rename it",
            )
            raise problem("TLT0101", title, scope.source, value.span, advice=advice)
        if value.name in first:
            title = f"`{declaration.name}` has the value `{value.name}` twice"
            advice, related = "leave one out, or rename it", (first[value.name],)
            raise problem("TLT0202", title, scope.source, value.span, "again here", advice=advice, related=related)
        first[value.name] = place
    if len(first) == 1:
        title = f"`{declaration.name}` has only one value"
        raise problem("TLT0303", title, scope.source, declaration.values[0].span, advice="list at least two values")
    return tuple(first)


def enum_as_number_error(expr: NameExpr | CallExpr, values: Iterable[NameExpr], env: Env) -> ResolutionError:
    """Return the error for an enum in arithmetic, or compared with ``<`` or ``>``."""
    text = env.scope.source.slice(expr.span)
    title = f"expected a number, found the enum `{text}`"
    advice = f"compare it with one of its values, e.g. `{text} is {next(iter(values)).name}`"
    return problem("TLT0302", title, env.scope.source, expr.span, advice=advice)


def check_order(expr: BinaryExpr, env: Env) -> None:
    """Raise ResolutionError (TLT0302) with a fix for `boss >= previous(boss)`: an enum goes through its values once."""
    for side, other in ((expr.left, expr.right), (expr.right, expr.left)):
        call, info = _without_brackets(other), enum_of(side, env)
        if info is None or not isinstance(call, CallExpr) or call.name != "previous" or len(call.arguments) != 1:
            continue
        name = env.scope.source.slice(side.span)
        if call.name in env.scope.names or env.scope.source.slice(call.arguments[0].value.span) != name:
            continue
        is_rising = (expr.op in (">", ">=")) == (side is expr.left)
        values = info.values if is_rising else info.values[::-1]
        rules = []
        for at, value in enumerate(values[:-1]):
            later = " or ".join(f"{name} is {each}" for each in values[at + 1 :])
            rules.append(f"({name} is {value} implies not previously ({later}))")
        text = f"({' and '.join(rules)})" if rules[1:] else rules[0]
        advice = f"an enum has no order: write `{text}`, in the order of its declaration"
        title = f"expected a number, found the enum `{name}`"
        fixes = (replacement_fix(env.scope.source, expr.span, text),)
        raise problem("TLT0302", title, env.scope.source, side.span, advice=advice, fixes=fixes)


def enum_as_formula_error(expr: Expr, info: SignalInfo, env: Env) -> ResolutionError:
    """Return the error for an enum in place of a formula."""
    text = env.scope.source.slice(expr.span)
    title = f"expected a formula, found the enum `{text}`"
    advice = f"compare it with one of its values, e.g. `{text} is {info.values[0]}`"
    return problem("TLT0301", title, env.scope.source, expr.span, advice=advice)


def equality_error(expr: BinaryExpr, side: Expr, info: SignalInfo, other: Expr, env: Env) -> ResolutionError:
    """Return the error for an enum that is compared with ``==`` or ``!=``; ``side`` is the enum."""
    source, word = env.scope.source, "is" if expr.op == "==" else "is not"
    names, value, reason = info.values, None, ""
    if isinstance(other, NameExpr) and other.name in names:
        value = other.name
    elif isinstance(other, NumberExpr) and other.unit is None and other.value in range(len(names)):
        value = names[int(other.value)]
        reason = f": `{value}` is the value with the number {int(other.value)}"
    if isinstance(other, CallExpr) and other.name in _BEFORE and [source.slice(side.span)] == _arguments(other, env):
        return _change_error(expr, source.slice(side.span), names, env)
    text = f"{source.slice(side.span)} {word} {value or names[0]}"
    fixes = (replacement_fix(source, expr.span, text, "safe"),) if value else ()
    title = f"`{expr.op}` compares numbers, and `{source.slice(side.span)}` is an enum"
    advice = f"write `{text}`{reason}" if value else f"write e.g. `{text}`: its values are {_listed(names)}"
    return problem("TLT0110", title, source, expr.span, advice=advice, fixes=fixes)


_BEFORE = ("prev", "previous", "pre", "old", "previously")
"""Functions for the value at the sample before."""


def _arguments(call: CallExpr, env: Env) -> list[str]:
    return [env.scope.source.slice(argument.span) for argument in call.arguments]


def _change_error(expr: BinaryExpr, name: str, values: Sequence[str], env: Env) -> ResolutionError:
    """Return the error for an enum that is compared with its value at the sample before."""
    if expr.op == "==":
        parts = [f"(previously {name} is {value} implies {name} is {value})" for value in values]
    else:
        parts = [f"(previously {name} is {value} and {name} is not {value})" for value in values]
    text = f"({(' and ' if expr.op == '==' else ' or ').join(parts)})"
    source = env.scope.source
    title = f"`{expr.op}` compares numbers, and `{name}` is an enum"
    advice = f"write `{text}`: an enum is compared with its values, one by one"
    return problem(
        "TLT0110", title, source, expr.span, advice=advice, fixes=(replacement_fix(source, expr.span, text),)
    )


def exclusive_values(
    names: Iterable[str], groups: Iterable[Sequence[str]], signals: Mapping[str, str]
) -> list[tuple[str, ...]]:
    """Return the groups of atoms that compare one signal with different values: at most one of a group holds.

    ``names`` are the atoms of a spec. ``signals`` maps each atom that compares an integer or enum
    signal with a value to the name of the signal. A group that lies within one of ``groups`` is left out.
    """
    by_signal: dict[str, list[str]] = {}
    for name in names:
        if name in signals:
            by_signal.setdefault(signals[name], []).append(name)
    known = [set(group) for group in groups]
    return [
        tuple(group)
        for group in by_signal.values()
        if len(group) > 1 and not any(other.issuperset(group) for other in known)
    ]


def _distance(signal: Quantity, place: int) -> Expression:
    difference = Op("-", (signal.expression, Const(float(place)))) if place else signal.expression
    return Op("abs", (difference,))


def _without_brackets(expr: Expr) -> Expr:
    while isinstance(expr, GroupExpr):
        expr = expr.inner
    return expr


def _enum_binding(expr: Expr, env: Env) -> Binding | None:
    if not isinstance(expr, (NameExpr, CallExpr)) or expr.name in env.local:
        return None
    binding = env.scope.names.get(expr.name)
    is_enum = binding is not None and isinstance(binding.declaration, SignalDecl) and binding.declaration.values
    return binding if is_enum else None


def _check_reported(expr: Expr, env: Env) -> None:
    """Raise ResolutionError without a diagnostic if an expression is a signal whose declaration is in error."""
    if isinstance(expr, (NameExpr, CallExpr)) and expr.name not in env.local:
        binding = env.scope.names.get(expr.name)
        if binding is not None and binding.kind == "signal":
            _info(binding, env)


def _info(binding: Binding, env: Env) -> SignalInfo:
    info = env.context.signal_infos.get(binding.name)
    if info is None:
        # The declaration has already been reported.
        raise ResolutionError(None)
    return info


def _unknown_value(expr: IsExpr, enum: str, names: tuple[str, ...], env: Env) -> ResolutionError:
    suggestion = likely_name(expr.value, names)
    hint = f"did you mean `{suggestion}`?" if suggestion else ""
    fixes = (replacement_fix(env.scope.source, expr.value_span, suggestion),) if suggestion else ()
    title = f"`{enum}` has no value `{expr.value}`"
    advice = None if suggestion else f"its values are {_listed(names)}"
    return problem("TLT0201", title, env.scope.source, expr.value_span, hint, advice=advice, fixes=fixes)


def _listed(names: Sequence[str]) -> str:
    """Return the values of an enum as a message lists them."""
    return ", ".join(f"`{name}`" for name in names[:_MOST_NAMES]) + (", …" if len(names) > _MOST_NAMES else "")
