"""Resolve the numbers that the steps of a test set: ``step health = 40, mode = alert``.

A `bool` that only predicates read is set likewise: ``step hidden = true``.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from tltlc.core.record import record
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import replacement_fix
from tltlc.grammar.tree import BinaryExpr, CallExpr, Constant, Expr, NameExpr, TestDecl, TestStep
from tltlc.grammar.typos import likely_name
from tltlc.resolve import units
from tltlc.resolve.computed_atoms import computed, is_number_in_tests
from tltlc.resolve.constants import number
from tltlc.resolve.declared_values import signal
from tltlc.resolve.problem import problem
from tltlc.resolve.spec import Signal, Spec
from tltlc.resolve.values import Env, number_text, range_text


@record
class Settings:
    """The numbers that each step of a test sets, and the names of the atoms that follow from them."""

    values: Mapping[TestStep, Mapping[str, float]]
    computed: frozenset[str]


def is_setting(expr: Expr) -> bool:
    """Whether an item of a step sets a number, as in ``health = 40``; the others name atoms."""
    return isinstance(expr, BinaryExpr) and expr.op == "="


def settings_of(declaration: TestDecl, spec: Spec, env: Env) -> Settings:
    """Return the numbers that a test sets.

    Raises ResolutionError: TLT0201 an enum or a `bool` has no such value, TLT0209 the spec has no such
    signal, TLT0217 a signal is a `bool` and an atom by itself, is set twice in a step, is not set in the
    first step, or does not decide an atom alone, TLT0307 a value is outside its range, and the errors of
    constants.
    """
    steps = [item for item in declaration.items if isinstance(item, TestStep)]
    values: dict[TestStep, Mapping[str, float]] = {}
    places: dict[str, Span] = {}
    for step in steps:
        set_here: dict[str, float] = {}
        for item in step.atoms:
            if isinstance(item, BinaryExpr) and is_setting(item):
                known = _signal(item.left, spec, env)
                if known.name in set_here:
                    title = f"`{known.name}` has two values in the same step"
                    raise problem("TLT0217", title, env.scope.source, item.span, advice="leave one out")
                set_here[known.name] = _value(item.right, known, env)
                places.setdefault(known.name, item.span)
        values[step] = set_here
    for name, place in places.items():
        if name not in values[steps[0]]:
            title = f"`{name}` has no value in the first step"
            advice = "set it there, too: a number keeps its value until a step sets another"
            raise problem("TLT0217", title, env.scope.source, place, advice=advice)
    result = computed(places, spec.atoms, spec.registers, spec.signals)
    for name, lacking in result.lacking.items():
        title = f"`{name}` also depends on `{lacking[0]}`, which this test does not set"
        place = next(iter(places.values()))
        is_bool = any(item.name == lacking[0] and item.type == "bool" for item in spec.signals)
        example = f", as in `{lacking[0]} = true`" if is_bool else ""
        advice = f"set `{lacking[0]}` in the first step, too{example}"
        raise problem("TLT0217", title, env.scope.source, place, advice=advice)
    return Settings(values, result.atoms)


def _signal(expr: Expr, spec: Spec, env: Env) -> Signal:
    """Return the signal of a spec that a step sets."""
    source = env.scope.source
    own_atoms = {atom.name for atom in spec.atoms}
    text = " ".join(source.slice(expr.span).split())
    binding = env.scope.names.get(expr.name) if isinstance(expr, (NameExpr, CallExpr)) else None
    named = signal(expr, binding, env).text if binding is not None and binding.kind == "signal" else text  # type: ignore[arg-type]
    known = next((item for item in spec.signals if item.name == named), None)
    if known is None:
        names = tuple(item.name for item in spec.signals if is_number_in_tests(item, own_atoms))
        suggestion = likely_name(named, names)
        fixes = (replacement_fix(source, expr.span, suggestion),) if suggestion else ()
        listed = ", ".join(f"`{name}`" for name in names)
        advice = f"it reads {listed}" if names else "it reads no numbers: name atoms, as in `step a, not b`"
        title = f"the spec `{spec.name}` reads no signal `{text}`"
        hint = f"did you mean `{suggestion}`?" if suggestion else ""
        raise problem("TLT0209", title, source, expr.span, hint, advice=None if suggestion else advice, fixes=fixes)
    if not is_number_in_tests(known, own_atoms):
        title, advice = f"`{text}` is a `bool`, and an atom by itself", f"write `{text}` or `not {text}`"
        raise problem("TLT0217", title, source, expr.span, advice=advice)
    return known


def _value(expr: Expr, known: Signal, env: Env) -> float:
    """Return the value to which a step sets a signal, in SI units."""
    source = env.scope.source
    if known.type == "bool":
        if isinstance(expr, Constant):
            return float(expr.value)
        title = f"`{known.name}` has no value `{source.slice(expr.span)}`"
        raise problem("TLT0201", title, source, expr.span, advice="it is a `bool`: write `true` or `false`")
    if known.values:
        name = expr.name if isinstance(expr, NameExpr) else ""
        if name in known.values:
            return float(known.values.index(name))
        suggestion = likely_name(name, known.values) if name else None
        fixes = (replacement_fix(source, expr.span, suggestion),) if suggestion else ()
        hint = f"did you mean `{suggestion}`?" if suggestion else ""
        listed = ", ".join(f"`{value}`" for value in known.values)
        title = f"`{known.name}` has no value `{source.slice(expr.span)}`"
        advice = None if suggestion else f"its values are {listed}"
        raise problem("TLT0201", title, source, expr.span, hint, advice=advice, fixes=fixes)
    value = number(expr, units.TYPES[known.type], env, f"`{known.name}`")
    low = -inf if known.low is None else known.low
    high = inf if known.high is None else known.high
    if not low <= value <= high:
        title = f"`{known.name}` cannot be {number_text(value)}"
        label = f"it lies in {range_text(low, high, units.TYPES[known.type])}"
        raise problem("TLT0307", title, source, expr.span, label, advice="write a number in its range")
    if known.type == "int" and not value.is_integer():
        title = f"`{known.name}` cannot be {number_text(value)}: it is an int"
        raise problem("TLT0307", title, source, expr.span, advice="write a whole number")
    return value
