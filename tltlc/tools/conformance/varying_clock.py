"""Cases with a clock that varies: each sample brings its time since the sample before."""

from __future__ import annotations

from functools import partial
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.traces import Pools, lively_trace, random_trace, table

_DECLARATIONS: Final = """\
clock varies
signal a: bool
signal b: bool
signal x in [-1, 1]

"""
_COLUMNS: Final = ("a", "b", "x")
_POOLS: Final[Pools] = {"x": (-1.0, -0.5, -0.0, 0.0, 0.25, 0.5, 0.75, 1.0)}


@record
class _Timed:
    """A case: what it tests, the clauses of its spec, and rows of dt, a, b and x for each trace written by hand."""

    about: str
    clauses: tuple[str, ...]
    traces: tuple[tuple[tuple[object, ...], ...], ...]


_FRAMES: Final = (0.1, 0.2, 0.2, 0.0, 0.5, 0.25, 0.25, 40.0, 1.0, 1e-9, 0.7)
"""Steps of which sums are exactly the bounds below, or next to them; one takes no time, and one very long."""

_SPECS: Final[dict[str, _Timed]] = {
    "varies_deadlines": _Timed(
        "Deadlines of answers, and rules that last: an answer at the bound is in time, and a rule has ended.",
        (
            "require always (a implies eventually within 1.5 s b)",
            "require always (begins x > 0.5 implies always for 0.5 s x > -0.25)",
            "require always eventually x > 0",
        ),
        (
            # Answers after 1.5 s, and after a little more, which is too late.
            (
                *((0, 1, 0, 0), (0.5, 0, 0, 0), (1.0, 0, 1, 0), (0, 1, 0, 0), (1.5, 0, 1, 1), (0, 1, 0, 1)),
                (1.5000000000000002, 0, 1, 1),
            ),
            # The sum of fifteen times 0.1 is rounded to a number above 1.5.
            ((9, 1, 0, 0), *((0.1, 0, 0, 0),) * 14, (0.1, 0, 1, 0.5), (0.1, 1, 0, 0.5)),
            # A rule ends at its bound, and two samples have one time.
            (
                (0, 0, 0, 1),
                (0.25, 0, 0, 0),
                (0.25, 0, 0, -1),
                (0, 0, 0, 1),
                (0, 0, 0, 0.5),
                (0, 0, 0, -0.5),
                (1, 1, 1, 1),
            ),
        ),
    ),
    "varies_next": _Timed(
        "Deadlines that begin at the sample after.",
        (
            "require always (a implies next eventually within 0.7 s b)",
            "require always (b implies N always for 0.2 s x > 0)",
        ),
        (
            (
                (0, 1, 1, 0),
                (9, 0, 0, 1),
                (0.7, 0, 1, 1),
                (9, 0, 0, 0.25),
                (0.1, 0, 0, 0.5),
                (0.1, 1, 0, -1),
                (0.1, 1, 0, 1),
            ),
        ),
    ),
    "varies_start": _Timed(
        "Bounds that count from the first sample.",
        (
            "require eventually within 0.7 s (a and eventually within 40 s b)",
            "require always for 0.5 s x > -0.5",
            "require eventually always for 0.25 s x > 0",
        ),
        (
            (
                (7, 0, 0, 0),
                (0.2, 0, 0, 0),
                (0.2, 0, 0, 0),
                (0.3, 1, 0, -1),
                (40, 0, 1, 1),
                (0.25, 0, 0, 1),
                (0, 0, 0, -1),
            ),
            ((0, 0, 0, 1), (0.5, 0, 0, -1), (0.2, 1, 0, 1), (39, 0, 0, 0.5), (1, 0, 1, 0)),
        ),
    ),
    "varies_goals": _Timed(
        "One goal soon after another.",
        (
            "reach a then within 0.5 s b then within 1 s x > 0.5",
            "avoid time_holding(a) > 2 s",
        ),
        (
            ((0, 1, 1, 0), (0.25, 1, 0, 0), (0.25, 0, 1, 0), (1, 0, 0, 1), (1, 0, 0, 1)),
            ((0, 1, 0, 0), (0.5000000000000001, 0, 1, 0), (0, 1, 0, 0), (0, 0, 1, 1), (0, 0, 0, 1)),
            ((0, 1, 0, 0), (1, 1, 1, 0), (1, 1, 0, 0), (0, 1, 1, 0), (0.001, 1, 0, 1)),
        ),
    ),
    "varies_windows": _Timed(
        "Windows and times of the trace so far.",
        (
            "require always eventually (once within 0.5 s a and not once within 0.25 s b)",
            "require always eventually (historically for 0.7 s x > -0.5 and time_since(b, 40 s) >= 1.2 s)",
            "require always eventually (time_holding(x > 0) >= 0.3 s and time_since(a) < 0.2 s)",
        ),
        (
            (
                *((0, 1, 1, 1), (0.25, 0, 0, 1), (0.25, 0, 0, 0.5), (0, 0, 0, -1), (0.7, 1, 0, 1), (0.1, 0, 0, 1)),
                *((0.2, 1, 0, 1), (0.4, 0, 0, 1), (40, 0, 0, 1), (1, 1, 1, -0.75), (1e-9, 0, 0, 0), (1e9, 1, 0, 1)),
            ),
        ),
    ),
    "varies_forever": _Timed(
        "Deadlines and times over infinite traces.",
        (
            "semantics infinite",
            "require always (a implies eventually within 0.7 s b)",
            "require always eventually (time_holding(x > 0) >= 0.5 s)",
        ),
        (
            (
                (0, 1, 0, 1),
                (0.2, 0, 0, 1),
                (0.5, 0, 1, 1),
                (0, 0, 0, -1),
                (0, 1, 1, 0.5),
                (40, 0, 0, 0.5),
                (0, 1, 0, 0.5),
            ),
        ),
    ),
}


