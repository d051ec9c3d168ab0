"""C monitors with ``TLTL_VERDICT_ONLY`` find the states and verdicts of :class:`tltlc.monitor.Monitor`."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from random import Random
from typing import Final

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.backends.monitors import Programs, Sample, batches, different
from tests.memory.runs import random_case, random_trace
from tests.memory.timed_runs import timed_case
from tests.memory.timed_texts import TimedTexts, timed_trace
from tests.monitor.strategies import PARAMS, SIGNALS, atom_traces, automata, expressions, numbers
from tests.tools.conformance.runners.c import VERDICT_ONLY
from tests.waiting import HANG_S
from tltlc import compile_text
from tltlc.automaton.finite.build import build, spec_from_formula
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import emit
from tltlc.core.record import replace
from tltlc.expression.tree import SignalValue
from tltlc.logic import formula as f
from tltlc.monitor import Monitor, MonitorError
from tltlc.resolve import spec

pytestmark = pytest.mark.skipif(VERDICT_ONLY.missing() is not None, reason=str(VERDICT_ONLY.missing()))

COMPILERS: Final = {"c": ("gcc", "-std=c99", "-x", "c"), "c++": ("g++", "-std=c++17", "-x", "c++")}
STRICT: Final = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wfloat-conversion", "-Werror")

Trace = tuple[Sequence[Sample], Sequence[float]]
"""Samples, and the time of each since the one before; on a clock that does not vary, these times mean nothing."""


def expected(fspa: Fspa, trace: Trace) -> tuple[int, str]:
    """Return the exit status of the program, and the rows that it prints."""
    monitor, rows = Monitor(fspa), []
    for sample, dt in zip(*trace, strict=True):
        try:
            step = monitor.step(sample, dt) if fspa.clock_varies else monitor.step(sample)
        except MonitorError:
            return 1, "\n".join(rows)
        rows += [] if rows else ["step,state,verdict"]
        rows.append(f"{monitor.steps},{step.state},{step.verdict}")
    return 0, "\n".join(rows)


def check(folder: Path, runs: Sequence[tuple[Fspa, Sequence[Trace]]]) -> None:
    """Compare the programs of automata with the monitor, each on some traces."""
    programs = Programs(VERDICT_ONLY, folder, [fspa for fspa, _ in runs])
    places = [(number, trace) for number, (_, traces) in enumerate(runs) for trace in traces]
    outcomes = programs.run(*((number, csv_of(programs.fspas[number], trace)) for number, trace in places))
    for (number, trace), (status, output, errors) in zip(places, outcomes, strict=True):
        assert (status, output.strip()) == expected(programs.fspas[number], trace), (runs[number][0], trace, errors)


def csv_of(fspa: Fspa, trace: Trace) -> str:
    names = [signal.name for signal in fspa.signals]
    header = ",".join(f'"{name}"' for name in (*names, "dt"))
    rows = [",".join(repr(value) for value in (*(s[name] for name in names), dt)) for s, dt in zip(*trace, strict=True)]
    return "\n".join([header, *rows, ""])


def steady(samples: Sequence[Sample]) -> Trace:
    return samples, [0.0] * len(samples)


# --- random specs ---------------------------------------------------------------------------------


def on_a_clock(seeds: range) -> Iterator[tuple[Fspa, list[Trace]]]:
    for seed in seeds:
        case, random = random_case(seed), Random(seed)
        if case is not None:
            yield case.fspa, [steady(random_trace(random)) for _ in range(6)]


def on_a_clock_that_varies(seeds: range) -> Iterator[tuple[Fspa, list[Trace]]]:
    for seed in seeds:
        random = Random(seed)
        case = timed_case(TimedTexts(random).clauses())
        # Compilers may refuse longer strings.
        if case is not None and all(len(label) < 4000 for label in labels(case.fspa)):
            traces = [timed_trace(random, random.randint(1, 10)) for _ in range(6)]
            yield case.fspa, [(samples, lengths_s) for samples, lengths_s in traces]


def labels(fspa: Fspa) -> Iterator[str]:
    for state in fspa.states:
        yield str(state.label)
        yield label_text(fspa, state.id)


@pytest.mark.parametrize("runs", [on_a_clock, on_a_clock_that_varies])
@pytest.mark.parametrize(
    "seeds", [range(50), pytest.param(range(1000, 1150), marks=pytest.mark.slow)], ids=["few", "many"]
)
def test_random_specs_about_the_trace_so_far(
    runs: Callable[[range], Iterator[tuple[Fspa, list[Trace]]]], seeds: range, tmp_path: Path
) -> None:
    cases = list(runs(seeds))
    assert len(cases) > 0.6 * len(seeds)
    assert sum(bool(fspa.registers) for fspa, _ in cases) > 0.5 * len(cases)
    check(tmp_path, cases)


@batches
@given(data=st.data())
def test_random_automata(tmp_path: Path, data: st.DataObject) -> None:
    runs = []
    for fspa in different(data, automata(), 12):
        names = [atom.name for atom in fspa.atoms]
        rows = data.draw(atom_traces(fspa, max_size=12))
        runs.append((fspa, [steady([dict(zip(names, row, strict=True)) for row in rows])]))
    check(tmp_path, runs)


@batches
@given(data=st.data())
def test_random_predicates(tmp_path: Path, data: st.DataObject) -> None:
    """Values of atoms are clamped, and samples refused, as in every monitor."""
    whole = build(spec_from_formula(f.eventually(f.and_(f.atom("a"), f.atom("b")))))
    runs = []
    for values in different(data, st.tuples(numbers, numbers), 20):
        fspa = replace(
            whole,
            signals=(spec.Signal(SIGNALS[0], "number", None, 2.0), spec.Signal(SIGNALS[1], "number", -3.0, None)),
            params=tuple(spec.Param(name, "number", v, None, None) for name, v in zip(PARAMS, values, strict=True)),
            atoms=(spec.Atom("a", data.draw(expressions())), spec.Atom("b", SignalValue(SIGNALS[0]))),
        )
        rows = data.draw(st.lists(st.tuples(numbers, numbers), min_size=3, max_size=3))
        runs.append((fspa, [steady([dict(zip(SIGNALS, row, strict=True)) for row in rows])]))
    check(tmp_path, runs)


# --- borders --------------------------------------------------------------------------------------


def test_deadlines_end_at_the_same_sample(tmp_path: Path) -> None:
    (fspa,) = compile_text("""
