"""Resolve what speaks of the trace so far: ``once``, ``since``, ``time_since(p)``, ``previous(x)``, ….

Each use becomes a register of the context (:mod:`tltlc.resolve.registers`), and an atom or a quantity
that reads the register.
"""

from __future__ import annotations

from fractions import Fraction
from math import inf, isinf
from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import Before, Condition, Const, Expression, Op, SignalValue, When, depth
from tltlc.grammar.past_words import FUNCTIONS, MOST_STEPS_BACK, OF_EVENTS
from tltlc.grammar.tree import (
    BinaryExpr,
    CallExpr,
    Expr,
    GroupExpr,
    IsExpr,
    NumberExpr,
    Unary,
)
from tltlc.io.limits import ARITHMETIC
from tltlc.logic import formula as logic
from tltlc.logic.formula import Formula
from tltlc.logic.text.printer import ascii_text, operand_text
from tltlc.resolve import registers, units
from tltlc.resolve.constants import number, samples, seconds
from tltlc.resolve.counts_within import Window
from tltlc.resolve.elapsed import timers_of
from tltlc.resolve.looking_back import looking_back
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.recall import check_closed, up_to
from tltlc.resolve.registers import RegisterDraft
from tltlc.resolve.scope import MEMORY_FUNCTIONS
from tltlc.resolve.spec import Signal
from tltlc.resolve.timers import TimerAtoms
from tltlc.resolve.values import CLOSED, Env, Quantity, Recall, number_text

PAST: Final = ("once", "historically", "previously", "begins", "ends")
"""The operators with one operand that speak of the trace so far."""

_OF_FORMULAS: Final = (
    "times",
    "times_since",
    "times_within",
    "time_since",
    "time_holding",
    "total_time",
    "total_time_since",
    "total_time_within",
)
_WITH_LENGTH: Final = ("times_within", "total_time_within", "highest_within", "lowest_within")
"""The functions of the last seconds."""
_MOST_NESTED: Final = 16
"""The most functions of the past that may stand inside each other."""
_LONGEST: Final = 10_000
"""About the most letters of a formula or a number that an operator or function of the past may have as its operand.

They become a part of the names of registers and atoms, and so their length could double at each level of nesting.
"""


# --- operators --------------------------------------------------------------------------------------


def past(expr: Unary, operand: Formula, env: Env) -> Formula:
    """Return the formula of ``once p``, ``historically p``, ``previously p``, ``begins p`` or ``ends p``.

    ``operand`` is the formula of p. Raises ResolutionError: TLT0320 p speaks of the future, TLT0312 or
    TLT0313 a window makes no sense or needs a clock, TLT0315 or TLT0317 p is too large.
    """
    _check_operand(operand, expr.operand, env)
    if expr.bound is not None:
        return _window(expr, operand, env)
    if expr.op == "begins":
        return logic.and_(operand, logic.not_(_previously(operand, expr, env)))
    if expr.op == "ends":
        return logic.and_(logic.not_(operand), _previously(operand, expr, env))
    if expr.op == "previously":
        return _previously(operand, expr, env)
    name = f"{expr.op} {operand_text(operand)}"
    if not env.symbolic:
        update = registers.once if expr.op == "once" else registers.historically
        _register(update(name, _value(operand, expr, env)), expr, env)
    return _atom(name, SignalValue(name), expr.span, env)


def since(expr: BinaryExpr, left: Formula, right: Formula, env: Env) -> Formula:
    """Return the formula of ``p since q``. Raises ResolutionError (TLT0320) if a side speaks of the future."""
    _check_operand(left, expr.left, env)
    _check_operand(right, expr.right, env)
    name = f"({operand_text(left)} since {operand_text(right)})"
    if not env.symbolic:
        _register(registers.since(name, _value(left, expr, env), _value(right, expr, env)), expr, env)
    return _atom(name, SignalValue(name), expr.span, env)