def _timed_case(name: str, seed: int) -> ConformanceCase:
    timed, draw = _SPECS[name], Draw(seed)
    text = _text(name, timed.clauses)
    fspa = _compiled(name, text)
    written = (table(("dt", *_COLUMNS), rows) for rows in timed.traces)
    drawn = (lively_trace(fspa, draw, 30, _POOLS, _FRAMES), random_trace(fspa, draw, 20, _POOLS, step_lengths=_FRAMES))
    return ConformanceCase(fspa, timed.about, (*written, *drawn), text)


def _text(name: str, clauses: tuple[str, ...]) -> str:
    body = "".join(f"    {clause}\n" for clause in clauses)
    return f"{_DECLARATIONS}spec {name} {{\n{body}}}\n"


def _compiled(name: str, text: str) -> Fspa:
    (fspa,) = compile_source(SourceFile(f"{name}.tltl", text), CompileOptions(specs=(name,))).automata
    return fspa


# --- columns with times ---------------------------------------------------------------------------


def _columns_case() -> ConformanceCase:
    """Return a case of which no register reads the time, with wrong times, and a signal called ``dt``."""
    text = """\
clock varies
signal dt: bool
signal x in [-4, 4]
spec varies_columns { reach dt then x > 1 }
"""
    names, rows = ("dt", "x", "Time"), ((1, 0, 5), (0, 0, 5), (1, 0, 7.25))
    traces = [table(names, (*rows, (1, 2, end), (1, 2, 8))) for end in (7.25, 7, "nan", "-inf", "", "later", "true")]
    # Of two columns, the one with the exact name counts. DT is a length, and counts before a time.
    traces.append(table((*names, "time"), ((1, 0, 5, 3), (1, 2, 4, 3), (0, 0, 3, 2.5))))
    traces.append(table((*names, "DT"), ((1, 0, 5, 0.5), (1, 2, 4, 0), (0, 0, 3, -0.0), (0, 0, 3, -0.5))))
    lengths = ("-1e-300", "nan", "inf", "soon")
    traces += [table((*names[:2], "dT"), ((1, 0, 5), (0, 2, length), (0, 2, 1))) for length in lengths]
    # The difference of two times is too large. The monitor refuses the sample before it looks at its signals.
    traces.append(table(names, ((0, 0, -1e308), (1, "nan", 1e308))))
    traces.append(table(names[:2], ((1, 0), (0, 2))))
    traces.append(table((*names, "Time"), ((1, 0, 1, 1),)))
    traces.append(table(("dt", "Time"), ((1, 0),)))
    return ConformanceCase(_compiled("varies_columns", text), "Columns with times.", tuple(traces), text)


