"""On a clock that varies, programs in scripting languages print what the library computes, from `dt` or `time`."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from random import Random
from typing import Final

import pytest

from tests.backends.monitors import HEADER, Programs
from tests.backends.test_step_lengths_in_scripts import SCRIPTS, automata
from tests.tools.conformance.runner import Runner, runners
from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.expression.tree import Condition, Const, Expression, Op, SignalValue, StepLength, When, nodes
from tltlc.monitor import Monitor
from tltlc.monitor.samples import STEP_LENGTH
from tltlc.monitor.traces import read_trace
from tltlc.pipeline import CompileOptions

# --- limits of languages --------------------------------------------------------------------------

RUNNERS: Final = [
    pytest.param(runner, id=runner.name) for runner in runners() if runner.target in (*SCRIPTS, "gdscript")
]

Row = tuple[dict[str, float], float]
"""A sample, and its time since the sample before."""


def rows(fspa: Fspa, samples: Sequence[Row]) -> str:
    """Return the rows that a program prints with ``--full``."""
    monitor, lines = Monitor(fspa), [",".join(HEADER)]
    for signals, length in samples:
        step = monitor.step(signals, length)
        flags = ["true" if flag else "false" for flag in (step.accepting, step.done)]
        figures = [f"{value:.17g}" for value in (step.progress, step.reward, step.robustness)]
        texts = (step.limiting, step.failed_clause, step.failed_atom, step.failed_step)
        names = ["" if text is None else str(text) for text in texts]
        cells = [str(monitor.steps), str(step.state), step.verdict, *flags, *figures]
        lines.append(",".join([*cells, *(f'"{name}"' if "," in name else name for name in names)]))
    return "\n".join(lines) + "\n"


def table(fspa: Fspa, samples: Sequence[Row]) -> str:
    """Return a trace in CSV, with the lengths of the steps in a column."""
    names = [signal.name for signal in fspa.signals]
    column = "DT" if "dt" in names else "dt"
    lines = [",".join([*names, column])]
    lines += [",".join([*(repr(signals[name]) for name in names), repr(length)]) for signals, length in samples]
    return "\n".join(lines) + "\n"


def run_traces(runner: Runner, folder: Path, fspas: Sequence[Fspa], traces: Sequence[Sequence[Row]]) -> None:
    """Check that the programs print what the library computes: the same numbers, to the last bit."""
    if runner.missing():
        pytest.skip(str(runner.missing()))
    programs = Programs(runner, folder, fspas)
    outcomes = programs.run(*((number, table(fspas[number], trace)) for number, trace in enumerate(traces)))
    for fspa, trace, (status, out, err) in zip(fspas, traces, outcomes, strict=True):
        assert (status, err) == (0, ""), f"{fspa.formula}\n{err}"
        assert out == rows(fspa, trace), f"{fspa.formula}\n{trace}"


@pytest.mark.parametrize("runner", RUNNERS)
def test_many_registers_and_deep_updates_read_the_length(runner: Runner, tmp_path: Path) -> None:
    """Lua allows 200 local variables, and nests blocks only so deep: there, variables become fields."""
    signals = "".join(f"signal x{number} in [0, 1]\n" for number in range(60))
    terms = " or ".join(f"time_holding(x{number} > 0.5) >= {0.5 + number / 64} s" for number in range(60))
    many, deep = compile_text(
        f"clock varies\n{signals}spec many {{ reach {terms} }}\nspec deep {{ reach time_holding(x0 > 0.5) > 1 s }}"
    )
    value: Expression = Op("min", (StepLength(), Const(0.25)))
    for level in range(90):
        condition = Condition(">", (SignalValue("x0"), Const((90 - level) / 100)))
        value = When(((condition, value),), Op("min", (StepLength(), Const(level / 200))))
        # With a computation after it, the inner value is computed in a block of its own.
        value = Op("-", (Op("+", (value, Const(0.25))), Const(0.25)))
    registers = [replace(each, update=value) if each.kind == "time_holding" else each for each in deep.registers]
    deep = replace(deep, registers=tuple(registers))
    assert len(many.registers) == 120
    draw = Random(5)
    draws = [
        ({f"x{number}": draw.choice((0.25, 0.875)) for number in range(60)}, draw.choice((0.0, 0.125, 1 / 3)))
        for _ in range(12)
    ]
    trace = [({"x0": place / 11}, length) for place, (_, length) in enumerate(draws)]
    run_traces(runner, tmp_path, [many, deep], [draws, trace])


# --- random specs and traces ----------------------------------------------------------------------

TIMES: Final = (0.1, 0.25, 0.3, 1, 2.5)
LENGTHS: Final = (0.0, 0.0, 1 / 60, 0.1, 0.1, 0.2, 0.25, 0.3, 0.75, 1.0, 2.5, 6.0, 1e-9)
SPECS: Final = 60


def past(draw: Random, depth: int = 2) -> str:
    """Return a random formula about a sample and those before it."""
    time = f"{draw.choice(TIMES)} s"
    plain = ("a", "b", "x > 0.25", "x < y", "a and not b", "dt >= 0.5")
    if depth == 0 or draw.random() < 0.3:
        return draw.choice(plain)
    p, q = past(draw, depth - 1), past(draw, depth - 1)
    forms = (
        *(f"once within {time} ({p})", f"historically for {time} ({p})", f"previously ({p})", f"(({p}) since ({q}))"),
        *(f"time_since({p}) < {time}", f"time_holding({p}) >= {time}", f"times({p}) > 2", f"begins ({p})"),
        *(f"not ({p})", f"(({p}) or ({q}))", f"(({p}) and ({q}))", "x > previous(x)"),
        *(f"time_since({p}, {time}) > time_holding({q}, {time})", f"once ({p})"),
    )
    return draw.choice(forms)


def clause(draw: Random) -> str:
    """Return a random clause: one of the forms that have a timer, or one without a bound."""
    p, q, time = past(draw), past(draw), f"{draw.choice(TIMES)} s"
    forms = (
        *(f"keep {p}", f"reach {p}", f"require always eventually ({p})", f"reach ({p}) then ({q})"),
        *(f"keep ({p}) implies eventually within {time} ({q})", f"keep ({p}) implies always for {time} ({q})"),
        *(f"reach ({p}) then within {time} ({q})", f"require eventually within {time} ({p})"),
        *(f"require always for {time} ({p})", f"require eventually always for {time} ({p})"),
        f"keep within {time} of ({p}), ({q})",
    )
    return draw.choice(forms)


def random_automata(count: int) -> list[Fspa]:
    """Return automata of random specs on a clock that varies; each reads the length of a step."""
    draw, fspas = Random(20), list[Fspa]()
    head = "clock varies\nsignal a: bool\nsignal b: bool\nsignal x in [0, 1]\nsignal y in [0, 1]\nsignal dt in [0, 1]\n"
    while len(fspas) < count:
        clauses = "\n".join(clause(draw) for _ in range(draw.randint(1, 3)))
        try:
            (fspa,) = compile_text(f"{head}spec s {{\n{clauses}\n}}", options=CompileOptions(state_budget=40))
        except TltlError:
            continue
        if any(StepLength() in nodes(register.update) for register in fspa.registers):
            fspas.append(fspa)
    return fspas


def random_trace(draw: Random) -> list[Row]:
    trace: list[Row] = []
    signals = {"a": 0.0, "b": 0.0, "x": 0.0, "y": 0.5, "dt": 0.0}
    for _ in range(40):
        for name in signals:
            if draw.random() < 0.4:
                signals[name] = draw.choice((0.0, 1.0) if name in "ab" else (0.0, 0.25, 1 / 3, 0.5, 1.0))
        trace.append(({**signals}, draw.choice(LENGTHS)))
    return trace


def test_random_specs_use_all_timers() -> None:
    fspas = random_automata(SPECS)
    kinds = {register.kind for fspa in fspas for register in fspa.registers}
    assert kinds >= {"elapsed", "run", "waiting", "due", "breach", "time_since", "time_holding", "previously", "times"}
    draw = Random(21)
    verdicts = set()
    for fspa in fspas:
        monitor = Monitor(fspa)
        verdicts |= {monitor.step(signals, length).verdict for signals, length in random_trace(draw)}
    assert verdicts == {"satisfied", "holding", "pending", "violated"}


@pytest.mark.parametrize("runner", RUNNERS)
def test_random_specs_agree_with_the_monitor_to_the_last_bit(runner: Runner, tmp_path: Path) -> None:
    draw = Random(22)
    fspas = random_automata(SPECS)
    run_traces(runner, tmp_path, fspas, [random_trace(draw) for _ in fspas])


# --- traces ---------------------------------------------------------------------------------------

COLUMNS: Final = "x,dt,a"
NO_COLUMN: Final = "line 1: the trace has no column `time` or `dt`, and the clock of the spec varies"
TRACES: Final = {
    f"{COLUMNS},Dt\n0,0,1,5\n0,0,0,1.5\n0,0,0,0.75\n": (5.0, 1.5, 0.75),
    f"DT,{COLUMNS}\n-0,0,0,1\n.5,0,0,0\n": (0.0, 0.5),
    f"time,{COLUMNS}\n 7 ,0,0,1\n7,0,0,0\n7.1,0,0,0\n9,0,0,0\n": (0.0, 0.0, 7.1 - 7, 9 - 7.1),
    f"TIME,Time,time,{COLUMNS}\n0,0,-3,0,0,1\n0,0,-1.5,0,0,0\n": (0.0, 1.5),
    f"time,dT,{COLUMNS}\n9,0,0,0,1\n5,2.25,0,0,0\n": (0.0, 2.25),
    f'"Time",{COLUMNS}\n"1",0,0,1\n"1e0",0,0,0\n': (0.0, 0.0),
}
"""Traces in CSV of the automaton ``timed``, whose signal ``dt`` is no length, with the lengths of their steps."""

WRONG: Final = {
    f"{COLUMNS}\n0,0,1\n": NO_COLUMN,
    f"{COLUMNS},t,delta\n0,0,1,0,0\n": NO_COLUMN,
    "dt,a,DT\n0,0,0\n": "line 1: the trace has no column for `x`",
    f"{COLUMNS},Dt,Dt\n0,0,1,0,0\n": "line 1: two columns are called `Dt`",
    f"{COLUMNS},time,time\n0,0,1,0,0\n": "line 1: two columns are called `time`",
    f"{COLUMNS},DT\n0,0,1,0\n0,0,0,-0.5\n": "line 3: the length of the step is -0.5 s, not a number of at least 0",
    f"{COLUMNS},DT\n0,0,1,-2\n": "line 2: the length of the step is -2 s, not a number of at least 0",
    f"{COLUMNS},DT\n0,0,1,0\n0,0,0,inf\n": "line 3: the length of the step is inf s, not a number of at least 0",
    f"{COLUMNS},DT\n0,0,1,0\n0,0,0,nan\n": "line 3: the length of the step is nan s, not a number of at least 0",
    f"{COLUMNS},DT\n0,0,1,0\n0,0,0,\n": "line 3: the column `DT` is ``, not a number",
    f"{COLUMNS},DT\n0,0,1,0\n0,0,0,1 s\n": "line 3: the column `DT` is `1 s`, not a number",
    f"{COLUMNS},time\n0,0,1,3\n\n0,0,0,2.5\n": "line 4: the time is 2.5 s, and the sample before is at 3 s",
    f"{COLUMNS},time\n0,0,1,3\n0,0,0,12:30\n": "line 3: the column `time` is `12:30`, not a number",
    f"{COLUMNS},time\n0,0,1,nan\n": "line 2: the time is nan, not a finite number",
    f"{COLUMNS},time\n0,0,1,1\n0,0,0,inf\n": "line 3: the time is inf, not a finite number",
    f"{COLUMNS},time\n0,0,1,1\n0,0,7q,0\n": "line 3: the signal `a` is `7q`, not a number",
    f"{COLUMNS},time\n0,0,1,-1e308\n0,0,0,1.5e308\n": "step 2: its time since the sample before is inf, "
    "not a number of seconds",
}
"""Traces in CSV with something wrong, and what a program says."""


def printed_rows(lengths: Sequence[float]) -> str:
    """Return the rows of samples of which the first alone has ``a``, with these times since the samples before."""
    samples = [({"x": 0.0, "dt": 0.0, "a": float(place == 0)}, length) for place, length in enumerate(lengths)]
    return rows(automata()["timed"], samples)


@pytest.mark.parametrize("runner", RUNNERS)
def test_programs_read_the_lengths_of_steps(runner: Runner, tmp_path: Path) -> None:
    if runner.missing():
        pytest.skip(str(runner.missing()))
    programs = Programs(runner, tmp_path, [automata()["timed"]])
    outcomes = programs.run(*((0, trace) for trace in TRACES))
    for (trace, lengths), outcome in zip(TRACES.items(), outcomes, strict=True):
        assert outcome == (0, printed_rows(lengths), ""), trace


@pytest.mark.parametrize("runner", RUNNERS)
def test_programs_refuse_wrong_times(runner: Runner, tmp_path: Path) -> None:
    if runner.missing():
        pytest.skip(str(runner.missing()))
    programs = Programs(runner, tmp_path, [automata()["timed"]])
    outcomes = programs.run(*((0, trace) for trace in WRONG))
    for (trace, message), (status, _, err) in zip(WRONG.items(), outcomes, strict=True):
        assert (status, err) == (1, f"error: {message}\n"), trace


def test_the_library_finds_the_same_lengths_and_faults() -> None:
    fspa = automata()["timed"]
    for trace, lengths in TRACES.items():
        samples = [*read_trace(io.BytesIO(trace.encode()), "trace", fspa.signals, clock_varies=True)]
        assert tuple(sample[STEP_LENGTH] for sample in samples) == lengths, trace
    for trace in WRONG:
        with pytest.raises(TltlError) as error:
            for sample in read_trace(io.BytesIO(trace.encode()), "trace", fspa.signals, clock_varies=True):
                Monitor(fspa).step(sample)
        assert error.value.diagnostics[0].code in ("TLT0621", "TLT0622", "TLT0623", "TLT0619"), trace


OBJECT: Final = '{"x": 0, "dt": 0, "a": 1, '
LATER: Final = '{"x": 0, "dt": 0, "a": 0, '
JSON_TRACES: Final = {
    (f'{OBJECT}"DT": 3}}', f'{LATER}"DT": 1.5}}'): "",
    (f'{OBJECT}"time": 1e3}}', f'{LATER}"Time": 3, "time": 1001.5}}'): "",
    (f'{OBJECT}"t": 0}}',): NO_COLUMN,
    (f'{OBJECT}"time": 1}}', f'{LATER}"t": 0}}'): "line 2: this row has no time, unlike the first row",
    (f'{OBJECT}"time": 1}}', f'{LATER}"Dt": 1, "time": 2}}'): "line 2: this row has `Dt`, unlike the first row",
    (f'{OBJECT}"Dt": null}}',): "line 1: the column `Dt` is `None`, not a number",
    (f'{OBJECT}"Dt": "1"}}',): "line 1: the column `Dt` is `1`, not a number",
    (f'{OBJECT}"Dt": -1}}',): "line 1: the length of the step is -1 s, not a number of at least 0",
    (f'{OBJECT}"time": 2}}', f'{LATER}"time": 1}}'): "line 2: the time is 1 s, and the sample before is at 2 s",
    ('{"x": 0, "dt": 0, "a": "7q"}',): "line 1: the signal `a` is `7q`, not a number",
}
"""Traces in JSON lines, and what the program in Python says; nothing if the lengths are any number, and 1.5."""


def test_the_python_program_reads_json_lines(tmp_path: Path) -> None:
    (runner,) = (each for each in runners() if each.target == "python")
    programs = Programs(runner, tmp_path, [automata()["timed"]])
    outcomes = programs.run(*((0, "".join(f"{row}\n" for row in trace)) for trace in JSON_TRACES))
    for (trace, message), (status, out, err) in zip(JSON_TRACES.items(), outcomes, strict=True):
        if message:
            assert (status, err) == (1, f"error: {message}\n"), trace
        else:
            assert (status, out, err) == (0, printed_rows((0.0, 1.5)), ""), trace