def _previously(operand: Formula, expr: Unary, env: Env) -> Formula:
    name = f"previously {operand_text(operand)}"
    if not env.symbolic:
        _register(registers.previously(name, _kept(operand, expr, env)), expr, env)
    return _atom(name, SignalValue(name), expr.span, env)


def _window(expr: Unary, operand: Formula, env: Env) -> Formula:
    """Return the atom of ``once within 5 s p`` or ``historically for 3 s p``.

    ``once within n steps p`` holds if p has held at this sample or at one of the n before it, and
    ``historically for n steps p`` if p has held at the last n samples, or at all if there are fewer.
    """
    bound, source = expr.bound, env.scope.source
    assert bound is not None, "a window"
    unit = f" {bound.high.unit}" if bound.high.unit else ""
    word = "within" if expr.op == "once" else "for"
    name = f"{expr.op} {word} {number_text(bound.high.value)}{unit} {operand_text(operand)}"
    varies = env.context.clock_varies
    length = seconds(bound.high, f"{word} 2 s", env) if varies else samples(bound.high, env)
    if length == 0 and (varies or expr.op == "historically"):
        title = f"`{word}` needs {'a time above 0' if varies else 'at least one step'}"
        advice = f"write e.g. `{expr.op} {word} {'2 s' if varies else '20 steps'} p`"
        raise problem("TLT0312", title, source, bound.high.span, advice=advice)
    if env.symbolic:
        return logic.atom(name)
    watched = operand if expr.op == "once" else logic.not_(operand)
    register = _time_since(watched, expr, env)
    timers = _timers(expr, env)
    value = timers.at_most(register, length) if expr.op == "once" else timers.at_least(register, length)
    return _atom(name, value, expr.span, env)


def _check_operand(operand: Formula, expr: Expr, env: Env) -> None:
    """Check the operand of an operator or function of the past, before a name is made of its text."""
    if any(part.is_temporal for part in operand.walk()):
        fix = looking_back(expr, env)
        advice = "let operators such as `eventually` and `until` stand outside, as in `eventually once p`"
        if fix is not None:
            advice = f"write `{fix.edits[0].text}`, which looks back from the last of them"
        raise problem(
            "TLT0320",
            "a formula about the trace so far cannot contain an operator about the future",
            env.scope.source,
            expr.span,
            "this speaks of what is still to come",
            advice=advice,
            fixes=() if fix is None else (fix,),
        )
    letters: dict[Formula, int] = {}
    for part in operand.bottom_up():
        letters[part] = len(part.name) + 2 + sum(letters[inner] for inner in part.args)
    _check_length(letters[operand], expr, env)


def _check_length(letters: int, expr: Expr, env: Env) -> None:
    if letters > _LONGEST:
        # Report this once for all definitions being expanded, since a chain of them would repeat it.
        env.context.broken.update(env.context.expanding)
        title = f"this has more than {_LONGEST:,} letters after each `let` is replaced by its formula"
        advice = "let the game compute a part of it and supply it as a signal"
        raise problem("TLT0315", title, env.scope.source, expr.span, advice=advice)


def _atom(name: str, value: Expression, span: Span, env: Env) -> Formula:
    return logic.atom(name) if env.symbolic else env.context.atom(name, value, "", env.scope.source, span)


def _register(draft: RegisterDraft, expr: Expr, env: Env) -> None:
    env.context.register(draft, env.scope.source, expr.span)


def _value(operand: Formula, expr: Expr, env: Env) -> Expression:
    """Return the robustness of an operand as an expression over its atoms, if it is not too large."""
    value = registers.robustness(operand)
    _check_depth(value, expr, env)
    return value


def _truth(operand: Formula, expr: Expr, env: Env) -> Condition:
    """Return the condition that an operand is true, if it is not too large."""
    condition = registers.truth(operand)
    _check_depth(condition, expr, env)
    return condition


