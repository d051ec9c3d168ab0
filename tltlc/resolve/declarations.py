"""Read the declarations of signals, params and the clock into tables that the whole program shares."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from tltlc.core.record import replace
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Edit, Fix, Label, replacement_fix
from tltlc.grammar.tree import ClockDecl, ParamDecl, SignalDecl
from tltlc.resolve import units
from tltlc.resolve.clock import LONGEST_S, SHORTEST_S, period_s
from tltlc.resolve.constants import interval, number
from tltlc.resolve.context import Context, SignalInfo
from tltlc.resolve.enums import value_names
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.quantities import quantity
from tltlc.resolve.scope import Scope
from tltlc.resolve.spec import Param, ValueType
from tltlc.resolve.unknown_types import unknown_type_error
from tltlc.resolve.values import Env, range_text


def declare(scopes: Iterable[Scope], options: ResolveOptions, context: Context) -> None:
    """Enter the signals, params and clocks that all ``scopes`` declare into ``context``; log problems there.

    At the end, set params to the values that ``options`` gives them.
    """
    places: dict[str, Label] = {}
    ranged: set[str] = set()
    clock: Label | None = None
    for scope in scopes:
        env = Env(context, scope)
        for declaration in scope.module.declarations:
            try:
                if isinstance(declaration, SignalDecl):
                    _signal(declaration, env)
                elif isinstance(declaration, ParamDecl):
                    _param(declaration, env, places, ranged)
                elif isinstance(declaration, ClockDecl):
                    clock = _clock(declaration, env, clock)
            except ResolutionError as failure:
                context.log.add(failure.diagnostic)
                context.clock_failed = context.clock_failed or isinstance(declaration, ClockDecl)
    _apply_overrides(options, context)


def _type(declaration: SignalDecl | ParamDecl, scope: Scope) -> ValueType:
    type_ = units.value_type(declaration.type or "number")
    if type_ is None:
        raise unknown_type_error(str(declaration.type), declaration, scope.source)
    return type_


def _range(declaration: SignalDecl | ParamDecl, type_: ValueType, env: Env) -> tuple[float | None, float | None]:
    if declaration.interval is not None:
        if type_ == "bool":
            title = f"`{declaration.name}` is a bool, so it cannot have a range"
            raise problem("TLT0303", title, env.scope.source, declaration.interval.span, advice="leave out the range")
        _check_units(declaration, type_, env)
        low, high = interval(declaration.interval, units.TYPES[type_], env)
        if type_ == "int" and not all(end is None or end.is_integer() for end in (low, high)):
            title, span = "the range of an int has whole ends", declaration.interval.span
            raise problem("TLT0303", title, env.scope.source, span, advice="write whole numbers, e.g. `in [0, 5]`")
        return low, high
    if isinstance(declaration, SignalDecl) and declaration.values:
        return 0.0, len(declaration.values) - 1.0
    return (0.0, 1.0) if type_ in ("ratio", "bool") else (None, None)


def _check_units(declaration: SignalDecl | ParamDecl, type_: ValueType, env: Env) -> None:
    """Raise ResolutionError (TLT0305) if the range of a plain number has ends with a unit."""
    assert declaration.interval is not None
    if units.TYPES[type_] != units.PLAIN:
        return
    for end in (declaration.interval.low, declaration.interval.high):
        try:
            dimension = quantity(end, replace(env, constant=True, local={})).dimension
        except ResolutionError:
            continue  # an infinite end, or an error that `interval` reports
        named = next((name for name, known in units.TYPES.items() if known == dimension), None)
        if dimension in (None, units.PLAIN) or named is None:
            continue
        kind = f"has the type `{declaration.type}`" if declaration.type else "has no type"
        title = f"`{declaration.name}` {kind}, but the ends of its range are {named}s"
        raise problem(
            "TLT0305",
            title,
            env.scope.source,
            end.span,
            advice=f"declare it with the type `{named}`: `{declaration.name}: {named}`",
            fixes=_type_fixes(declaration, named, env),
        )


def _type_fixes(declaration: SignalDecl | ParamDecl, type_: str, env: Env) -> tuple[Fix, ...]:
    """Return the fix that writes a type after the name of a declaration, in place of the one that stands there."""
    source, start = env.scope.source, declaration.name_span.end
    if declaration.type is None:
        at = source.text.find(")", start) + 1 if source.text[start:].lstrip().startswith("(") else start
        return (Fix(f"Write `: {type_}`", (Edit(Span(at, at), f": {type_}"),)),)
    assert declaration.interval is not None
    at = source.text.rfind(declaration.type, start, declaration.interval.span.start)
    return () if at < 0 else (replacement_fix(source, Span(at, at + len(declaration.type)), type_),)


def _signal(declaration: SignalDecl, env: Env) -> None:
    scope = env.scope
    place = Label(scope.source, declaration.name_span)
    for parameter in declaration.parameters:
        if parameter.type not in (None, "entity"):
            title = f"the parameters of a signal are entities, not {parameter.type}s"
            text = f"{parameter.name}: entity"
            fixes = (replacement_fix(scope.source, parameter.span, text),)
            raise problem("TLT0210", title, scope.source, parameter.span, advice=f"write `{text}`", fixes=fixes)
    type_ = _type(declaration, scope)
    low, high = _range(declaration, type_, env)
    names = tuple(parameter.name for parameter in declaration.parameters)
    values = value_names(declaration, scope)
    new = SignalInfo(
        declaration.name, names, type_, low, high, declaration.doc, declaration.interval is not None, place, values
    )
    table = env.context.signal_infos
    old = table.get(new.name)
    if old is None:
        table[new.name] = new
        return
    if (old.type, len(old.parameters), old.values) == (new.type, len(new.parameters), new.values):
        if (old.low, old.high) == (new.low, new.high) or not new.has_range:
            return
        if not old.has_range:
            table[new.name] = replace(new, doc=new.doc or old.doc)
            return
    raise _conflict_error("signal", new.name, place, old.place)


def _param(declaration: ParamDecl, env: Env, places: dict[str, Label], ranged: set[str]) -> None:
    scope = env.scope
    place = Label(scope.source, declaration.name_span)
    type_ = _type(declaration, scope)
    low, high = _range(declaration, type_, env)
    value = number(declaration.value, units.TYPES[type_], env, f"`{declaration.name}`")
    if type_ == "int" and not value.is_integer():
        title, advice = f"`{declaration.name}` is an int, so its value is a whole number", "write a whole number"
        raise problem("TLT0307", title, scope.source, declaration.value.span, advice=advice)
    lowest, highest = -inf if low is None else low, inf if high is None else high
    if not lowest <= value <= highest:
        raise problem(
            "TLT0307",
            f"the value of `{declaration.name}` lies outside its range",
            scope.source,
            declaration.value.span,
            f"the range is {range_text(lowest, highest, units.TYPES[type_])}",
            advice="choose a value inside the range, or widen the range",
        )
    new = Param(declaration.name, type_, value, low, high, declaration.doc)
    old = env.context.params.get(new.name)
    if old is None:
        env.context.params[new.name] = new
        places[new.name] = place
        if declaration.interval is not None:
            ranged.add(new.name)
        return
    if (old.type, old.value) == (new.type, new.value):
        if (old.low, old.high) == (new.low, new.high) or declaration.interval is None:
            return
        if new.name not in ranged:
            ranged.add(new.name)
            env.context.params[new.name] = new
            places[new.name] = place
            return
    raise _conflict_error("param", new.name, place, places[new.name])


def _conflict_error(kind: str, name: str, new: Label, old: Label) -> ResolutionError:
    return problem(
        "TLT0204",
        f"the {kind} `{name}` is declared in two different ways",
        new.source,
        new.span,
        "differs from the other declaration",
        advice="make the two declarations the same, or rename one",
        related=(Label(old.source, old.span, "the other declaration"),),
    )


def _clock(declaration: ClockDecl, env: Env, old: Label | None) -> Label:
    source, value = env.scope.source, declaration.value
    here = Label(source, declaration.span)
    if value is None:
        _check_same_clock(None, here, env, old)
        env.context.clock_varies = True
        return old or here
    period = period_s(value.value, value.unit)
    if period is None:
        title = "a clock must be a frequency or a period above zero"
        advice = "write e.g. `clock 20 Hz` or `clock 0.05 s`"
        if value.unit is None and value.value > 0:
            number = source.slice(value.span)
            rate, period_text = f"`clock {number} Hz` for {number} steps a second", f"`clock {number} s`"
            advice = f"write {rate}, {period_text} for the time of one step"
        raise problem("TLT0314", title, source, value.span, advice=advice)
    if not SHORTEST_S <= period <= LONGEST_S:
        title = "the time from one step to the next must be between 1e-9 and 1e9 seconds"
        raise problem("TLT0314", title, source, value.span, advice="write e.g. `clock 20 Hz` or `clock 0.05 s`")
    _check_same_clock(period, here, env, old)
    env.context.clock_s = period
    return old or here


def _check_same_clock(period: float | None, here: Label, env: Env, old: Label | None) -> None:
    """Raise ResolutionError (TLT0314) if an earlier declaration ``old`` has another clock.

    ``period`` is the period of the clock declared ``here``; None if it varies.
    """
    if old is not None and period != env.context.clock_s:
        raise problem(
            "TLT0314",
            "two clocks differ",
            here.source,
            here.span,
            advice="a program has one clock: keep one of the two",
            related=(Label(old.source, old.span, "the other clock"),),
        )


def _apply_overrides(options: ResolveOptions, context: Context) -> None:
    """Set params in ``context`` to the values that ``options.params`` gives them; log problems."""
    if options.params:
        from tltlc.resolve.overrides import apply_overrides

        params, diagnostics = apply_overrides(context.params, options.params)
        context.params.update(params)
        for diagnostic in diagnostics:
            context.log.add(diagnostic)
