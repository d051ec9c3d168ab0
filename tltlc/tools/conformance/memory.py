"""Cases with registers, in which monitors remember the trace so far."""

from __future__ import annotations

from functools import partial
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.traces import Pools, lively_trace, table

_UNIT: Final = (-1.0, -0.6, -0.5, -0.0, 0.0, 0.1, 0.5, 0.51, 0.9, 1.0)
_POOLS: Final[Pools] = {"x": _UNIT}

_DECLARATIONS: Final = """\
clock 5 Hz
signal a: bool
signal b: bool
signal x in [-1, 1]
signal y in [-20, 20]
signal z: number
predicate c = x
predicate d = clamp(y / 8, -1, 1)
predicate e = clamp(highest(z) - previous(z) - 9, -1, 1)

"""
_LEAVES: Final = ("a", "b", "c", "d", "e", "x > 0.25", "y <= 3", "x > y")
_NUMBERS: Final = ("x", "y", "abs(y)", "x * y", "x + y / 2")
_COMPARISONS: Final = (">", ">=", "<", "<=")


# --- random specs ---------------------------------------------------------------------------------


def _formula(draw: Draw, depth: int) -> str:
    """Return the text of a random formula about the trace so far, at most ``depth`` operators deep, in brackets."""
    if not depth or draw.chance(0.1):
        return f"({draw.choice(_LEAVES)})"
    choice = draw.below(10)
    if choice <= 1:
        left, right = _formula(draw, depth - 1), _formula(draw, depth - 1)
        return f"({left} {draw.choice(('and', 'or', 'implies', 'iff', 'since'))} {right})"
    if choice == 2:
        return f"(not {_formula(draw, depth - 1)})"
    if choice <= 4:
        word = draw.choice(("once", "historically", "previously", "begins", "ends"))
        return f"({word} {_formula(draw, depth - 1)})"
    if choice == 5:
        window = draw.choice(("once within 1 s", "once within 3 steps", "historically for 2 steps"))
        return f"({window} {_formula(draw, depth - 1)})"
    return f"({_comparison(draw, depth - 1)})"


def _comparison(draw: Draw, depth: int) -> str:
    """Return the text of a random comparison of a number about the trace so far."""
    op, operand = draw.choice(_COMPARISONS), _formula(draw, depth)
    choice = draw.below(5)
    if choice == 0:
        return f"times({operand}) {op} {draw.below(5)}"
    if choice == 1:
        return f"times({operand}, {2 + draw.below(5)}) {op} times({_formula(draw, depth)}, 3)"
    if choice == 2:
        return f"{draw.choice(('time_since', 'time_holding'))}({operand}) {op} {draw.below(8) / 5} s"
    return f"{_number(draw, depth)} {op} {draw.choice(_NUMBERS)}"


def _number(draw: Draw, depth: int) -> str:
    function = draw.choice(("previous", "initial", "highest", "lowest"))
    return f"{function}({_number(draw, depth - 1) if depth > 0 and draw.chance(0.4) else draw.choice(_NUMBERS)})"


def _random_case(name: str, seed: int) -> ConformanceCase:
    """Return a case with a random spec that has registers, and whose automaton is neither tiny nor large."""
    draw = Draw(seed)
    while True:
        text, fspa = _random_spec(name, draw)
        if fspa is not None and fspa.registers and 2 <= len(fspa.states) <= 12 and len(fspa.atoms) > 2:
            break
    traces = (lively_trace(fspa, draw, 30, _POOLS), lively_trace(fspa, draw, 40, _POOLS))
    return ConformanceCase(fspa, "A random spec about the trace so far.", traces, text)


def _random_spec(name: str, draw: Draw) -> tuple[str, Fspa | None]:
    """Return the text of a random spec and its automaton, or None if the text has an error."""
    first, second, third = (_formula(draw, 3) for _ in range(3))
    clauses = (
        f"require always ({first} implies eventually {second})",
        f"require always eventually {third}",
        *(("limit 35 steps",) if draw.chance(0.5) else ()),
    )
    body = "".join(f"    {clause}\n" for clause in clauses)
    text = f"{_DECLARATIONS}spec {name} {{\n{body}}}\n"
    try:
        return text, _compiled(name, text)
    except TltlError:
        return text, None


def _compiled(name: str, text: str) -> Fspa:
    (fspa,) = compile_source(SourceFile(f"{name}.tltl", text), CompileOptions(specs=(name,))).automata
    return fspa


# --- registers without a value --------------------------------------------------------------------


def _rejected_case() -> ConformanceCase:
    """Return a case in which registers have no value: each trace ends at such a sample."""
    text = """\
signal x: number
signal y: number
predicate square = clamp(highest(x * x) - 4, -1, 1)
predicate share = clamp(2 - lowest(8 / y), -1, 1)
predicate root = clamp(initial(sqrt(y + 1)), -1, 1)
predicate double = clamp(previous(y * y * y), -1, 1)

spec no_memory {
    keep square or share
    require always eventually (root or double)
}
"""
    start: list[list[object]] = [[3, 2], [-3, 0.5]]
    ends: list[list[object]] = [[1e200, 1], [1, 0], [1, -0.0], [1, -2], [1, 1e150], [-1e308, 4]]
    traces = (table(["x", "y"], [*start, end, [1, 1]]) for end in (*ends, ["nan", 1], [1, "inf"]))
    first = (table(["x", "y"], [end, [1, 1]]) for end in ends[:5])
    return ConformanceCase(_compiled("no_memory", text), "Registers without a value.", (*traces, *first), text)


def _events_case() -> ConformanceCase:
    """Return a case with counts, times and values since an event."""
    text = f"""\
{_DECLARATIONS}spec since_events {{
    keep times_since(a, b) <= 3 or total_time(b) > 1 s
    keep times_since(x > 0.25, begins c, 5) != 4 or y >= value_at(y, begins a)
    keep times_within(d, 0.5 s) <= 2 or times_within(x > 0.25, 3 steps, 2) != 1
    keep total_time_since(c, begins a) <= 1 s or highest_since(x, b) > lowest_since(y, a)
    require always eventually (value_at(x + y / 2, b) > x or times_since(d, e and a) == 2)
}}
"""
    fspa, draw = _compiled("since_events", text), Draw(9009)
    traces = tuple(lively_trace(fspa, draw, length, _POOLS) for length in (20, 30, 40))
    return ConformanceCase(fspa, "Counts, times and values since an event.", traces, text)


def _last_seconds_case() -> ConformanceCase:
    """Return a case with values and times of the last seconds."""
    text = f"""\
{_DECLARATIONS}spec last_seconds {{
    keep x >= highest_within(x, 0.5 s) - 0.75 or y > previous(y, 3 steps)
    keep total_time_within(a, 0.5 s) <= 0.25 s or total_time_within(b or c, 4 steps) >= 0.2 s
    require always eventually (lowest_within(x + y / 2, 2 steps) > previous(x, 0.25 s) or d)
}}
"""
    fspa, draw = _compiled("last_seconds", text), Draw(9010)
    traces = tuple(lively_trace(fspa, draw, length, _POOLS) for length in (20, 30, 40))
    return ConformanceCase(fspa, "Values and times of the last seconds.", traces, text)


CASES: Final[CaseBuilders] = {
    **{f"random_memory_{n}": partial(_random_case, f"random_memory_{n}", 9000 + n) for n in range(1, 9)},
    "since_events": _events_case,
    "last_seconds": _last_seconds_case,
    "no_memory": _rejected_case,
}