def _check_depth(value: Expression | Condition, expr: Expr, env: Env) -> None:
    if depth(value) > ARITHMETIC.depth:
        title = f"this formula is more than {ARITHMETIC.depth} operators deep"
        advice = "let the game compute a part of it and supply it as a `bool` signal"
        raise problem("TLT0317", title, env.scope.source, expr.span, advice=advice)


def _timers(expr: Expr, env: Env) -> TimerAtoms:
    return timers_of(env.context, env.scope.source, expr.span)


def _kept(operand: Formula, expr: Expr, env: Env) -> str:
    """Return the name of the register that keeps the robustness of a formula for the next sample."""
    _check_depth(registers.robustness(operand), expr, env)
    return _timers(expr, env).kept(operand)


def _time_since(operand: Formula, expr: Expr, env: Env) -> str:
    """Return the name of the register with the time since a formula last held."""
    _check_depth(registers.truth(operand), expr, env)
    return _timers(expr, env).time_since(operand)


# --- functions --------------------------------------------------------------------------------------


def is_memory(expr: CallExpr, env: Env) -> bool:
    """Whether a call is a built-in function of the trace so far: a declaration may have taken its name."""
    return expr.name in MEMORY_FUNCTIONS and expr.name not in env.local and expr.name not in env.scope.names


def recall(expr: CallExpr, env: Env, level: int) -> Quantity:
    """Return the value of ``times(p)``, ``time_since(p)``, ``previous(x)``, … as a quantity.

    Raises ResolutionError: TLT0210 wrong arguments, TLT0313 a time without a clock, TLT0320 an operand
    speaks of the future, TLT0303 a maximum that is not above 0. ``level`` is the number of operators
    around the call.
    """
    is_of_formula = expr.name in _OF_FORMULAS
    least = 2 if expr.name in (*OF_EVENTS, *_WITH_LENGTH) else 1
    most = least + (is_of_formula or expr.name == "previous")
    if not least <= len(expr.arguments) <= most or any(argument.name for argument in expr.arguments):
        form = " or ".join(f"`{form}`" for form in FUNCTIONS[expr.name].forms)
        first = "formula" if is_of_formula else "number"
        if expr.name in _WITH_LENGTH:
            title = f"`{expr.name}` takes a {first} and a time"
        elif expr.name not in OF_EVENTS:
            title = f"`{expr.name}` takes one {first}"
        else:
            title = f"`{expr.name}` takes {'two formulas' if is_of_formula else 'a number and a formula'}"
        raise problem("TLT0210", title, env.scope.source, expr.span, advice=f"write {form}")
    if env.context.recalls >= _MOST_NESTED:
        title = f"functions of the past stand more than {_MOST_NESTED} deep inside each other"
        advice = "let the game compute the value and supply it as a signal"
        raise problem("TLT0317", title, env.scope.source, expr.span, advice=advice)
    outside = env.context.levels
    env.context.recalls, env.context.levels = env.context.recalls + 1, level
    try:
        return _of_formula(expr, env) if is_of_formula else _of_number(expr, env, level)
    finally:
        env.context.recalls, env.context.levels = env.context.recalls - 1, outside