# --- random specs ---------------------------------------------------------------------------------

_TIMES: Final = ("0.1 s", "0.25 s", "0.3 s", "0.5 s", "0.7 s", "1 s", "50 ms", "2 s", "1 min")
_LEAVES: Final = ("a", "b", "x > 0", "x >= 0.5", "not a", "x > previous(x)")
LENGTHS: Final = (0.0, 0.0, 1 / 60, 0.05, 0.1, 0.1, 0.1, 0.2, 0.25, 0.25, 0.3, 0.5, 0.7, 1.0, 1e-9, 59.0)
"""Times since the sample before, in seconds, whose sums are often the times in a random spec."""


def random_spec(name: str, draw: Draw) -> tuple[str, Fspa | None]:
    """Return the text of a random spec with timers, and its automaton, or None if the text has an error.

    Its signals are ``a`` and ``b``, which are bools, and ``x`` in [-1, 1].
    """
    clauses = [_clause(draw) for _ in range(1 + draw.below(3))]
    clauses += ["limit 25 steps"] if draw.chance(0.3) else []
    clauses += ["semantics infinite"] if draw.chance(0.15) else []
    text = _text(name, tuple(clauses))
    try:
        return text, _compiled(name, text)
    except TltlError:
        return text, None


def _clause(draw: Draw) -> str:
    """Return the text of a random clause, in one of the forms that have timers."""
    first, second, time = _formula(draw, 2), _formula(draw, 2), draw.choice(_TIMES)
    bound = draw.choice((f"eventually within {time}", f"always for {time}"))
    choice = draw.below(9)
    if choice <= 2:
        return f"require always ({first} implies {bound} {second})"
    if choice == 3:
        return f"require always ({first} implies {draw.choice(('X', 'N'))} {bound} {second})"
    if choice == 4:
        return f"require {bound} {first}"
    if choice == 5:
        return f"reach {first} then within {time} {second}"
    if choice == 6:
        return f"require eventually ({first} and eventually within {time} {second})"
    if choice == 7:
        return f"require eventually always for {time} {first}"
    return f"require always eventually {first}"


def _formula(draw: Draw, depth: int) -> str:
    """Return the text of a random formula about the trace so far, at most ``depth`` operators deep, in brackets."""
    if not depth or draw.chance(0.3):
        return f"({draw.choice(_LEAVES)})"
    operand, time = _formula(draw, depth - 1), draw.choice(_TIMES)
    choice = draw.below(8)
    if choice <= 1:
        return f"({operand} {draw.choice(('and', 'or', 'since'))} {_formula(draw, depth - 1)})"
    if choice == 2:
        return f"({draw.choice(('not', 'previously', 'begins', 'ends', 'once'))} {operand})"
    if choice <= 4:
        return f"({draw.choice(('once within', 'historically for'))} {time} {operand})"
    if choice == 5:
        return f"(times({operand}) {draw.choice(('<', '>='))} {1 + draw.below(4)})"
    maximum = ", 30 s" if draw.chance(0.3) else ""
    function, op = draw.choice(("time_since", "time_holding")), draw.choice(("<", "<=", ">", ">="))
    return f"({function}({operand}{maximum}) {op} {time})"


def _random_case(name: str, seed: int) -> ConformanceCase:
    """Return a case with a random spec that has registers, and whose automaton is neither tiny nor large."""
    draw = Draw(seed)
    while True:
        text, fspa = random_spec(name, draw)
        if fspa is not None and len(fspa.registers) > 2 and 3 <= len(fspa.states) <= 12:
            break
    traces = (lively_trace(fspa, draw, 30, _POOLS, LENGTHS), lively_trace(fspa, draw, 40, _POOLS, LENGTHS))
    return ConformanceCase(fspa, "A random spec on a clock that varies.", traces, text)


CASES: Final[CaseBuilders] = {
    **{name: partial(_timed_case, name, 10_000 + number) for number, name in enumerate(_SPECS)},
    "varies_columns": _columns_case,
    **{f"random_varies_{n}": partial(_random_case, f"random_varies_{n}", 11_000 + n) for n in range(1, 3)},
}