clock 60 Hz
signal alarm: bool
signal answer: bool
spec s { keep alarm implies eventually within 5 s answer  keep answer implies next always for 2 s not answer }
""")
    traces = []
    for wait, pause in [(299, 500), (300, 500), (301, 500), (2, 119), (2, 120), (2, 121)]:
        answers = {wait, wait + pause}
        traces.append(
            steady([{"alarm": float(i == 0), "answer": float(i in answers)} for i in range(wait + pause + 2)])
        )
    assert {expected(fspa, trace)[1].rpartition(",")[2] for trace in traces} == {"violated", "holding"}
    check(tmp_path, [(fspa, traces)])


def test_numbers_beside_a_border(tmp_path: Path) -> None:
    (fspa,) = compile_text("""
signal x in [-3, 3]
signal y: ratio
predicate low = 0.1 * (0.3 - x) - 0.1
predicate high = clamp(max(y / 0.7 - 0.9, -1), -0.5, 0.5)
spec s { require always (low or high) and eventually (x > 0.3 and not low) }
""")
    random, traces = Random(5), []
    for _ in range(200):
        x, y = random.choice((-0.7, -0.7, 0.3, 0.0)), random.choice((0.63, 0.9 * 0.7, 0.0))
        samples = [
            {"x": x + random.randint(-4, 4) * 2.0**-54, "y": y + random.randint(0, 4) * 2.0**-54} for _ in range(4)
        ]
        traces.append(steady(samples))
    assert len({expected(fspa, trace)[1] for trace in traces}) > 5
    check(tmp_path, [(fspa, traces)])


# --- the header -----------------------------------------------------------------------------------

DEADLINE: Final = """
clock 60 Hz
signal alarm: bool
signal hidden: bool
spec s { keep alarm implies eventually within 5 s hidden }
"""
GAME: Final = """
#include "s_monitor.h"

int main(void) {
    s_monitor monitor;
    s_result result;
    s_signals sample = s_sparse();
    if (!s_init(&monitor, NULL)) return 1;
    sample.alarm = true;
    for (int i = 0; i < 301; i++) {
        if (!s_step(&monitor, &sample, &result)) return 1;
    }
    if (result.verdict != s_violated || monitor.state != result.state) return 2;
    return sizeof result == sizeof(int) + sizeof(s_verdict) ? 0 : 3;
}
"""


@pytest.mark.parametrize("compiler", COMPILERS)
def test_a_game_gets_only_state_and_verdict(compiler: str, tmp_path: Path) -> None:
    (fspa,) = compile_text(DEADLINE)
    ((name, header),) = emit("c", fspa).items()
    (tmp_path / name).write_text(str(header), encoding="utf-8")
    (tmp_path / "game.c").write_text(GAME, encoding="utf-8")
    for level in ("-O0", "-O2"):
        command = [*COMPILERS[compiler], *STRICT, level, "-DTLTL_VERDICT_ONLY", "game.c", "-o", "game", "-lm"]
        subprocess.run(command, cwd=tmp_path, check=True, timeout=HANG_S)
        assert subprocess.run(["./game"], cwd=tmp_path, timeout=HANG_S).returncode == 0


def test_times_are_integers() -> None:
    (fspa,) = compile_text(DEADLINE)
    ((_, header),) = emit("c", fspa).items()
    only = str(header).split("#if defined(TLTL_VERDICT_ONLY)\n")[1].split("#elif")[0]
    assert "int waiting_alarm_hidden_before;\n" in only
    assert "s_flag_(due_alarm_hidden_before);\n" in only
    assert "double" not in only