def _of_formula(expr: CallExpr, env: Env) -> Quantity:
    operand = _operand(expr.arguments[0].value, env)
    event = _operand(expr.arguments[1].value, env) if expr.name in OF_EVENTS else None
    texts = [ascii_text(operand)] if event is None else [ascii_text(operand), _event_text(expr, event, env)]
    window = _counted_window(expr, operand, env) if expr.name == "times_within" else None
    steps = 0
    if window is not None:
        texts.append(window[0])
    elif expr.name == "total_time_within":
        if env.context.clock_varies:
            title = "`total_time_within` needs a fixed clock"
            advice = "declare one, e.g. `clock 60 Hz`, or begin the time at an event, e.g. `total_time_since(p, q)`"
            raise problem("TLT0323", title, env.scope.source, expr.name_span, advice=advice)
        length, steps = _steps_back(expr, env)
        texts.append(length)
    name = f"{expr.name}({', '.join(texts)})"
    is_time, varies = expr.name not in registers.COUNTS, env.context.clock_varies
    unit = _seconds_per_step(expr, env) if is_time else Fraction(1)
    if not env.symbolic:
        if expr.name == "time_since":
            _time_since(operand, expr, env)
        elif steps:
            _total_time_within(name, operand, steps, expr, env)
        elif window is None:
            _register(_draft(name, operand, event, expr, env), expr, env)
    dimension = units.TYPES["time"] if is_time else units.PLAIN
    most = steps * float(unit) if steps else None
    is_whole = not (is_time and varies)
    read = Recall(name, unit, is_count=not is_time, is_whole=is_whole, window=window and window[1], most=most)
    open_value = Quantity(SignalValue(name), dimension, 0.0, inf, name, is_whole=not is_time, recall=read)
    if env.symbolic:
        env.context.signals.setdefault(name, Signal(name, "number", 0.0, None))
    if len(expr.arguments) == len(texts):
        return open_value
    limit = expr.arguments[-1].value
    maximum = number(limit, dimension, env, f"the maximum of `{expr.name}`")
    if maximum <= 0 or isinf(maximum) or (not is_time and maximum != int(maximum)):
        wanted = "a time above 0" if is_time else "a whole number above 0"
        title = "this maximum cannot be reached" if maximum <= 0 else f"a maximum of `{expr.name}` is {wanted}"
        raise problem(
            "TLT0303", title, env.scope.source, limit.span, advice=f"write {wanted}{', e.g. `60 s`' if is_time else ''}"
        )
    text = f"{name[:-1]}, {number_text(maximum)})"
    return up_to(open_value, maximum, limit, env, text, Label(env.scope.source, limit.span))


def _draft(name: str, operand: Formula, event: Formula | None, expr: CallExpr, env: Env) -> RegisterDraft:
    """Return the register of a count or a time; ``event`` is q of ``times_since(p, q)`` and its like."""
    truth, varies = _truth(operand, expr, env), env.context.clock_varies
    unit = "s" if varies else "steps"
    if expr.name in ("total_time", "total_time_since"):
        _register(registers.first(), expr, env)
        length = registers.sample_length(varies)
        if event is None:
            return registers.total_time(name, truth, length, unit)
        return registers.total_time_since(name, truth, _truth(event, expr, env), length, unit)
    kept = _kept(operand, expr, env)
    if expr.name == "time_holding":
        return registers.time_holding(name, truth, kept, registers.step_length(varies), unit)
    if event is None:
        return registers.times(name, truth, kept)
    return registers.times_since(name, truth, kept, _truth(event, expr, env))


def _total_time_within(name: str, operand: Formula, steps: int, expr: CallExpr, env: Env) -> None:
    """Add the register of ``total_time_within(p, T)``, and those of the times in one step, in two, and so on."""
    _register(registers.first(), expr, env)
    truth, length = _truth(operand, expr, env), registers.sample_length(varies=False)
    before: Expression = Const(0.0)
    for step in range(1, steps):
        kept = f"time of {operand_text(operand)} in {step} steps"
        _register(registers.last(kept, registers.added(truth, before, length), 0.0, float(step), 0.0), expr, env)
        before = Before(kept)
    update = registers.added(truth, before, length)
    _register(RegisterDraft(name, "total_time", "steps", 0.0, None, 0.0, update), expr, env)


def _counted_window(expr: CallExpr, operand: Formula, env: Env) -> tuple[str, Window]:
    """Return the time of ``times_within(p, T)`` as a text, and its window.

    Raises ResolutionError: TLT0210 if T is no number with a unit, TLT0312, TLT0313 or TLT0323 if it is no time here.
    """
    argument = expr.arguments[1].value
    while isinstance(argument, GroupExpr):
        argument = argument.inner
    if not isinstance(argument, NumberExpr) or argument.unit is None:
        title, advice = "`times_within` takes a formula and a time", "write e.g. `times_within(p, 5 s)`"
        raise problem("TLT0210", title, env.scope.source, expr.arguments[1].value.span, advice=advice)
    text, varies = f"{number_text(argument.value)} {argument.unit}", env.context.clock_varies
    length = seconds(argument, "times_within(p, 5 s)", env) if varies else float(samples(argument, env))
    truth = _truth(operand, expr, env)
    kept = "" if env.symbolic else _kept(operand, expr, env)
    step, unit = registers.step_length(varies), "s" if varies else "steps"
    return text, Window(operand_text(operand), registers.begins(truth, kept), length, unit, step)


def _operand(argument: Expr, env: Env) -> Formula:
    """Return the formula that an argument is. Raises ResolutionError (TLT0320) if it speaks of the future."""
    from tltlc.resolve.formulas import formula

    operand = formula(argument, env)
    _check_operand(operand, argument, env)
    return operand


def _event_text(expr: CallExpr, event: Formula, env: Env) -> str:
    """Return the text of the second argument of a function: `begins p` stays as it is written."""
    from tltlc.resolve.formulas import formula

    argument = expr.arguments[1].value
    if isinstance(argument, Unary) and argument.op in ("begins", "ends"):
        return f"{argument.op} {operand_text(formula(argument.operand, env))}"
    return ascii_text(event)


def _seconds_per_step(expr: CallExpr, env: Env) -> Fraction:
    """Return the time between two samples in seconds, exactly as the clock was written if it has up to nine digits.

    If the clock varies, registers count seconds: return 1. Raises ResolutionError (TLT0313) without a clock.
    """
    if env.context.clock_varies:
        return Fraction(1)
    period = env.context.clock_s
    if period is None and env.context.clock_failed:
        raise ResolutionError(None)
    if period is None:
        advice = "declare how often the game takes a sample, e.g. `clock 60 Hz`"
        if expr.name == "time_since":
            advice += ", or count steps: `once within 20 steps p`"
        raise problem("TLT0313", f"`{expr.name}` needs a clock", env.scope.source, expr.span, advice=advice)
    return Fraction(period).limit_denominator(10**9)


def _of_number(expr: CallExpr, env: Env, level: int) -> Quantity:
    from tltlc.resolve.quantities import quantity

    argument = expr.arguments[0].value
    inner = argument.inner if isinstance(argument, GroupExpr) else argument
    is_compared = isinstance(inner, BinaryExpr) and inner.op in ("<", "<=", ">", ">=", "==", "!=")
    if expr.name == "previous" and (isinstance(inner, IsExpr) or is_compared):
        advice = f"write `previously ({env.scope.source.slice(inner.span)})` for a formula at the step before"
        raise problem("TLT0302", "expected a number, found a formula", env.scope.source, argument.span, advice=advice)
    value = check_closed(quantity(argument, env, level), argument, env)
    event = _operand(expr.arguments[1].value, env) if expr.name in OF_EVENTS else None
    if value.is_constant:
        title = f"`{expr.name}` of a constant is the constant"
        advice = f"leave out `{expr.name}`, or name a signal"
        raise problem("TLT0302", title, env.scope.source, argument.span, advice=advice)
    if value.depth > ARITHMETIC.depth:
        return value
    _check_length(len(value.text), argument, env)
    length, steps = _steps_back(expr, env) if expr.arguments[1:] and event is None else ("", 1)
    texts = (value.text,) if event is None else (value.text, _event_text(expr, event, env))
    if length and (steps > 1 or expr.name in _WITH_LENGTH):
        texts = (value.text, length)
    name = f"{expr.name}({', '.join(texts)})"
    call = (expr.name, texts) if value.is_bool else None
    result = replace(value, expression=SignalValue(name), text=name, binding=CLOSED, depth=1, call=call)
    if env.symbolic:
        env.context.signals.setdefault(name, Signal(name, "number", None, None))
        return result
    _register(registers.first(), expr, env)
    now, low, high = value.expression, _end(value.low), _end(value.high)
    before = Before(name)
    kind = expr.name.removesuffix("_within")
    if expr.name == "previous" or expr.name in _WITH_LENGTH:
        # The register of `previously p` keeps the robustness of p under another name, `last p`.
        of = value.operand_text(CLOSED)
        kept = f"last value of {of}"
        _register(registers.last(kept, now, low, high, _inside(0.0, low, high)), expr, env)
        before = Before(kept)
        for step in range(1, steps):
            kept = f"{of} {step} steps before" if kind == "previous" else f"{kind} {of} of {step} steps before"
            value_then = before if kind == "previous" else Op("max" if kind == "highest" else "min", (before, now))
            draft = registers.last(kept, registers.at_first(now, value_then), low, high, _inside(0.0, low, high))
            _register(draft, expr, env)
            before = Before(kept)
    updates: dict[str, Expression] = {
        "previous": before,
        "initial": before,
        "highest": Op("max", (before, now)),
        "lowest": Op("min", (before, now)),
        "value_at": before,
    }
    update = updates[kind.removesuffix("_since")]
    if event is not None:
        update = When(((_truth(event, expr, env), now),), update)
    update = registers.at_first(now, update)
    unit = str(units.si_unit(value.dimension) or "") if value.dimension else ""
    draft = RegisterDraft(name, kind, unit, low, high, _inside(0.0, low, high), update)  # type: ignore[arg-type]
    _register(draft, expr, env)
    return result


def _steps_back(expr: CallExpr, env: Env) -> tuple[str, int]:
    """Return the time of ``previous(x, T)`` or ``highest_within(x, T)`` as a text, and how many samples it is.

    Raises ResolutionError: TLT0210 if T is no number with a unit, TLT0312 or TLT0313 if it is no time or number of
    steps here, TLT0303 if it is no step, or more steps than a monitor remembers.
    """
    argument = expr.arguments[1].value
    while isinstance(argument, GroupExpr):
        argument = argument.inner
    if not isinstance(argument, NumberExpr) or argument.unit is None:
        title = f"`{expr.name}` takes a {'formula' if expr.name in _OF_FORMULAS else 'number'} and a time"
        of, number = (env.scope.source.slice(argument.value.span) for argument in expr.arguments)
        known = f"write `{expr.name}({of}, {number} steps)`" if isinstance(argument, NumberExpr) else ""
        advice = known or f"write e.g. `{expr.name}({of}, 1 s)`, or `{expr.name}({of}, 3 steps)`"
        raise problem("TLT0210", title, env.scope.source, expr.arguments[1].value.span, advice=advice)
    text = f"{number_text(argument.value)} {argument.unit}"
    if env.context.clock_varies and argument.unit != "steps":
        title, advice = f"`{expr.name}` needs a fixed clock for a time", "write a number of steps, e.g. `10 steps`"
        raise problem("TLT0323", title, env.scope.source, argument.span, advice=advice)
    steps = samples(argument, env)
    if not 0 < steps <= MOST_STEPS_BACK:
        of = env.scope.source.slice(expr.arguments[0].value.span)
        title = f"`{expr.name}` looks back 1 to {MOST_STEPS_BACK} steps, and this is {steps}"
        what = f"the value that `{of}` had {text} ago" if expr.name == "previous" else "that number"
        advice = f"supply {what} as a signal: a monitor keeps a number for each step"
        if not steps:
            advice = f"write `{of}` for the value at this step"
        raise problem("TLT0303", title, env.scope.source, argument.span, advice=advice)
    return text, steps


def _end(value: float) -> float | None:
    return None if isinf(value) else value


def _inside(value: float, low: float | None, high: float | None) -> float:
    """Return the value of a range that is nearest to ``value``."""
    if low is not None and value < low:
        return low
    return high if high is not None and value > high else value
